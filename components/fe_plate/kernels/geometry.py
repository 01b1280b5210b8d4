"""Geometry of elements with one quadrature point: mean gradients, volumes, velocity gradients.

Within an element x = Σ x_m p_m with the patterns 1, ξ, η, ζ, ηζ, ζξ, ξη and ξηζ, so that with
j₁, j₂, j₃ of the linear and g₁, g₂, g₃ of the bilinear ones

    V = 8 [j₁, j₂, j₃] + 8/3 ([j₁, g₃, g₂] + [g₂, g₁, j₃] + [g₃, j₂, g₁])

exactly, the last pattern having no part. Its slope ∂V/∂x_a = ∫ ∂N_a/∂x dV, which Flanagan and
Belytschko (1981, equation 24) take for the mean gradient, is a sum of six vectors with the signs of
corner a: A₁ = j₂×j₃ + g₃×g₂/3 and so on.
"""

import math

import numpy as np
from numba import njit

from quintet.components.fe_plate.kernels.blocks import (
    COEFFICIENT,
    EDGE,
    GRADIENT,
    INLINED,
    LANES,
    LENGTH,
    PATTERN,
    RATE,
    ROWS,
    VOLUME,
    V,
    X,
    load_corners,
    patterns_of,
    put_nine,
    put_three,
)
from quintet.components.shared.numba_options import FAST

CUBE = math.sqrt(3.0)  # edge of a cube over the length of its bound
THIRD = 1.0 / 3.0


@njit(**INLINED)
def cross(a, b):  # type: ignore[no-untyped-def]
    """Cross product a x b of vectors as tuples."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


@njit(**INLINED)
def dot(a, b):  # type: ignore[no-untyped-def]
    """Product a·b of vectors as tuples."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@njit(**INLINED)
def mixed(a, b, c, d):  # type: ignore[no-untyped-def]
    """Third (a x b + c x d)/3."""
    p, q = cross(a, b), cross(c, d)
    return THIRD * (p[0] + q[0]), THIRD * (p[1] + q[1]), THIRD * (p[2] + q[2])


@njit(**INLINED)
def with_third(a, b, c, d):  # type: ignore[no-untyped-def]
    """Sum a x b + c x d/3."""
    p, q = cross(a, b), cross(c, d)
    return p[0] + THIRD * q[0], p[1] + THIRD * q[1], p[2] + THIRD * q[2]


@njit(**INLINED)
def mean_coefficients(x, y, z):  # type: ignore[no-untyped-def]
    """Vectors A₁, A₂, A₃ of ξ, η, ζ and C₁, C₂, C₃ of ηζ, ζξ, ξη [m2], and the volume [m3].

    `x`, `y` and `z` are the eight patterns of the corners along each axis.
    """
    j1, j2, j3 = (x[1], y[1], z[1]), (x[2], y[2], z[2]), (x[3], y[3], z[3])
    g1, g2, g3 = (x[4], y[4], z[4]), (x[5], y[5], z[5]), (x[6], y[6], z[6])
    a1 = with_third(j2, j3, g3, g2)
    a2 = with_third(j3, j1, g1, g3)
    a3 = with_third(j1, j2, g2, g1)
    c1, c2, c3 = mixed(j3, g2, g3, j2), mixed(j1, g3, g1, j3), mixed(g2, j1, j2, g1)
    volume = dot(j1, a1) + dot(j2, a2) + dot(j3, a3) + dot(g1, c1) + dot(g2, c2) + dot(g3, c3)
    return a1, a2, a3, c1, c2, c3, 8.0 * THIRD * volume


@njit(**INLINED)
def to_middle(gradient, half):  # type: ignore[no-untyped-def]
    """Velocity gradient at the middle of a step of twice `half` [s], from that at its end.

    Corners are where they are at the end: with x = x_end - ½ dt v the gradient in the middle is
    L (I - ½ dt L)⁻¹, so that a rotation strains nothing.
    """
    l00, l01, l02, l10, l11, l12, l20, l21, l22 = gradient
    m00, m01, m02 = 1.0 - half * l00, -half * l01, -half * l02
    m10, m11, m12 = -half * l10, 1.0 - half * l11, -half * l12
    m20, m21, m22 = -half * l20, -half * l21, 1.0 - half * l22
    c00, c01, c02 = m11 * m22 - m12 * m21, m02 * m21 - m01 * m22, m01 * m12 - m02 * m11
    c10, c11, c12 = m12 * m20 - m10 * m22, m00 * m22 - m02 * m20, m02 * m10 - m00 * m12
    c20, c21, c22 = m10 * m21 - m11 * m20, m01 * m20 - m00 * m21, m00 * m11 - m01 * m10
    per = 1.0 / (m00 * c00 + m01 * c10 + m02 * c20)
    return (
        per * (l00 * c00 + l01 * c10 + l02 * c20),
        per * (l00 * c01 + l01 * c11 + l02 * c21),
        per * (l00 * c02 + l01 * c12 + l02 * c22),
        per * (l10 * c00 + l11 * c10 + l12 * c20),
        per * (l10 * c01 + l11 * c11 + l12 * c21),
        per * (l10 * c02 + l11 * c12 + l12 * c22),
        per * (l20 * c00 + l21 * c10 + l22 * c20),
        per * (l20 * c01 + l21 * c11 + l22 * c21),
        per * (l20 * c02 + l21 * c12 + l22 * c22),
    )


