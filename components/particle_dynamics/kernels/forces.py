"""Forces and energies of all pairs; the lists hold each pair once."""

import math
from typing import Any, NamedTuple

import numpy as np
from numba import njit, types
from numba.extending import overload
from numpy.typing import NDArray

from quintet.components.particle_dynamics.laws import (
    damping_over_distance,
    force_over_distance,
    nearest_image,
    pair_energy,
    weight_of_damping,
)
from quintet.components.particle_dynamics.state import Whole
from quintet.components.shared.numba_options import EXACT
from quintet.interfaces.component import Array


class Pairs(NamedTuple):
    """Lists of neighbours j of points i, each pair once: neighbour[begin[i]:begin[i + 1]]."""

    begin: Whole  # (n + 1,)
    neighbour: NDArray[np.int32]  # (p,)


def opposed(damping: Any, opening: Array, k: int, square: float) -> float:
    """Force [N] of the damping of a pair, over its distance, at a squared distance [m2].

    `opening` (k,) holds ṙ r [m2/s] of the pairs, and then what is dissipated [W].
    """
    raise NotImplementedError("it is called by compiled functions only")


@overload(opposed, inline="always")
def _opposed(damping, opening, k, square):  # type: ignore[no-untyped-def]
    if isinstance(damping, types.NoneType):
        return lambda damping, opening, k, square: 0.0

    def along(damping, opening, k, square):  # type: ignore[no-untyped-def]
        weight = weight_of_damping(damping, math.sqrt(square))
        push = damping_over_distance(weight, opening[k], square)
        opening[k] *= push
        return push

    return along


def minimum_image(period: Any, axis: int, x: float) -> float:
    """Difference of coordinates [m] to the nearest image."""
    raise NotImplementedError("it is called by compiled functions only")


@overload(minimum_image, inline="always")
def _minimum_image(period, axis, x):  # type: ignore[no-untyped-def]
    if isinstance(period, types.NoneType):
        return lambda period, axis, x: x
    # Lengths of open sides are 0, which leaves x unchanged.
    return lambda period, axis, x: nearest_image(x, period[axis], period[axis + 3])


@njit(**EXACT)
def sum_forces(
    position: Array, velocity: Array, pairs: Pairs, law: Any, damping: Any, period: Any,
    force: Array, lost: Array,
) -> None:  # fmt: skip
    """Sum the forces of all pairs.

    Parameters
    ----------
    position, velocity : (n, 3) float array, m and m/s
    pairs : Pairs
    law : SevenRoots or ForceTable
    damping : PairDamping or None
    period : (6,) float array, m and 1/m, or None
        Lengths of periodic sides and their inverses, 0 of open ones.
    force : (n, 3) float array, N
        Written.
    lost : (n,) float array, W
        Written where there is damping: what the pairs of each point's list dissipate.
    """
    begin, neighbour = pairs
    longest = 1
    for i in range(position.shape[0]):
        longest = max(longest, begin[i + 1] - begin[i])
    dx, dy, dz = np.empty(longest), np.empty(longest), np.empty(longest)
    opening = np.empty(longest if damping is not None else 0)
    force[:] = 0.0
    for i in range(position.shape[0]):
        first, count = np.uint64(begin[i]), begin[i + 1] - begin[i]
        x, y, z = position[i, 0], position[i, 1], position[i, 2]
        for k in range(count):
            j = np.uint64(neighbour[first + np.uint64(k)])
            dx[k] = minimum_image(period, 0, x - position[j, 0])
            dy[k] = minimum_image(period, 1, y - position[j, 1])
            dz[k] = minimum_image(period, 2, z - position[j, 2])
            if damping is not None:
                opening[k] = (
                    (velocity[i, 0] - velocity[j, 0]) * dx[k]
                    + (velocity[i, 1] - velocity[j, 1]) * dy[k]
                    + (velocity[i, 2] - velocity[j, 2]) * dz[k]
                )
        # A loop of its own, without sums, so that the compiler vectorises it as it is written: what
        # may be reordered has other bits where it is compiled into another function.
        for k in range(count):
            square = dx[k] * dx[k] + dy[k] * dy[k] + dz[k] * dz[k]
            f = -force_over_distance(law, square) - opposed(damping, opening, k, square)
            dx[k] *= f
            dy[k] *= f
            dz[k] *= f
        fx, fy, fz, power = 0.0, 0.0, 0.0, 0.0
        for k in range(count):
            j = np.uint64(neighbour[first + np.uint64(k)])
            fx += dx[k]
            fy += dy[k]
            fz += dz[k]
            if damping is not None:
                power += opening[k]
            force[j, 0] -= dx[k]
            force[j, 1] -= dy[k]
            force[j, 2] -= dz[k]
        force[i, 0] += fx
        force[i, 1] += fy
        force[i, 2] += fz
        if damping is not None:
            lost[i] = power


