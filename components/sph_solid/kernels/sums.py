"""Sums over the neighbours of one particle, whose rows stand side by side; inlined into the loops.

Rows of stress have six numbers of τ (xx yy zz xy yz zx), ρ and ρ₀; where gradients are corrected
nine (by rows), ρ and ρ₀; with artificial stresses six more follow. The functions that read them are
chosen by the types of `PairLaw.corrected` and `PairLaw.artificial`.
"""

import math

import numpy as np
from numba import njit, types
from numba.extending import overload

from quintet.components.shared.float_bits import bits_of
from quintet.components.shared.smoothing.cubic_spline import ONE, ZERO
from quintet.components.shared.smoothing.smoothing import gradient
from quintet.components.sph_solid.laws import (
    SINGULAR,
    add_force,
    add_moments,
    add_outer,
    inverse,
    inverses,
    repelled,
    times,
    viscous_pressure,
)


@njit(inline="always")
def sum_gradients(count, particle, near, moves, law):  # type: ignore[no-untyped-def]
    """Σ V_j (v_j - v_i) ⊗ ∇W_ij over neighbours, and what its correction needs.

    Parameters
    ----------
    count : int
        Rows of neighbours.
    particle : six floats
        x, y, z, u, v, w.
    near : (any, 4) float array
        x, y, z, V of the neighbours.
    moves : (any, 4) float array
        u, v, w, and whether they have failed.
    law : PairLaw

    Returns
    -------
    nine floats : the gradient
    six floats : Σ V_j (x_j - x_i) ⊗ ∇W_ij, xx yy zz xy yz zx
    float : 0 if no neighbour has failed
    """
    x, y, z, u, v, w = particle
    sums = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    matrix, broken = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0), 0.0
    for k in range(count):
        dx, dy, dz = x - near[k, 0], y - near[k, 1], z - near[k, 2]
        r2 = dx * dx + dy * dy + dz * dz
        per_r = ONE / math.sqrt(r2 + law.smoothing.tiny)
        weight = gradient(r2, per_r, law.smoothing) * near[k, 3]
        slope = weight * dx, weight * dy, weight * dz
        sums = add_outer(sums, (moves[k, 0] - u, moves[k, 1] - v, moves[k, 2] - w), slope)
        if law.corrected is not None:
            matrix = add_moments(matrix, (dx, dy, dz), slope)
            broken -= weight * moves[k, 3]
    return sums, matrix, broken


