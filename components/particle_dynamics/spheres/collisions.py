"""Impulses between spheres that touch and approach, and of walls on them."""

import math

from numba import njit

from quintet.components.shared.numba_options import EXACT
from quintet.components.shared.search.cells import Whole
from quintet.interfaces.component import Array


@njit(**EXACT)
def bounce_from_walls(
    position: Array, velocity: Array, radius: Array, mass: Array, moves: Array, walls: Array,
    restitution: float,
) -> float:  # fmt: skip
    """Turn back spheres that reach into a wall and approach it, without friction.

    Parameters
    ----------
    position, velocity : (n, 3) float array, m and m/s
        Velocities are changed.
    radius, mass : (n,) float array, m and kg
    moves : (n,) bool array
        Whether a sphere has been launched.
    walls : (w, 4) float array
        Unit normals and offsets [m].
    restitution : float

    Returns
    -------
    float
        Kinetic energy [J] that was lost.
    """
    lost = 0.0
    for i in range(position.shape[0]):
        for w in range(walls.shape[0]):
            height, speed = -walls[w, 3], 0.0
            for k in range(3):
                height += walls[w, k] * position[i, k]
                speed += walls[w, k] * velocity[i, k]
            if height < radius[i] and speed < 0.0 and moves[i]:
                for k in range(3):
                    velocity[i, k] -= (1.0 + restitution) * speed * walls[w, k]
                lost += 0.5 * mass[i] * speed * speed * (1.0 - restitution * restitution)
    return lost


@njit(**EXACT)
def bounce(
    position: Array, velocity: Array, radius: Array, mass: Array, moves: Array, begin: Whole,
    other: Whole, restitution: float,
) -> float:  # fmt: skip
    """Give spheres that overlap and approach the impulse of a frictionless impact.

    Parameters
    ----------
    position, velocity : (n, 3) float array, m and m/s
        Velocities are changed.
    radius, mass : (n,) float array, m and kg
    moves : (n,) bool array
        Whether a sphere has been launched; one that has not is as heavy as a wall.
    begin, other : (n + 1,) and (m,) int array
        Spheres that may overlap with each: ``other[begin[i]:begin[i + 1]]``.
    restitution : float

    Returns
    -------
    float
        Kinetic energy [J] that was lost.
    """
    lost = 0.0
    for i in range(position.shape[0]):
        for place in range(begin[i], begin[i + 1]):
            j = other[place]
            inverse = moves[i] / mass[i] + moves[j] / mass[j]
            square, along = 0.0, 0.0
            for k in range(3):
                x = position[i, k] - position[j, k]
                square += x * x
                along += x * (velocity[i, k] - velocity[j, k])
            reach = radius[i] + radius[j]
            if square >= reach * reach or along >= 0.0 or inverse == 0.0:
                continue
            r = math.sqrt(square)
            speed = along / r
            impulse = -(1.0 + restitution) * speed / inverse
            for k in range(3):
                push = impulse * (position[i, k] - position[j, k]) / r
                velocity[i, k] += moves[i] * push / mass[i]
                velocity[j, k] -= moves[j] * push / mass[j]
            lost += 0.5 * speed * speed * (1.0 - restitution * restitution) / inverse
    return lost
