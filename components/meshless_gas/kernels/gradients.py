"""Gradients by least squares, and the least pressure around each node."""

from typing import Any

import numpy as np
from numba import njit

from quintet.components.shared.numba_options import FAST


@njit(**FAST)
def write_gradients(
    first: int,
    last: int,
    rows: Any,
    primitive: Any,
    neighbours: Any,
    coefficients: Any,
    planar: Any,
    gradients: Any,
    lowest: Any,
) -> None:
    """Write ∇φ_i = Σ c_ij (φ_j - φ_i) of density, velocity and pressure.

    Parameters
    ----------
    gradients : (n, 5 or more, 3)
        Written.
    lowest : (n,) Pa
        Written: least pressure of a node and its neighbours.

    References
    ----------
    Katz & Jameson, AIAA J. 48 (2010) 1756, section II.
    """
    for row in range(first, last):
        i = np.uintp(rows[row])
        r, u, w, p = primitive[i, 0], primitive[i, 1], primitive[i, 3], primitive[i, 4]
        v = primitive[i, 2]
        least = p
        rx = rz = ux = uz = wx = wz = px = pz = 0.0
        ry = uy = wy = py = vx = vy = vz = 0.0
        for k in range(neighbours.shape[1]):
            j = np.uintp(neighbours[i, k])
            cx, cz = coefficients[i, k, 0], coefficients[i, k, 2]
            dr, du = primitive[j, 0] - r, primitive[j, 1] - u
            dw, dp = primitive[j, 3] - w, primitive[j, 4] - p
            rx, rz = rx + cx * dr, rz + cz * dr
            ux, uz = ux + cx * du, uz + cz * du
            wx, wz = wx + cx * dw, wz + cz * dw
            px, pz = px + cx * dp, pz + cz * dp
            least = min(least, primitive[j, 4])
            if planar is None:
                cy, dv = coefficients[i, k, 1], primitive[j, 2] - v
                ry, uy, wy, py = ry + cy * dr, uy + cy * du, wy + cy * dw, py + cy * dp
                vx, vy, vz = vx + cx * dv, vy + cy * dv, vz + cz * dv
        gradients[i, 0, 0], gradients[i, 0, 2] = rx, rz
        gradients[i, 1, 0], gradients[i, 1, 2] = ux, uz
        gradients[i, 3, 0], gradients[i, 3, 2] = wx, wz
        gradients[i, 4, 0], gradients[i, 4, 2] = px, pz
        if planar is None:
            gradients[i, 0, 1], gradients[i, 1, 1] = ry, uy
            gradients[i, 3, 1], gradients[i, 4, 1] = wy, py
            gradients[i, 2, 0], gradients[i, 2, 1], gradients[i, 2, 2] = vx, vy, vz
        lowest[i] = least
