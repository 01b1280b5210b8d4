"""Loops of the gauges over fluid particles; imported only by a scene that has gauges."""

import math

from numba import njit

from quintet.components.shared.numba_options import EXACT
from quintet.components.shared.search.neighbours import Lists
from quintet.components.shared.smoothing.cubic_spline import SUPPORT
from quintet.components.shared.smoothing.smoothing import kernel
from quintet.components.sph_fluid.laws import Fluid
from quintet.components.sph_fluid.state import Array


@njit(**EXACT)
def add_around(
    points: Array, split: int, place: Array, motion: Array, fluid: Fluid, weight: Array,
    sums: Array,
) -> None:  # fmt: skip
    """Write Σ V W of fluid, of walls, and Σ V W (p + weight·(point - r)) of fluid; (m, 3).

    `points` (m, 3) m; `weight` (3,) N/m3, of the fluid.
    """
    reach2 = (SUPPORT * fluid.smoothing.length) ** 2
    sums[:] = 0.0
    for g in range(points.shape[0]):
        for j in range(place.shape[0]):
            x, y = points[g, 0] - place[j, 0], points[g, 1] - place[j, 1]
            z = points[g, 2] - place[j, 2]
            r2 = x * x + y * y + z * z
            if r2 >= reach2:
                continue
            density = place[j, 3]
            share = kernel(r2, fluid.smoothing) * fluid.mass / density
            if j < split:
                pressure = motion[j, 3] * density * density
                sums[g, 0] += share
                sums[g, 2] += share * (pressure + weight[0] * x + weight[1] * y + weight[2] * z)
            else:
                sums[g, 1] += share


@njit(**EXACT)
def fill_columns(
    spots: Array, bottom: float, rise: float, split: int, place: Array, fluid: Fluid, share: Array
) -> None:
    """Write the share of volume Σ_j V_j W_j above spots (m, 2) m, at heights bottom + k rise."""
    reach2 = (SUPPORT * fluid.smoothing.length) ** 2
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
                    share[g, k] += volume * kernel(aside2 + z * z, fluid.smoothing)


@njit(**EXACT)
def furthest(
    axis: int, fewest: float, split: int, place: Array, near: Lists, fluid: Fluid
) -> float:
    """Greatest position along an axis of fluid that has so many fluid neighbours or more."""
    begin, middle, _, neighbour = near
    reach2 = (SUPPORT * fluid.smoothing.length) ** 2
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
