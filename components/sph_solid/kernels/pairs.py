"""Sums over pairs: the gradient of velocity, and accelerations. Each row is written by one call."""

import math
from typing import NamedTuple

from numba import njit

from quintet.components.shared.float_bits import number_of
from quintet.components.shared.numba_options import FAST
from quintet.components.shared.packing import (
    empty_rows,
    longest_list,
    out_of_reach,
    pack_rows,
)
from quintet.components.shared.search.neighbours import Lists
from quintet.components.sph_solid.kernels.sums import (
    corrected,
    own_stress,
    sum_forces,
    sum_gradients,
)
from quintet.components.sph_solid.laws import PairLaw
from quintet.components.sph_solid.state import Array


class Forces(NamedTuple):
    """What forces are summed into."""

    acceleration: Array  # (n, 3) m/s2
    heating: Array  # (n,) W/kg


@njit(**FAST)
def velocity_gradients(
    first: int, last: int, place: Array, motion: Array, lists: Lists, law: PairLaw,
    velocity_gradient: Array, correction: Array,
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
    begin, _, end, neighbour = lists
    rows = longest_list(first, last, begin, end)
    near, moves = empty_rows(rows, 4, place.dtype), empty_rows(rows, 4, place.dtype)
    for i in range(first, last):
        x, y, z = place[i, 0], place[i, 1], place[i, 2]
        u, v, w = motion[i, 0], motion[i, 1], motion[i, 2]
        outside = out_of_reach(x, law.smoothing.length), y, z, 0.0
        count = pack_rows(begin[i], end[i], neighbour, place, outside, near)
        pack_rows(begin[i], end[i], neighbour, motion, (u, v, w, 0.0), moves)
        found, matrix, broken = sum_gradients(count, x, y, z, u, v, w, near, moves, law)
        if law.corrected is not None:
            whole = motion[i, 3] == 0.0 and broken == 0.0
            found, matrix = corrected(found, matrix, whole, law)
            for d in range(6):
                correction[i, d] = matrix[d]
        for d in range(9):
            velocity_gradient[i, d] = found[d]


@njit(**FAST)
def accelerations(
    first: int, last: int, place: Array, motion: Array, stress: Array, lists: Lists, law: PairLaw,
    forces: Forces,
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

    References
    ----------
    Monaghan, Annu. Rev. Astron. Astrophys. 30 (1992) 543, section 10.3 (step).
    """
    begin, _, end, neighbour = lists
    acceleration, heating = forces
    rows = longest_list(first, last, begin, end)
    near, moves = empty_rows(rows, 4, place.dtype), empty_rows(rows, 4, place.dtype)
    # Numbers that the compiler knows.
    width = 16 if law.artificial is not None else 8 if law.corrected is None else 12
    tension = empty_rows(rows, width, place.dtype)
    slowest, greatest = math.inf, 0.0
    for i in range(first, last):
        x, y, z = place[i, 0], place[i, 1], place[i, 2]
        u, v, w, sound = motion[i, 0], motion[i, 1], motion[i, 2], motion[i, 3]
        outside = out_of_reach(x, law.smoothing.length), y, z, 0.0
        count = pack_rows(begin[i], end[i], neighbour, place, outside, near)
        pack_rows(begin[i], end[i], neighbour, motion, (u, v, w, sound), moves)
        own, density, start, filling = own_stress(stress, i, law.corrected, law.artificial)
        pack_rows(begin[i], end[i], neighbour, stress, filling, tension)
        fx, fy, fz, heat, fastest = sum_forces(
            count,
            x,
            y,
            z,
            u,
            v,
            w,
            sound,
            density,
            start,
            own,
            near,
            moves,
            tension,
            law,
            law.corrected,
            law.artificial,
        )
        mu = number_of(fastest)
        per = 1.0 / start
        fx, fy, fz = fx * per, fy * per, fz * per
        acceleration[i, 0], acceleration[i, 1], acceleration[i, 2] = fx, fy, fz
        heating[i] = 0.5 * heat * per
        drag = law.linear * sound + law.quadratic * mu
        slowest = min(slowest, law.smoothing.length / (sound + 1.2 * drag))
        greatest = max(greatest, fx * fx + fy * fy + fz * fz)
    return slowest, greatest