@njit(**EXACT)
def damp_all_pairs(
    position: Array, velocity: Array, coefficient: float, force: Array, lost: Array
) -> None:
    """Add δ ṙ of all pairs, at whatever distance; write the powers (n,) W that are dissipated."""
    for i in range(position.shape[0]):
        power = 0.0
        for j in range(i + 1, position.shape[0]):
            x = position[i, 0] - position[j, 0]
            y = position[i, 1] - position[j, 1]
            z = position[i, 2] - position[j, 2]
            u = velocity[i, 0] - velocity[j, 0]
            v = velocity[i, 1] - velocity[j, 1]
            w = velocity[i, 2] - velocity[j, 2]
            opening = u * x + v * y + w * z
            push = damping_over_distance(coefficient, opening, x * x + y * y + z * z)
            power += push * opening
            force[i, 0] -= push * x
            force[i, 1] -= push * y
            force[i, 2] -= push * z
            force[j, 0] += push * x
            force[j, 1] += push * y
            force[j, 2] += push * z
        lost[i] = power


@njit(**EXACT)
def write_energies(
    position: Array, pairs: Pairs, law: Any, period: Any, energies: Array
) -> None:  # fmt: skip
    """Write the potential energies (n,) J of the pairs that are listed for each point."""
    for i in range(position.shape[0]):
        energy = 0.0
        for k in range(pairs.begin[i], pairs.begin[i + 1]):
            j = pairs.neighbour[k]
            x = minimum_image(period, 0, position[i, 0] - position[j, 0])
            y = minimum_image(period, 1, position[i, 1] - position[j, 1])
            z = minimum_image(period, 2, position[i, 2] - position[j, 2])
            energy += pair_energy(law, x * x + y * y + z * z)
        energies[i] = energy


@njit(**EXACT)
def count_near(
    position: Array, pairs: Pairs, reach2: float, period: Any, near: Whole
) -> None:  # fmt: skip
    """Count the neighbours of each point within a squared distance [m2]."""
    near[:] = 0
    for i in range(position.shape[0]):
        for k in range(pairs.begin[i], pairs.begin[i + 1]):
            j = pairs.neighbour[k]
            x = minimum_image(period, 0, position[i, 0] - position[j, 0])
            y = minimum_image(period, 1, position[i, 1] - position[j, 1])
            z = minimum_image(period, 2, position[i, 2] - position[j, 2])
            if x * x + y * y + z * z < reach2:
                near[i] += 1
                near[j] += 1


@njit(**EXACT)
def count_intact(position: Array, bonds: Whole, spacing: float, period: Any) -> int:
    """Count the bonds (b, 2) that are between 0.8 and 1.2 spacings [m] long."""
    intact = 0
    for k in range(bonds.shape[0]):
        i, j = bonds[k, 0], bonds[k, 1]
        x = minimum_image(period, 0, position[i, 0] - position[j, 0])
        y = minimum_image(period, 1, position[i, 1] - position[j, 1])
        z = minimum_image(period, 2, position[i, 2] - position[j, 2])
        r = math.sqrt(x * x + y * y + z * z) / spacing
        intact += int(0.8 < r < 1.2)
    return intact
