"""States of nodes that holes fill_fresh_nodes, from the nodes around them."""

import math
from typing import Any

import numpy as np
from numba import njit

from quintet.components.meshless_gas.moving.kernels.fringe import SAG, is_seen
from quintet.components.shared.numba_options import EXACT


@njit(**EXACT)
def write_fresh(
    rows: Any, near: Any, positions: Any, spacing: Any, centres: Any, radii: Any, primitive: Any
) -> None:
    """Write the states of nodes that come back: a plane by least squares, within those around.

    Weights are 1/d². The second order matters: a mean over the nearest is of first.

    Parameters
    ----------
    near : (m, c)
        Nodes near each whose states are known.
    """
    low, high, sums = np.empty(5), np.empty(5), np.empty((3, 5))
    for row in range(rows.shape[0]):
        i = rows[row]
        low[:], high[:], sums[:] = math.inf, -math.inf, 0.0
        s = sx = sz = xx = xz = zz = 0.0
        for k in range(near.shape[1]):
            j = near[row, k]
            sag = SAG * min(spacing[i], spacing[j])
            if not is_seen(positions, i, j, centres, radii, sag):
                continue
            x = (positions[j, 0] - positions[i, 0]) / spacing[i]
            z = (positions[j, 2] - positions[i, 2]) / spacing[i]
            w = 1.0 / (x * x + z * z + 1e-9)
            s, sx, sz = s + w, sx + w * x, sz + w * z
            xx, xz, zz = xx + w * x * x, xz + w * x * z, zz + w * z * z
            for q in range(5):
                low[q], high[q] = min(low[q], primitive[j, q]), max(high[q], primitive[j, q])
                sums[0, q] += w * primitive[j, q]
                sums[1, q] += w * x * primitive[j, q]
                sums[2, q] += w * z * primitive[j, q]
        # The plane's value here: first row of the inverse of its normal equations.
        a, b, c = xx * zz - xz * xz, sz * xz - sx * zz, sx * xz - sz * xx
        determinant = s * a + sx * b + sz * c
        for q in range(5):
            value = sums[0, q] / s
            if determinant > 1e-6 * s * xx * zz:
                value = (a * sums[0, q] + b * sums[1, q] + c * sums[2, q]) / determinant
            primitive[i, q] = min(max(value, low[q]), high[q])


@njit(**EXACT)
def write_fresh_in_space(
    rows: Any, near: Any, positions: Any, spacing: Any, centres: Any, radii: Any, primitive: Any
) -> None:
    """Write the states of nodes that come back, as `write_fresh` does, in three dimensions.

    Fitted about the mean place of the nodes around, where the fit is their mean.
    """
    low, high, mean, middle = np.empty(5), np.empty(5), np.empty(5), np.empty(3)
    weight, arm, sums = np.empty(near.shape[1]), np.empty((near.shape[1], 3)), np.empty((3, 5))
    for row in range(rows.shape[0]):
        i = rows[row]
        low[:], high[:], mean[:], middle[:], sums[:] = math.inf, -math.inf, 0.0, 0.0, 0.0
        whole = 0.0
        for k in range(near.shape[1]):
            j = near[row, k]
            weight[k], square = 0.0, 1e-9
            for d in range(3):
                arm[k, d] = (positions[j, d] - positions[i, d]) / spacing[i]
                square += arm[k, d] ** 2
            sag = SAG * min(spacing[i], spacing[j])
            if is_seen(positions, i, j, centres, radii, sag):
                weight[k] = 1.0 / square
            whole += weight[k]
        xx = xy = xz = yy = yz = zz = 0.0
        for k in range(near.shape[1]):
            for d in range(3):
                middle[d] += weight[k] / whole * arm[k, d]
            for q in range(5):
                mean[q] += weight[k] / whole * primitive[near[row, k], q]
        for k in range(near.shape[1]):
            if weight[k] == 0.0:
                continue
            x, y, z = arm[k, 0] - middle[0], arm[k, 1] - middle[1], arm[k, 2] - middle[2]
            w = weight[k]
            xx, xy, xz = xx + w * x * x, xy + w * x * y, xz + w * x * z
            yy, yz, zz = yy + w * y * y, yz + w * y * z, zz + w * z * z
            for q in range(5):
                value = primitive[near[row, k], q]
                low[q], high[q] = min(low[q], value), max(high[q], value)
                sums[0, q] += w * x * (value - mean[q])
                sums[1, q] += w * y * (value - mean[q])
                sums[2, q] += w * z * (value - mean[q])
        a, b, c = yy * zz - yz * yz, xz * yz - xy * zz, xy * yz - xz * yy
        e, f, g = xx * zz - xz * xz, xy * xz - xx * yz, xx * yy - xy * xy
        determinant = xx * a + xy * b + xz * c
        u, v, w = middle[0], middle[1], middle[2]
        for q in range(5):
            value = mean[q]
            if determinant > 1e-6 * xx * yy * zz:
                along = (a * u + b * v + c * w) * sums[0, q] + (b * u + e * v + f * w) * sums[1, q]
                value -= (along + (c * u + f * v + g * w) * sums[2, q]) / determinant
            primitive[i, q] = min(max(value, low[q]), high[q])
