"""All arrays of a lattice: what stays as it was built, and what moves."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from quintet.interfaces.component import Array

Whole = NDArray[np.int64]
Generator = NDArray[np.uint64]  # (1,) state of the random numbers


class Driven(NamedTuple):
    """Two points at a prescribed distance along an axis; `first` is -1 without."""

    first: int
    second: int
    axis: int
    distance: float  # m, of the first from the second along the axis, at rest
    amplitude: float  # m, with the sign of the distance
    frequency: float  # rad/s
    share_first: float  # of the amplitude, by which the first moves
    share_second: float
    is_free: bool  # whether their mean along the axis moves freely
    rest_first: float  # m, along the axis
    rest_second: float


NO_DRIVE = Driven(-1, -1, 0, 0.0, 0.0, 0.0, 0.0, 0.0, False, 0.0, 0.0)


class Bathed(NamedTuple):
    """Points that baths keep at temperatures; a point is in one bath at most."""

    point: Whole  # (b,)
    bath: Whole  # (b,) its number
    rate: Array  # (b,) 1/s
    tether: Array  # (b,) N/m
    rest: Array  # (b, 3) m
    # (b + 1,) points whose random numbers are passed over before each of these and after the last:
    # those that other ranks draw.
    passed: Whole


class Model(NamedTuple):
    """What never changes."""

    mass: float  # kg, of each point
    frozen: Whole  # (f,) points
    driven: Driven
    bathed: Bathed
    bonds: Whole  # (m, 2) pairs of nearest points that collide
    collision_rate: float  # 1/s
    is_random: bool  # whether baths or collisions change velocities in the middle of a step
    stages: Array  # (s,) shares of a step: 1, or Yoshida's three
    literal_damping: float  # N s/m, of all pairs at any distance


class State(NamedTuple):
    """What moves."""

    position: Array  # (n, 3) m
    velocity: Array  # (n, 3) m/s
    acceleration: Array  # (n, 3) m/s2
    listed: Array  # (n, 3) m, positions at the last rebuild of the neighbour lists
    kinetic: Array  # (n,) J s, ½ m v² over time since the averages began
    temperature: Array  # (b,) K, of bathed points
    heat: Array  # (b,) J, from the bath to each point
    flow: Array  # (b,) W, into the bath from each point, mean of the last call of `step`
    lost: Array  # (n,) W, dissipated now by the pairs listed for each point; (0,) without damping
    dissipated: Array  # (n,) J, its integral
    energies: Array  # (4,) see below
    generator: Generator  # (1,)


POINTS = ("position", "velocity", "acceleration", "listed", "kinetic", "lost", "dissipated")
BATHED = ("temperature", "heat", "flow")
# Rows of `State.energies`: s, J of the drive, N on the driven pair.
TIME, WORK, PULL_FIRST, PULL_SECOND = range(4)
