"""Sums over pairs: the gradient of velocity, and accelerations. Each row is written by one call."""

import math
from typing import NamedTuple

import numpy as np
from numba import njit

from quintet.components.shared.float_bits import bits_of, number_of
from quintet.components.shared.numba_options import FAST
from quintet.components.shared.packing import (
    empty_rows,
    longest_list,
    out_of_reach,
    pack_rows,
)
from quintet.components.shared.search.neighbours import Lists
from quintet.components.shared.smoothing.cubic_spline import ONE
from quintet.components.shared.smoothing.smoothing import gradient
from quintet.components.sph_solid.laws import (
    SINGULAR,
    PairLaw,
    approach,
    inverse,
    times,
    viscous_pressure,
)
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
        m00, m01, m02, m10, m11, m12, m20, m21, m22 = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
        kxx, kyy, kzz, kxy, kyz, kzx, broken = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
        for k in range(count):
            dx, dy, dz = x - near[k, 0], y - near[k, 1], z - near[k, 2]
            r2 = dx * dx + dy * dy + dz * dz
            per_r = ONE / math.sqrt(r2 + law.smoothing.tiny)
            weight = gradient(r2, per_r, law.smoothing) * near[k, 3]
            gx, gy, gz = weight * dx, weight * dy, weight * dz
            du, dv, dw = moves[k, 0] - u, moves[k, 1] - v, moves[k, 2] - w
            m00 += du * gx
            m01 += du * gy
            m02 += du * gz
            m10 += dv * gx
            m11 += dv * gy
            m12 += dv * gz
            m20 += dw * gx
            m21 += dw * gy
            m22 += dw * gz
            if law.corrected is not None:
                kxx -= dx * gx
                kyy -= dy * gy
                kzz -= dz * gz
                kxy -= dx * gy
                kyz -= dy * gz
                kzx -= dz * gx
                broken -= weight * moves[k, 3]
        found = m00, m01, m02, m10, m11, m12, m20, m21, m22
        if law.corrected is not None:
            matrix, determinant = inverse((kxx, kyy, kzz, kxy, kyz, kzx), law)
            if motion[i, 3] == 0.0 and broken == 0.0 and determinant > SINGULAR:
                found = times(found, matrix)
            else:
                matrix = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
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
    stress : (n + images, 8 or 12) float array
        τ, six of a symmetric matrix or nine of a corrected one, and ρ, ρ₀.
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
    tension = empty_rows(rows, 8 if law.corrected is None else 12, place.dtype)
    slowest, greatest = math.inf, 0.0
    for i in range(first, last):
        x, y, z = place[i, 0], place[i, 1], place[i, 2]
        u, v, w, sound = motion[i, 0], motion[i, 1], motion[i, 2], motion[i, 3]
        outside = out_of_reach(x, law.smoothing.length), y, z, 0.0
        count = pack_rows(begin[i], end[i], neighbour, place, outside, near)
        pack_rows(begin[i], end[i], neighbour, motion, (u, v, w, sound), moves)
        fx, fy, fz, heat, fastest = 0.0, 0.0, 0.0, 0.0, np.int64(0)
        if law.corrected is None:
            t0, t1, t2, t3 = stress[i, 0], stress[i, 1], stress[i, 2], stress[i, 3]
            t4, t5, density, start = stress[i, 4], stress[i, 5], stress[i, 6], stress[i, 7]
            padding = t0, t1, t2, t3, t4, t5, density, start
            pack_rows(begin[i], end[i], neighbour, stress, padding, tension)
            for k in range(count):
                dx, dy, dz = x - near[k, 0], y - near[k, 1], z - near[k, 2]
                du, dv, dw = u - moves[k, 0], v - moves[k, 1], w - moves[k, 2]
                r2 = dx * dx + dy * dy + dz * dz
                dot = dx * du + dy * dv + dz * dw
                per_r = ONE / math.sqrt(r2 + law.smoothing.tiny)
                weight = gradient(r2, per_r, law.smoothing) * near[k, 3]
                mu = approach(r2, dot, law)
                q = viscous_pressure(
                    mu, sound + moves[k, 3], density + tension[k, 6], start * tension[k, 7], law
                )
                fastest = max(fastest, bits_of(mu))
                xx, yy, zz = t0 + tension[k, 0] - q, t1 + tension[k, 1] - q, t2 + tension[k, 2] - q
                xy, yz, zx = t3 + tension[k, 3], t4 + tension[k, 4], t5 + tension[k, 5]
                fx += weight * (xx * dx + xy * dy + zx * dz)
                fy += weight * (xy * dx + yy * dy + yz * dz)
                fz += weight * (zx * dx + yz * dy + zz * dz)
                heat += weight * q * dot
        else:
            t0, t1, t2, t3 = stress[i, 0], stress[i, 1], stress[i, 2], stress[i, 3]
            t4, t5, t6, t7 = stress[i, 4], stress[i, 5], stress[i, 6], stress[i, 7]
            t8, density, start = stress[i, 8], stress[i, 9], stress[i, 10]
            filling = t0, t1, t2, t3, t4, t5, t6, t7, t8, density, start, 0.0
            pack_rows(begin[i], end[i], neighbour, stress, filling, tension)
            for k in range(count):
                dx, dy, dz = x - near[k, 0], y - near[k, 1], z - near[k, 2]
                du, dv, dw = u - moves[k, 0], v - moves[k, 1], w - moves[k, 2]
                r2 = dx * dx + dy * dy + dz * dz
                dot = dx * du + dy * dv + dz * dw
                per_r = ONE / math.sqrt(r2 + law.smoothing.tiny)
                weight = gradient(r2, per_r, law.smoothing) * near[k, 3]
                mu = approach(r2, dot, law)
                q = viscous_pressure(
                    mu, sound + moves[k, 3], density + tension[k, 9], start * tension[k, 10], law
                )
                fastest = max(fastest, bits_of(mu))
                a0, a1, a2 = t0 + tension[k, 0] - q, t1 + tension[k, 1], t2 + tension[k, 2]
                a3, a4, a5 = t3 + tension[k, 3], t4 + tension[k, 4] - q, t5 + tension[k, 5]
                a6, a7, a8 = t6 + tension[k, 6], t7 + tension[k, 7], t8 + tension[k, 8] - q
                fx += weight * (a0 * dx + a1 * dy + a2 * dz)
                fy += weight * (a3 * dx + a4 * dy + a5 * dz)
                fz += weight * (a6 * dx + a7 * dy + a8 * dz)
                heat += weight * q * dot
        mu = number_of(fastest)
        per = 1.0 / start
        fx, fy, fz = fx * per, fy * per, fz * per
        acceleration[i, 0], acceleration[i, 1], acceleration[i, 2] = fx, fy, fz
        heating[i] = 0.5 * heat * per
        drag = law.linear * sound + law.quadratic * mu
        slowest = min(slowest, law.smoothing.length / (sound + 1.2 * drag))
        greatest = max(greatest, fx * fx + fy * fy + fz * fz)
    return slowest, greatest
