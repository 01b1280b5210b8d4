"""All arrays of spheres: what stays as it was built, and what moves."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from quintet.interfaces.component import Array


class Spheres(NamedTuple):
    """What never changes; mass, inertia and heat capacity of a parcel are those of all in it."""

    start: Array  # (n, 3) m
    first_velocity: Array  # (n, 3) m/s, when it is launched
    first_spin: Array  # (n, 3) rad/s
    launch: Array  # (n,) s
    radius: Array  # (n,) m
    mass: Array  # (n,) kg
    inertia: Array  # (n,) kg m2
    capacity: Array  # (n,) J/K
    tether: Array  # (n,) N/m
    parcel: Array  # (n,) 1
    temperature: Array  # (n,) K, at the start


class State(NamedTuple):
    """What moves."""

    position: Array  # (n, 3) m
    velocity: Array  # (n, 3) m/s
    orientation: Array  # (n, 4) w x y z, body -> world
    spin: Array  # (n, 3) rad/s
    temperature: Array  # (n,) K
    force: Array  # (n, 3) N
    torque: Array  # (n, 3) N m
    heat: Array  # (n,) W
    launched: NDArray[np.bool_]  # (n,)
    sums: Array  # (4,) see below


# Rows of `State.sums`: s; J of impacts, J of partners; the largest overlap over the smaller
# diameter after a step that no division could shorten enough.
TIME, LOST, HEATED, DEEPEST = range(4)


def launch(spheres: Spheres, state: State, until: float) -> None:
    """Give the first velocities to spheres that are launched by a time [s]."""
    rows = ~state.launched & (spheres.launch <= until)
    state.velocity[rows] = spheres.first_velocity[rows]
    state.spin[rows] = spheres.first_spin[rows]
    state.launched[rows] = True