@njit(inline="always")
def corrected(velocity_gradient, matrix, whole, law):  # type: ignore[no-untyped-def]
    """Gradient of velocity, exact for linear fields, and the inverse matrix; zeros without."""
    inverted, determinant = inverse(matrix, law)
    if whole and determinant > SINGULAR:
        return times(velocity_gradient, inverted), inverted
    return velocity_gradient, (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


@njit(inline="always")
def sum_forces(count, particle, row, near, moves, tension, law):  # type: ignore[no-untyped-def]
    """Σ V_j (τ_i + τ_j - q_ij) ∇W_ij over neighbours, its heat, and bits of max|μ|.

    Parameters
    ----------
    count : int
        Rows of neighbours.
    particle : seven floats
        x, y, z, u, v, w, c.
    row : floats
        The particle's row of stress.
    near, moves, tension : (any, 4), (any, 4) and (any, 8, 12 or 16) float arrays
        x, y, z, V; u, v, w, c; rows of stress.
    law : PairLaw
    """
    x, y, z, u, v, w, sound = particle
    sums, fastest = (0.0, 0.0, 0.0, 0.0), np.int64(0)
    column = 6 if law.corrected is None else 9  # of ρ; that of ρ₀ follows
    density, start = densities(row, law)
    for k in range(count):
        dx, dy, dz = x - near[k, 0], y - near[k, 1], z - near[k, 2]
        du, dv, dw = u - moves[k, 0], v - moves[k, 1], w - moves[k, 2]
        r2 = dx * dx + dy * dy + dz * dz
        dot = dx * du + dy * dv + dz * dw
        per_r, per_r2, per_density = inverses(r2, density + tension[k, column], law)
        weight = gradient(r2, per_r, law.smoothing) * near[k, 3]
        mu = law.smoothing.length * max(-dot, ZERO) * per_r2
        starts = start * tension[k, column + 1]
        q = viscous_pressure(mu, sound + moves[k, 3], per_density, starts, law)
        fastest = max(fastest, bits_of(mu))
        stress = summed_stress(row, tension, k, law)
        push = repulsion(row, tension, k, (dx, dy, dz), r2, law)
        sums = add_force(sums, (dx, dy, dz), (du, dv, dw), dot, weight, stress, q, push, law)
    fx, fy, fz, heat = sums
    return fx, fy, fz, heat, fastest


def _has(law, name):  # type: ignore[no-untyped-def]
    """Whether an optional number of a law's type is not None."""
    return not isinstance(law.types[law.fields.index(name)], types.NoneType)


def stress_row(stress, i, law):  # type: ignore[no-untyped-def]
    """Row of stress of a particle, as a tuple: also what neighbours are filled up with."""


@overload(stress_row, inline="always")
def _stress_row(stress, i, law):  # type: ignore[no-untyped-def]
    def eight(stress, i, law):  # type: ignore[no-untyped-def]
        s = stress[i]
        return s[0], s[1], s[2], s[3], s[4], s[5], s[6], s[7]

    def twelve(stress, i, law):  # type: ignore[no-untyped-def]
        s = stress[i]
        return s[0], s[1], s[2], s[3], s[4], s[5], s[6], s[7], s[8], s[9], s[10], 0.0

    def sixteen(stress, i, law):  # type: ignore[no-untyped-def]
        s = stress[i]
        return (
            s[0], s[1], s[2], s[3], s[4], s[5], s[6], s[7], s[8], s[9], s[10], s[11], s[12], s[13],
            0.0, 0.0,
        )  # fmt: skip

    if _has(law, "artificial"):
        return sixteen
    return twelve if _has(law, "corrected") else eight


def densities(row, law):  # type: ignore[no-untyped-def]
    """ρ and ρ₀ [kg/m3] of a particle, from its row of stress."""


@overload(densities, inline="always")
def _densities(row, law):  # type: ignore[no-untyped-def]
    if _has(law, "corrected"):
        return lambda row, law: (row[9], row[10])
    return lambda row, law: (row[6], row[7])


def summed_stress(row, tension, k, law):  # type: ignore[no-untyped-def]
    """τ_i + τ_j [Pa], nine numbers by rows, of a particle's row and row k of its neighbours."""


@overload(summed_stress, inline="always")
def _summed_stress(row, tension, k, law):  # type: ignore[no-untyped-def]
    def symmetric(row, tension, k, law):  # type: ignore[no-untyped-def]
        xx, yy, zz = row[0] + tension[k, 0], row[1] + tension[k, 1], row[2] + tension[k, 2]
        xy, yz, zx = row[3] + tension[k, 3], row[4] + tension[k, 4], row[5] + tension[k, 5]
        return xx, xy, zx, xy, yy, yz, zx, yz, zz

    def general(row, tension, k, law):  # type: ignore[no-untyped-def]
        return (
            row[0] + tension[k, 0], row[1] + tension[k, 1], row[2] + tension[k, 2],
            row[3] + tension[k, 3], row[4] + tension[k, 4], row[5] + tension[k, 5],
            row[6] + tension[k, 6], row[7] + tension[k, 7], row[8] + tension[k, 8],
        )  # fmt: skip

    return general if _has(law, "corrected") else symmetric


def repulsion(row, tension, k, offset, r2, law):  # type: ignore[no-untyped-def]
    """f⁴ (R_i + R_j)·r_ij [Pa m] of the artificial stresses; zeros without."""


@overload(repulsion, inline="always")
def _repulsion(row, tension, k, offset, r2, law):  # type: ignore[no-untyped-def]
    def artificial(row, tension, k, offset, r2, law):  # type: ignore[no-untyped-def]
        stress = (
            row[8] + tension[k, 8], row[9] + tension[k, 9], row[10] + tension[k, 10],
            row[11] + tension[k, 11], row[12] + tension[k, 12], row[13] + tension[k, 13],
        )  # fmt: skip
        return repelled(stress, offset, r2, law)

    if _has(law, "artificial"):
        return artificial
    return lambda row, tension, k, offset, r2, law: (0.0, 0.0, 0.0)
