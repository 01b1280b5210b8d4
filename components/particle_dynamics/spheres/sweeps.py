"""Sweeps over walls and pairs, in which impacts follow one another until nothing approaches."""

from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from quintet.components.particle_dynamics.spheres.kernels import bounce, bounce_from_walls
from quintet.components.particle_dynamics.spheres.state import LOST
from quintet.components.shared.search.sphere_pairs import Pairs
from quintet.interfaces.component import Array

SWEEPS = 100  # over all pairs, in which an impulse runs through a row: each in turn


class Moving(NamedTuple):
    """What an impact changes and depends on, of some spheres."""

    position: Array  # (n, 3) m
    velocity: Array  # (n, 3) m/s
    acceleration: Array  # (n, 3) m/s2, in flight
    radius: Array  # (n,) m
    mass: Array  # (n,) kg
    launched: NDArray[np.bool_]  # (n,)


class Near(Protocol):
    """Lists of pairs."""

    def at(self, position: Array) -> Pairs:
        """All pairs that overlap at positions (n, 3) m, and some that do not."""


def sweep(
    dt: float, moving: Moving, planes: Array, near: Near | None, restitution: float, sums: Array
) -> None:
    """Let spheres bounce until none that overlap approach each other.

    Parameters
    ----------
    dt : float, s
        Length of the step that has just ended.
    moving : Moving
        Positions and velocities are changed.
    planes : (w, 4) float array, 1 and m
        Unit normals and offsets of walls.
    near : Near or None
        Pairs of spheres; None if spheres do not strike each other.
    restitution : float
    sums : (4,) float array
        As `State.sums`; the lost energy [J] is added, impact after impact.
    """
    arguments = (dt, *moving)
    for number in range(SWEEPS):
        impacts = 0
        if len(planes):
            lost, impacts = bounce_from_walls(*arguments, planes, restitution)
            sums[LOST] += lost
        if near is not None:
            pairs, backwards = near.at(moving.position), number % 2 == 1
            lost, more = bounce(*arguments, *pairs, backwards, restitution)
            sums[LOST] += lost
            impacts += more
        if impacts == 0:
            return
