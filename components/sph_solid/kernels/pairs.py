"""Sums over pairs: the gradient of velocity, and accelerations. Each row is written by one call.

Neighbours are particles near in space, or azimuthal images of rings: `lists` says which.
"""

import math
from typing import NamedTuple

from numba import njit

from quintet.components.shared.float_bits import number_of
from quintet.components.shared.numba_options import FAST
from quintet.components.shared.packing import empty_rows, longest_list
from quintet.components.shared.search.neighbours import Lists
from quintet.components.sph_solid.kernels.azimuthal_images import AzimuthalImages
from quintet.components.sph_solid.kernels.packing import across, pack_particles, pack_stresses
from quintet.components.sph_solid.kernels.sums import (
    corrected,
    densities,
    stress_row,
    sum_forces,
    sum_gradients,
)
from quintet.components.sph_solid.laws import PairLaw, stable_step
from quintet.components.sph_solid.state import Array


class Forces(NamedTuple):
    """What forces are summed into."""

    acceleration: Array  # (n, 3) m/s2
    heating: Array  # (n,) W/kg


@njit(**FAST)
def velocity_gradients(
    first: int, last: int, place: Array, motion: Array, lists: Lists | AzimuthalImages,
    law: PairLaw, velocity_gradient: Array, correction: Array,
) -> None:  # fmt: skip
    """Write η L of particles, and L of those whose gradients are corrected.

    Parameters
    ----------
    first, last : int
        Particles to write.
    place, motion : (n + images, 4) float arrays
        As in `Rows`, with whether a particle has failed.
    lists, law
    velocity_gradient : (n, 9) float array, 1/s
        Written.
    correction : (n, 6) float array
        Written: the inverse of Σ V_j (x_j - x_i) ⊗ ∇W_ij, zeros where there is none.

    References
    ----------
    Bonet & Lok, Comput. Methods Appl. Mech. Eng. 180 (1999) 97, eq. (41).
    """
    rows = longest_list(first, last, lists.begin, lists.end)
    near, moves = empty_rows(rows, 4, place.dtype), empty_rows(rows, 4, place.dtype)
    y = across(lists)
    for i in range(first, last):
        particle = (
            place[i, 0], y * place[i, 1], place[i, 2],
            motion[i, 0], y * motion[i, 1], motion[i, 2],
        )  # fmt: skip
        count = pack_particles(i, lists, place, motion, law, near, moves)
        sums, matrix, broken = sum_gradients(count, particle, near, moves, law)
        xx, xy, xz, yx, yy, yz, zx, zy, zz = sums
        sums = xx, y * xy, xz, y * yx, yy, y * yz, zx, y * zy, zz
        if law.corrected is not None:
            kxx, kyy, kzz, kxy, kyz, kzx = matrix
            whole = motion[i, 3] == 0.0 and broken == 0.0
            sums, matrix = corrected(sums, (kxx, kyy, kzz, y * kxy, y * kyz, kzx), whole, law)
            for d in range(6):
                correction[i, d] = matrix[d]
        for d in range(9):
            velocity_gradient[i, d] = sums[d]


@njit(**FAST)
def accelerations(
    first: int, last: int, place: Array, motion: Array, stress: Array,
    lists: Lists | AzimuthalImages, law: PairLaw, forces: Forces,
) -> tuple[float, float]:  # fmt: skip
    """Write accelerations of particles and what the artificial viscosity heats them by.

    Parameters
    ----------
    first, last : int
        Particles to write.
    place, motion : (n + images, 4) float arrays
        As in `Rows`, with speeds of sound.
    stress : (n + images, 8, 12 or 16) float array
        τ, six of a symmetric matrix or nine of a corrected one, and ρ, ρ₀; then artificial ones.
    lists, law
    forces : Forces
        Written.

    Returns
    -------
    float, s : least h/(c + 1.2 (α c + β max|μ|)) of all
    float, m2/s4 : greatest square of an acceleration
    """
    acceleration, heating = forces
    rows = longest_list(first, last, lists.begin, lists.end)
    near, moves = empty_rows(rows, 4, place.dtype), empty_rows(rows, 4, place.dtype)
    # Numbers that the compiler knows.
    width = 16 if law.artificial is not None else 8 if law.corrected is None else 12
    tension = empty_rows(rows, width, place.dtype)
    y, slowest, greatest = across(lists), math.inf, 0.0
    for i in range(first, last):
        sound, row = motion[i, 3], stress_row(stress, i, law)
        particle = (
            place[i, 0], y * place[i, 1], place[i, 2],
            motion[i, 0], y * motion[i, 1], motion[i, 2], sound,
        )  # fmt: skip
        count = pack_particles(i, lists, place, motion, law, near, moves)
        pack_stresses(i, lists, stress, row, count, tension)
        fx, fy, fz, heat, fastest = sum_forces(count, particle, row, near, moves, tension, law)
        mu, per = number_of(fastest), 1.0 / densities(row, law)[1]
        fx, fy, fz = fx * per, y * fy * per, fz * per
        acceleration[i, 0], acceleration[i, 1], acceleration[i, 2] = fx, fy, fz
        heating[i] = 0.5 * heat * per
        slowest = min(slowest, stable_step(sound, mu, law))
        greatest = max(greatest, fx * fx + fy * fy + fz * fz)
    return slowest, greatest
