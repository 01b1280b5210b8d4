"""Sums over the neighbours of one particle, which stand side by side; inlined into the loops."""

import math

import numpy as np
from numba import njit, types
from numba.extending import overload

from quintet.components.shared.float_bits import bits_of
from quintet.components.shared.smoothing.cubic_spline import ONE, ZERO
from quintet.components.shared.smoothing.smoothing import gradient
from quintet.components.sph_solid.laws import (
    SINGULAR,
    inverse,
    inverses,
    nearness,
    times,
    viscous_pressure,
)


@njit(inline="always")
def sum_gradients(count, x, y, z, u, v, w, near, moves, law):  # type: ignore[no-untyped-def]
    """Σ V_j (v_j - v_i) ⊗ ∇W_ij over so many neighbours, side by side, and what corrects it.

    The correction is of the matrix Σ V_j (x_j - x_i) ⊗ ∇W_ij, xx yy zz xy yz zx, and of how much
    of the neighbours has failed.
    """
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
    matrix = kxx, kyy, kzz, kxy, kyz, kzx
    return (m00, m01, m02, m10, m11, m12, m20, m21, m22), matrix, broken


@njit(inline="always")
def corrected(found, matrix, whole, law):  # type: ignore[no-untyped-def]
    """Gradient of velocity, exact for linear fields, and the inverse matrix; zeros without."""
    inverted, determinant = inverse(matrix, law)
    if whole and determinant > SINGULAR:
        return times(found, inverted), inverted
    return found, (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


@njit(inline="always")
def sum_six(  # type: ignore[no-untyped-def]
    count, x, y, z, u, v, w, sound, density, start, own, near, moves, tension, law
):
    """Σ V_j (τ_i + τ_j - q_ij) ∇W_ij over so many neighbours, its heat, and bits of max|μ|."""
    fx, fy, fz, heat, fastest = 0.0, 0.0, 0.0, 0.0, np.int64(0)
    t0, t1, t2, t3, t4, t5 = own
    for k in range(count):
        dx, dy, dz = x - near[k, 0], y - near[k, 1], z - near[k, 2]
        du, dv, dw = u - moves[k, 0], v - moves[k, 1], w - moves[k, 2]
        r2 = dx * dx + dy * dy + dz * dz
        dot = dx * du + dy * dv + dz * dw
        per_r, per_r2, per_density = inverses(r2, density + tension[k, 6], law)
        weight = gradient(r2, per_r, law.smoothing) * near[k, 3]
        mu = law.smoothing.length * max(-dot, ZERO) * per_r2
        q = viscous_pressure(mu, sound + moves[k, 3], per_density, start * tension[k, 7], law)
        fastest = max(fastest, bits_of(mu))
        xx, yy, zz = t0 + tension[k, 0] - q, t1 + tension[k, 1] - q, t2 + tension[k, 2] - q
        xy, yz, zx = t3 + tension[k, 3], t4 + tension[k, 4], t5 + tension[k, 5]
        fx += weight * (xx * dx + xy * dy + zx * dz)
        fy += weight * (xy * dx + yy * dy + yz * dz)
        fz += weight * (zx * dx + yz * dy + zz * dz)
        heat += weight * q * dot
    return fx, fy, fz, heat, fastest


@njit(inline="always")
def sum_nine(  # type: ignore[no-untyped-def]
    count, x, y, z, u, v, w, sound, density, start, own, near, moves, tension, law
):
    """The same of corrected tensors, which are not symmetric."""
    fx, fy, fz, heat, fastest = 0.0, 0.0, 0.0, 0.0, np.int64(0)
    t0, t1, t2, t3, t4, t5, t6, t7, t8 = own
    for k in range(count):
        dx, dy, dz = x - near[k, 0], y - near[k, 1], z - near[k, 2]
        du, dv, dw = u - moves[k, 0], v - moves[k, 1], w - moves[k, 2]
        r2 = dx * dx + dy * dy + dz * dz
        dot = dx * du + dy * dv + dz * dw
        per_r, per_r2, per_density = inverses(r2, density + tension[k, 9], law)
        weight = gradient(r2, per_r, law.smoothing) * near[k, 3]
        mu = law.smoothing.length * max(-dot, ZERO) * per_r2
        q = viscous_pressure(mu, sound + moves[k, 3], per_density, start * tension[k, 10], law)
        fastest = max(fastest, bits_of(mu))
        a0, a1, a2 = t0 + tension[k, 0] - q, t1 + tension[k, 1], t2 + tension[k, 2]
        a3, a4, a5 = t3 + tension[k, 3], t4 + tension[k, 4] - q, t5 + tension[k, 5]
        a6, a7, a8 = t6 + tension[k, 6], t7 + tension[k, 7], t8 + tension[k, 8] - q
        fx += weight * (a0 * dx + a1 * dy + a2 * dz)
        fy += weight * (a3 * dx + a4 * dy + a5 * dz)
        fz += weight * (a6 * dx + a7 * dy + a8 * dz)
        heat += weight * q * dot
    return fx, fy, fz, heat, fastest


@njit(inline="always")
def sum_repelled(  # type: ignore[no-untyped-def]
    count, x, y, z, u, v, w, sound, density, start, own, near, moves, tension, law
):
    """The same of symmetric tensors, with artificial ones that act between the nearest."""
    fx, fy, fz, heat, fastest = 0.0, 0.0, 0.0, 0.0, np.int64(0)
    t0, t1, t2, t3, t4, t5, r0, r1, r2, r3, r4, r5 = own
    for k in range(count):
        dx, dy, dz = x - near[k, 0], y - near[k, 1], z - near[k, 2]
        du, dv, dw = u - moves[k, 0], v - moves[k, 1], w - moves[k, 2]
        square = dx * dx + dy * dy + dz * dz
        dot = dx * du + dy * dv + dz * dw
        per_r, per_r2, per_density = inverses(square, density + tension[k, 6], law)
        weight = gradient(square, per_r, law.smoothing) * near[k, 3]
        mu = law.smoothing.length * max(-dot, ZERO) * per_r2
        q = viscous_pressure(mu, sound + moves[k, 3], per_density, start * tension[k, 7], law)
        fastest = max(fastest, bits_of(mu))
        f = nearness(square, law)
        xx, yy, zz = f * (r0 + tension[k, 8]), f * (r1 + tension[k, 9]), f * (r2 + tension[k, 10])
        xy, yz, zx = f * (r3 + tension[k, 11]), f * (r4 + tension[k, 12]), f * (r5 + tension[k, 13])
        ax = xx * dx + xy * dy + zx * dz
        ay = xy * dx + yy * dy + yz * dz
        az = zx * dx + yz * dy + zz * dz
        heat += weight * (q * dot - (ax * du + ay * dv + az * dw))
        xx, yy, zz = t0 + tension[k, 0] - q, t1 + tension[k, 1] - q, t2 + tension[k, 2] - q
        xy, yz, zx = t3 + tension[k, 3], t4 + tension[k, 4], t5 + tension[k, 5]
        fx += weight * (xx * dx + xy * dy + zx * dz + ax)
        fy += weight * (xy * dx + yy * dy + yz * dz + ay)
        fz += weight * (zx * dx + yz * dy + zz * dz + az)
    return fx, fy, fz, heat, fastest


def own_stress(stress, i, corrected, artificial):  # type: ignore[no-untyped-def]
    """Row of stress of a particle: its tensor, ρ, ρ₀, and all of it, to fill up neighbours with."""


@overload(own_stress, inline="always")
def _own_stress(stress, i, corrected, artificial):  # type: ignore[no-untyped-def]
    def six(stress, i, corrected, artificial):  # type: ignore[no-untyped-def]
        t0, t1, t2, t3 = stress[i, 0], stress[i, 1], stress[i, 2], stress[i, 3]
        t4, t5, density, start = stress[i, 4], stress[i, 5], stress[i, 6], stress[i, 7]
        row = t0, t1, t2, t3, t4, t5, density, start
        return (t0, t1, t2, t3, t4, t5), density, start, row

    def nine(stress, i, corrected, artificial):  # type: ignore[no-untyped-def]
        t0, t1, t2, t3 = stress[i, 0], stress[i, 1], stress[i, 2], stress[i, 3]
        t4, t5, t6, t7 = stress[i, 4], stress[i, 5], stress[i, 6], stress[i, 7]
        t8, density, start = stress[i, 8], stress[i, 9], stress[i, 10]
        row = t0, t1, t2, t3, t4, t5, t6, t7, t8, density, start, 0.0
        return (t0, t1, t2, t3, t4, t5, t6, t7, t8), density, start, row

    def twelve(stress, i, corrected, artificial):  # type: ignore[no-untyped-def]
        t0, t1, t2, t3 = stress[i, 0], stress[i, 1], stress[i, 2], stress[i, 3]
        t4, t5, density, start = stress[i, 4], stress[i, 5], stress[i, 6], stress[i, 7]
        r0, r1, r2, r3 = stress[i, 8], stress[i, 9], stress[i, 10], stress[i, 11]
        r4, r5 = stress[i, 12], stress[i, 13]
        own = t0, t1, t2, t3, t4, t5, r0, r1, r2, r3, r4, r5
        row = t0, t1, t2, t3, t4, t5, density, start, r0, r1, r2, r3, r4, r5, 0.0, 0.0
        return own, density, start, row

    if not isinstance(artificial, types.NoneType):
        return twelve
    return six if isinstance(corrected, types.NoneType) else nine


def sum_forces(  # type: ignore[no-untyped-def]
    count, x, y, z, u, v, w, sound, density, start, own, near, moves, tension, law, corrected,
    artificial,
):  # fmt: skip
    """The sums of symmetric tensors, or of corrected ones, or with artificial ones."""


@overload(sum_forces, inline="always")
def _sum_forces(  # type: ignore[no-untyped-def]
    count, x, y, z, u, v, w, sound, density, start, own, near, moves, tension, law, corrected,
    artificial,
):  # fmt: skip
    def six(  # type: ignore[no-untyped-def]
        count, x, y, z, u, v, w, sound, density, start, own, near, moves, tension, law, corrected,
        artificial,
    ):  # fmt: skip
        return sum_six(
            count, x, y, z, u, v, w, sound, density, start, own, near, moves, tension, law
        )

    def nine(  # type: ignore[no-untyped-def]
        count, x, y, z, u, v, w, sound, density, start, own, near, moves, tension, law, corrected,
        artificial,
    ):  # fmt: skip
        return sum_nine(
            count, x, y, z, u, v, w, sound, density, start, own, near, moves, tension, law
        )

    def twelve(  # type: ignore[no-untyped-def]
        count, x, y, z, u, v, w, sound, density, start, own, near, moves, tension, law, corrected,
        artificial,
    ):  # fmt: skip
        return sum_repelled(
            count, x, y, z, u, v, w, sound, density, start, own, near, moves, tension, law
        )

    if not isinstance(artificial, types.NoneType):
        return twelve
    return six if isinstance(corrected, types.NoneType) else nine