@njit(**INLINED)
def row_of(v, a1, a2, a3, c1, c2, c3, d, scale):  # type: ignore[no-untyped-def]
    """∂v/∂x_d of a velocity's patterns along one axis."""
    linear = v[1] * a1[d] + v[2] * a2[d] + v[3] * a3[d]
    return scale * (linear + v[4] * c1[d] + v[5] * c2[d] + v[6] * c3[d])


@njit(**INLINED)
def mean_geometry(work, dt):  # type: ignore[no-untyped-def]
    """Write volumes, lengths, gradients, hourglass patterns and their rates from the corners.

    The length √½ V/√Σ B² over the speed of sound is a proven stable step: 0.58 of a cube's edge.
    """
    half = 0.5 * dt
    for k in range(LANES):
        x, y, z = patterns_of(work, X, k), patterns_of(work, X + 1, k), patterns_of(work, X + 2, k)
        u, v, w = patterns_of(work, V, k), patterns_of(work, V + 1, k), patterns_of(work, V + 2, k)
        a1, a2, a3, c1, c2, c3, volume = mean_coefficients(x, y, z)
        squares = dot(a1, a1) + dot(a2, a2) + dot(a3, a3) + dot(c1, c1) + dot(c2, c2) + dot(c3, c3)
        length = 0.25 * volume / math.sqrt(squares)
        work[VOLUME * LANES + k] = volume
        work[LENGTH * LANES + k] = length
        work[EDGE * LANES + k] = CUBE * length
        per = 8.0 / volume
        l00 = row_of(u, a1, a2, a3, c1, c2, c3, 0, per)
        l01 = row_of(u, a1, a2, a3, c1, c2, c3, 1, per)
        l02 = row_of(u, a1, a2, a3, c1, c2, c3, 2, per)
        l10 = row_of(v, a1, a2, a3, c1, c2, c3, 0, per)
        l11 = row_of(v, a1, a2, a3, c1, c2, c3, 1, per)
        l12 = row_of(v, a1, a2, a3, c1, c2, c3, 2, per)
        l20 = row_of(w, a1, a2, a3, c1, c2, c3, 0, per)
        l21 = row_of(w, a1, a2, a3, c1, c2, c3, 1, per)
        l22 = row_of(w, a1, a2, a3, c1, c2, c3, 2, per)
        end = l00, l01, l02, l10, l11, l12, l20, l21, l22
        put_nine(work, GRADIENT, k, to_middle(end, half))
        put_three(work, COEFFICIENT, k, a1)
        put_three(work, COEFFICIENT + 3, k, a2)
        put_three(work, COEFFICIENT + 6, k, a3)
        put_three(work, COEFFICIENT + 9, k, c1)
        put_three(work, COEFFICIENT + 12, k, c2)
        put_three(work, COEFFICIENT + 15, k, c3)
        put_pattern(work, 0, k, (x[4], y[4], z[4]), (u[4], v[4], w[4]), end)
        put_pattern(work, 3, k, (x[5], y[5], z[5]), (u[5], v[5], w[5]), end)
        put_pattern(work, 6, k, (x[6], y[6], z[6]), (u[6], v[6], w[6]), end)
        put_pattern(work, 9, k, (x[7], y[7], z[7]), (u[7], v[7], w[7]), end)


@njit(**INLINED)
def put_pattern(work, row, k, at, rate, gradient):  # type: ignore[no-untyped-def]
    """Write h·x [m] of a hourglass pattern, and the part of h·v [m/s] that no gradient explains."""
    l00, l01, l02, l10, l11, l12, l20, l21, l22 = gradient
    px, py, pz = at
    ux, uy, uz = rate
    ux -= l00 * px + l01 * py + l02 * pz
    uy -= l10 * px + l11 * py + l12 * pz
    uz -= l20 * px + l21 * py + l22 * pz
    put_three(work, PATTERN + row, k, (8.0 * px, 8.0 * py, 8.0 * pz))
    put_three(work, RATE + row, k, (8.0 * ux, 8.0 * uy, 8.0 * uz))


@njit(**FAST)
def write_volumes(position, corner, beyond, out) -> None:  # type: ignore[no-untyped-def]
    """Write the volumes (e,) m3 of elements whose corners are nodes at positions (n, 3) m."""
    work = np.zeros(ROWS * LANES)
    for begin in range(0, len(corner), LANES):
        count = min(LANES, len(corner) - begin)
        load_corners(position, corner, begin, count, beyond, X, work)
        for k in range(count):
            x, y = patterns_of(work, X, k), patterns_of(work, X + 1, k)
            out[begin + k] = mean_coefficients(x, y, patterns_of(work, X + 2, k))[6]
