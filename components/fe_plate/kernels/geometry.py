"""Geometry of a block of elements: mean gradients of the corners, volumes, velocity gradients.

Rows are quantities, columns the elements of a block, so that each line of arithmetic is done for
several elements at once. Of a corner's three coordinates row 3a + d is the one along axis d.
"""

import numpy as np
from numba import njit

from quintet.components.shared.numba_options import FAST

LANES = 16  # elements of a block: their rows stay in the innermost cache
THIRD = 1.0 / 3.0
INLINED = FAST | {"no_cpython_wrapper": True, "no_cfunc_wrapper": True}


@njit(**INLINED)
def load_corners(values, corner, first, last, out):  # type: ignore[no-untyped-def]
    """Take values (n, 3) of the corners of elements [first, last); the last one fills the block."""
    for lane in range(LANES):
        e = min(first + lane, last - 1)
        for a in range(8):
            node = corner[e, a]
            for d in range(3):
                out[3 * a + d, lane] = values[node, d]


@njit(**INLINED)
def add_side(a, b, c, d, x, out):  # type: ignore[no-untyped-def]
    """Add ∫ N n dA over a bilinear side with these corners, seen from outside, to their rows.

    With r = r₀ + g₁ξ + g₂η + g₃ξη the area vector is g₁×g₂ + ξ g₁×g₃ + η g₃×g₂; N integrates to 1,
    ξN to ξ_N/3, ηN to η_N/3.
    """
    for k in range(LANES):
        ax, ay, az = x[3 * a, k], x[3 * a + 1, k], x[3 * a + 2, k]
        bx, by, bz = x[3 * b, k], x[3 * b + 1, k], x[3 * b + 2, k]
        cx, cy, cz = x[3 * c, k], x[3 * c + 1, k], x[3 * c + 2, k]
        dx, dy, dz = x[3 * d, k], x[3 * d + 1, k], x[3 * d + 2, k]
        # Four times g.
        ux, uy, uz = bx + cx - ax - dx, by + cy - ay - dy, bz + cz - az - dz
        vx, vy, vz = cx + dx - ax - bx, cy + dy - ay - by, cz + dz - az - bz
        wx, wy, wz = ax + cx - bx - dx, ay + cy - by - dy, az + cz - bz - dz
        nx, ny, nz = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
        px, py, pz = uy * wz - uz * wy, uz * wx - ux * wz, ux * wy - uy * wx
        qx, qy, qz = wy * vz - wz * vy, wz * vx - wx * vz, wx * vy - wy * vx
        nx, ny, nz = 0.0625 * nx, 0.0625 * ny, 0.0625 * nz
        sx, sy, sz = 0.0625 * THIRD * px, 0.0625 * THIRD * py, 0.0625 * THIRD * pz
        tx, ty, tz = 0.0625 * THIRD * qx, 0.0625 * THIRD * qy, 0.0625 * THIRD * qz
        out[3 * a, k] += nx - sx - tx
        out[3 * a + 1, k] += ny - sy - ty
        out[3 * a + 2, k] += nz - sz - tz
        out[3 * b, k] += nx + sx - tx
        out[3 * b + 1, k] += ny + sy - ty
        out[3 * b + 2, k] += nz + sz - tz
        out[3 * c, k] += nx + sx + tx
        out[3 * c + 1, k] += ny + sy + ty
        out[3 * c + 2, k] += nz + sz + tz
        out[3 * d, k] += nx - sx + tx
        out[3 * d + 1, k] += ny - sy + ty
        out[3 * d + 2, k] += nz - sz + tz


