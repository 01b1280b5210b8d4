"""Loops of the gauges over fluid particles; imported only by a scene that has gauges."""

import math

from numba import njit

from quintet.components.shared.cubic_spline import SUPPORT
from quintet.components.sph_fluid.kernels import List
from quintet.components.sph_fluid.laws import Fluid, kernel
from quintet.components.sph_fluid.state import Array

MOMENTS = 14  # of 1, x, y, z, xx, xy, xz, yy, yz, zz, p, xp, yp, zp

EXACT = {"error_model": "numpy", "cache": True, "nogil": True}


@njit(**EXACT)
def gather(
    points: Array, split: int, place: Array, motion: Array, fluid: Fluid, sums: Array
) -> None:
    """Write Σ_j V_j (1 - r_j²/4h²)² times each of `MOMENTS` around points (m, 3) m; (m, 14).

    So weighted, a second layer of particles counts even where the first stands off a wall.
    """
    reach2 = (SUPPORT * fluid.smoothing) ** 2
    sums[:] = 0.0
    for g in range(points.shape[0]):
        for j in range(split):
            x, y = place[j, 0] - points[g, 0], place[j, 1] - points[g, 1]
            z = place[j, 2] - points[g, 2]
            r2 = x * x + y * y + z * z
            if r2 < reach2:
                density = place[j, 3]
                weight = fluid.mass / density * (1.0 - r2 / reach2) ** 2
                load = weight * motion[j, 3] * density * density
                sums[g, 0] += weight
                sums[g, 1] += weight * x
                sums[g, 2] += weight * y
                sums[g, 3] += weight * z
                sums[g, 4] += weight * x * x
                sums[g, 5] += weight * x * y
                sums[g, 6] += weight * x * z
                sums[g, 7] += weight * y * y
                sums[g, 8] += weight * y * z
                sums[g, 9] += weight * z * z
                sums[g, 10] += load
                sums[g, 11] += load * x
                sums[g, 12] += load * y
                sums[g, 13] += load * z


@njit(**EXACT)
def fill_columns(
    spots: Array, bottom: float, rise: float, split: int, place: Array, fluid: Fluid, share: Array
) -> None:
    """Write the share of volume Σ_j V_j W_j above spots (m, 2) m, at heights bottom + k rise."""
    reach2 = (SUPPORT * fluid.smoothing) ** 2
    share[:] = 0.0
    for g in range(spots.shape[0]):
        for j in range(split):
            x, y = place[j, 0] - spots[g, 0], place[j, 1] - spots[g, 1]
            aside2 = x * x + y * y
            if aside2 < reach2:
                height, volume = place[j, 2] - bottom, fluid.mass / place[j, 3]
                half = math.sqrt(reach2 - aside2)
                first = max(0, math.ceil((height - half) / rise))
                last = min(share.shape[1] - 1, int((height + half) / rise))
                for k in range(first, last + 1):
                    z = height - k * rise
                    share[g, k] += volume * kernel(aside2 + z * z, fluid)


@njit(**EXACT)
def furthest(axis: int, fewest: float, split: int, place: Array, near: List, fluid: Fluid) -> float:
    """Greatest position along an axis of fluid that has so many fluid neighbours or more."""
    begin, middle, _, neighbour = near
    reach2 = (SUPPORT * fluid.smoothing) ** 2
    found = -math.inf
    for i in range(split):
        if place[i, axis] > found:
            count = -1  # each is its own neighbour
            for k in range(begin[i], middle[i]):
                j = neighbour[k]
                x, y = place[i, 0] - place[j, 0], place[i, 1] - place[j, 1]
                z = place[i, 2] - place[j, 2]
                count += int(x * x + y * y + z * z < reach2)
            if count >= fewest:
                found = place[i, axis]
    return found
