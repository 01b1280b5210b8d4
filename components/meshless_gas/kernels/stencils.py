"""Coefficients of weighted least squares."""

import math
from typing import Any

import numpy as np
from numba import njit

from quintet.components.shared.numba_options import EXACT, INNER

FOURTH = math.exp(-4.0)


@njit(**EXACT)
def write_coefficients(
    first: int,
    last: int,
    rows: Any,
    positions: Any,
    neighbours: Any,
    weight: Any,
    planar: bool,
    coefficients: Any,
    quality: Any,
) -> None:
    """Write c_ij = M⁻¹ ω_ij r_ij, M = Σ ω r rᵀ, and the determinant of M over its diagonal.

    M is made of arms over their greatest reach along each axis: rows of boundary layers are
    flat. ω = (exp(-(d/d_max)²) - e⁻⁴)/((1 - e⁻⁴) d), or 1/dᵖ.

    Parameters
    ----------
    weight : (n,) 1
    planar : bool
        Whether y is left out.
    coefficients : (n, K, 3) 1/m
        Written.
    quality : (n,) 1
        Written: 1 where arms are evenly spread, 0 where they span no space.
    """
    arm, omega, reach = (
        np.zeros((neighbours.shape[1], 3)),
        np.zeros(neighbours.shape[1]),
        np.ones(3),
    )
    for row in range(first, last):
        i = rows[row]
        weigh_arms(i, positions, neighbours[i], weight[i], arm, omega, reach)
        xx, xy, xz, yy, yz, zz = moments(arm, omega)
        if planar:
            yy = 1.0
        a, b, c = yy * zz - yz * yz, xz * yz - xy * zz, xy * yz - xz * yy
        e, f, g = xx * zz - xz * xz, xy * xz - xx * yz, xx * yy - xy * xy
        determinant = xx * a + xy * b + xz * c
        diagonal = xx * yy * zz
        quality[i] = determinant / diagonal if diagonal > 0.0 else 0.0
        per = 1.0 / determinant if determinant > 0.0 else 0.0
        for k in range(neighbours.shape[1]):
            x, y, z = omega[k] * arm[k, 0], omega[k] * arm[k, 1], omega[k] * arm[k, 2]
            coefficients[i, k, 0] = (a * x + b * y + c * z) * per / reach[0]
            coefficients[i, k, 1] = (b * x + e * y + f * z) * per / reach[1]
            coefficients[i, k, 2] = (c * x + f * y + g * z) * per / reach[2]
        if planar:
            coefficients[i, :, 1] = 0.0


@njit(**INNER)
def weigh_arms(
    i: int, positions: Any, near: Any, weight: float, arm: Any, omega: Any, reach: Any
) -> None:
    """Write a node's arms (K, 3) 1, their weights (K,) and their greatest reach (3,) m."""
    farthest = 0.0
    reach[:] = 0.0
    for k in range(near.shape[0]):
        square = 0.0
        for d in range(3):
            arm[k, d] = positions[near[k], d] - positions[i, d]
            square += arm[k, d] * arm[k, d]
            reach[d] = max(reach[d], abs(arm[k, d]))
        omega[k] = math.sqrt(square)
        farthest = max(farthest, omega[k])
    for d in range(3):
        if reach[d] == 0.0:
            reach[d] = 1.0
    for k in range(near.shape[0]):
        distance = omega[k]
        if distance == 0.0:
            continue
        if weight > 0.0:
            omega[k] = (farthest / distance) ** weight
        else:
            part = math.exp(-((distance / farthest) ** 2)) - FOURTH
            omega[k] = part / (1.0 - FOURTH) * farthest / distance
        for d in range(3):
            arm[k, d] /= reach[d]


@njit(**INNER)
def moments(arm: Any, omega: Any) -> tuple[float, float, float, float, float, float]:
    """Σ ω r rᵀ: xx xy xz yy yz zz."""
    xx = xy = xz = yy = yz = zz = 0.0
    for k in range(omega.shape[0]):
        x, y, z = arm[k, 0], arm[k, 1], arm[k, 2]
        xx, xy, xz = xx + omega[k] * x * x, xy + omega[k] * x * y, xz + omega[k] * x * z
        yy, yz, zz = yy + omega[k] * y * y, yz + omega[k] * y * z, zz + omega[k] * z * z
    return xx, xy, xz, yy, yz, zz