@njit(**INLINED)
def mean_gradients(x, gradient, volume):  # type: ignore[no-untyped-def]
    """Write ∫ ∂N/∂x dV = ∂V/∂x (24, lanes) m2 and V (lanes,) m3 of elements with corners x."""
    for row in range(24):
        for k in range(LANES):
            gradient[row, k] = 0.0
    add_side(0, 3, 2, 1, x, gradient)
    add_side(4, 5, 6, 7, x, gradient)
    add_side(0, 1, 5, 4, x, gradient)
    add_side(1, 2, 6, 5, x, gradient)
    add_side(2, 3, 7, 6, x, gradient)
    add_side(3, 0, 4, 7, x, gradient)
    for k in range(LANES):
        volume[k] = 0.0
    for row in range(24):
        for k in range(LANES):
            volume[k] += THIRD * x[row, k] * gradient[row, k]


@njit(**INLINED)
def velocity_gradients(v, gradient, volume, dt, out, at_end):  # type: ignore[no-untyped-def]
    """Write L_ab = ∂v_a/∂x_b (9, lanes) 1/s at the middle of the step, and `at_end` at its end.

    Corners are where they are at the end: with x = x_end - ½ dt v the gradient in the middle is
    L (I - ½ dt L)⁻¹, so that a rotation strains nothing.
    """
    for a in range(3):
        for b in range(3):
            for k in range(LANES):
                total = v[a, k] * gradient[b, k] + v[3 + a, k] * gradient[3 + b, k]
                total += v[6 + a, k] * gradient[6 + b, k] + v[9 + a, k] * gradient[9 + b, k]
                total += v[12 + a, k] * gradient[12 + b, k] + v[15 + a, k] * gradient[15 + b, k]
                total += v[18 + a, k] * gradient[18 + b, k] + v[21 + a, k] * gradient[21 + b, k]
                at_end[3 * a + b, k] = total / volume[k]
    half = 0.5 * dt
    for k in range(LANES):
        l00, l01, l02 = at_end[0, k], at_end[1, k], at_end[2, k]
        l10, l11, l12 = at_end[3, k], at_end[4, k], at_end[5, k]
        l20, l21, l22 = at_end[6, k], at_end[7, k], at_end[8, k]
        m00, m01, m02 = 1.0 - half * l00, -half * l01, -half * l02
        m10, m11, m12 = -half * l10, 1.0 - half * l11, -half * l12
        m20, m21, m22 = -half * l20, -half * l21, 1.0 - half * l22
        c00, c01, c02 = m11 * m22 - m12 * m21, m02 * m21 - m01 * m22, m01 * m12 - m02 * m11
        c10, c11, c12 = m12 * m20 - m10 * m22, m00 * m22 - m02 * m20, m02 * m10 - m00 * m12
        c20, c21, c22 = m10 * m21 - m11 * m20, m01 * m20 - m00 * m21, m00 * m11 - m01 * m10
        per = 1.0 / (m00 * c00 + m01 * c10 + m02 * c20)
        out[0, k] = per * (l00 * c00 + l01 * c10 + l02 * c20)
        out[1, k] = per * (l00 * c01 + l01 * c11 + l02 * c21)
        out[2, k] = per * (l00 * c02 + l01 * c12 + l02 * c22)
        out[3, k] = per * (l10 * c00 + l11 * c10 + l12 * c20)
        out[4, k] = per * (l10 * c01 + l11 * c11 + l12 * c21)
        out[5, k] = per * (l10 * c02 + l11 * c12 + l12 * c22)
        out[6, k] = per * (l20 * c00 + l21 * c10 + l22 * c20)
        out[7, k] = per * (l20 * c01 + l21 * c11 + l22 * c21)
        out[8, k] = per * (l20 * c02 + l21 * c12 + l22 * c22)


@njit(**FAST)
def write_volumes(position, corner, out) -> None:  # type: ignore[no-untyped-def]
    """Write the volumes (e,) m3 of elements whose corners are nodes at positions (n, 3) m."""
    x, gradient, volume = np.empty((24, LANES)), np.empty((24, LANES)), np.empty(LANES)
    last = len(corner)
    for begin in range(0, last, LANES):
        load_corners(position, corner, begin, last, x)
        mean_gradients(x, gradient, volume)
        for k in range(min(LANES, last - begin)):
            out[begin + k] = volume[k]
