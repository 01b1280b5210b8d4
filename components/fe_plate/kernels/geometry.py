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
    LENGTH,
    PATTERN,
    RATE,
    ROWS,
    VOLUME,
    V,
    X,
    load_corners,
    nine,
    patterns_of,
    put_nine,
    put_three,
    three,
)
from quintet.components.fe_plate.laws import to_middle
from quintet.components.fe_plate.state import LANES
from quintet.components.shared.numba_options import FAST, FAST_LANEWISE

CUBE = math.sqrt(3.0)  # edge of a cube over the length of its bound
THIRD = 1.0 / 3.0


@njit(**FAST_LANEWISE)
def cross(a, b):  # type: ignore[no-untyped-def]
    """Cross product a x b of vectors as tuples."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


@njit(**FAST_LANEWISE)
def dot(a, b):  # type: ignore[no-untyped-def]
    """Product a·b of vectors as tuples."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@njit(**FAST_LANEWISE)
def mixed(a, b, c, d):  # type: ignore[no-untyped-def]
    """Third (a x b + c x d)/3."""
    p, q = cross(a, b), cross(c, d)
    return THIRD * (p[0] + q[0]), THIRD * (p[1] + q[1]), THIRD * (p[2] + q[2])


@njit(**FAST_LANEWISE)
def with_third(a, b, c, d):  # type: ignore[no-untyped-def]
    """Sum a x b + c x d/3."""
    p, q = cross(a, b), cross(c, d)
    return p[0] + THIRD * q[0], p[1] + THIRD * q[1], p[2] + THIRD * q[2]


@njit(**FAST_LANEWISE)
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


@njit(**FAST_LANEWISE)
def row_of(v, a1, a2, a3, c1, c2, c3, d, scale):  # type: ignore[no-untyped-def]
    """∂v/∂x_d of a velocity's patterns along one axis."""
    linear = v[1] * a1[d] + v[2] * a2[d] + v[3] * a3[d]
    return scale * (linear + v[4] * c1[d] + v[5] * c2[d] + v[6] * c3[d])


@njit(**FAST_LANEWISE)
def mean_geometry(work, dt):  # type: ignore[no-untyped-def]
    """Write volumes, lengths, gradients, hourglass patterns and their rates from the corners.

    The length √½ V/√Σ B² over the speed of sound is a proven stable step: 0.58 of a cube's edge.
    Three loops, for the numbers of one would not fit into a processor's registers.
    """
    half = 0.5 * dt
    for k in range(LANES):
        x, y, z = patterns_of(work, X, k), patterns_of(work, X + 1, k), patterns_of(work, X + 2, k)
        a1, a2, a3, c1, c2, c3, volume = mean_coefficients(x, y, z)
        squares = dot(a1, a1) + dot(a2, a2) + dot(a3, a3) + dot(c1, c1) + dot(c2, c2) + dot(c3, c3)
        length = 0.25 * volume / math.sqrt(squares)
        work[VOLUME * LANES + k] = volume
        work[LENGTH * LANES + k] = length
        work[EDGE * LANES + k] = CUBE * length
        put_three(work, COEFFICIENT, k, a1)
        put_three(work, COEFFICIENT + 3, k, a2)
        put_three(work, COEFFICIENT + 6, k, a3)
        put_three(work, COEFFICIENT + 9, k, c1)
        put_three(work, COEFFICIENT + 12, k, c2)
        put_three(work, COEFFICIENT + 15, k, c3)
        put_three(work, PATTERN, k, (8.0 * x[4], 8.0 * y[4], 8.0 * z[4]))
        put_three(work, PATTERN + 3, k, (8.0 * x[5], 8.0 * y[5], 8.0 * z[5]))
        put_three(work, PATTERN + 6, k, (8.0 * x[6], 8.0 * y[6], 8.0 * z[6]))
        put_three(work, PATTERN + 9, k, (8.0 * x[7], 8.0 * y[7], 8.0 * z[7]))
    for k in range(LANES):
        put_rates(work, k, 0)
        put_rates(work, k, 1)
        put_rates(work, k, 2)
    for k in range(LANES):
        put_nine(work, GRADIENT, k, to_middle(nine(work, GRADIENT, k), half))


@njit(**FAST_LANEWISE)
def put_rates(work, k, axis):  # type: ignore[no-untyped-def]
    """Write the gradient of the velocity along an axis, and what of h·v [m/s] it does not explain.

    The gradient is that at the step's end; h are the hourglass patterns.
    """
    v, per = patterns_of(work, V + axis, k), 8.0 / work[VOLUME * LANES + k]
    a1, a2 = three(work, COEFFICIENT, k), three(work, COEFFICIENT + 3, k)
    a3, c1 = three(work, COEFFICIENT + 6, k), three(work, COEFFICIENT + 9, k)
    c2, c3 = three(work, COEFFICIENT + 12, k), three(work, COEFFICIENT + 15, k)
    row = (
        row_of(v, a1, a2, a3, c1, c2, c3, 0, per),
        row_of(v, a1, a2, a3, c1, c2, c3, 1, per),
        row_of(v, a1, a2, a3, c1, c2, c3, 2, per),
    )
    put_three(work, GRADIENT + 3 * axis, k, row)
    p1, p2 = three(work, PATTERN, k), three(work, PATTERN + 3, k)
    p3, p4 = three(work, PATTERN + 6, k), three(work, PATTERN + 9, k)
    work[(RATE + axis) * LANES + k] = 8.0 * v[4] - dot(row, p1)
    work[(RATE + 3 + axis) * LANES + k] = 8.0 * v[5] - dot(row, p2)
    work[(RATE + 6 + axis) * LANES + k] = 8.0 * v[6] - dot(row, p3)
    work[(RATE + 9 + axis) * LANES + k] = 8.0 * v[7] - dot(row, p4)


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
