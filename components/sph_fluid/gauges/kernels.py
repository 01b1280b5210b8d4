"""Loops of the gauges over fluid particles."""

import math

from numba import njit

from quintet.components.shared.numba_options import EXACT
from quintet.components.shared.search.neighbours import Lists
from quintet.components.shared.smoothing.cubic_spline import SUPPORT
from quintet.components.shared.smoothing.smoothing import kernel
from quintet.components.sph_fluid.laws import Constants
from quintet.components.sph_fluid.state import Array


@njit(**EXACT)
def add_around(
    points: Array, split: int, position: Array, velocity: Array, constants: Constants,
    weight: Array, sums: Array,
) -> None:  # fmt: skip
    """Write Σ V W of fluid, of walls, and Σ V W (p + weight·(point - r)) of fluid; (m, 3).

    `points` (m, 3) m; `weight` (m, 3) N/m3, of fluid at rest there.
    """
    reach2 = (SUPPORT * constants.smoothing.length) ** 2
    sums[:] = 0.0
    for g in range(points.shape[0]):
        for j in range(position.shape[0]):
            x, y = points[g, 0] - position[j, 0], points[g, 1] - position[j, 1]
            z = points[g, 2] - position[j, 2]
            r2 = x * x + y * y + z * z
            if r2 >= reach2:
                continue
            density = position[j, 3]
            share = kernel(r2, constants.smoothing) * constants.mass / density
            if j < split:
                pressure = velocity[j, 3] * density * density
                sums[g, 0] += share
                carried = weight[g, 0] * x + weight[g, 1] * y + weight[g, 2] * z
                sums[g, 2] += share * (pressure + carried)
            else:
                sums[g, 1] += share


@njit(**EXACT)
def fill_columns(
    spots: Array,
    bottom: float,
    rise: float,
    split: int,
    position: Array,
    constants: Constants,
    share: Array,
) -> None:
    """Write the share of volume Σ_j V_j W_j above spots (m, 2) m, at heights bottom + k rise."""
    reach2 = (SUPPORT * constants.smoothing.length) ** 2
    share[:] = 0.0
    for g in range(spots.shape[0]):
        for j in range(split):
            x, y = position[j, 0] - spots[g, 0], position[j, 1] - spots[g, 1]
            aside2 = x * x + y * y
            if aside2 < reach2:
                height, volume = position[j, 2] - bottom, constants.mass / position[j, 3]
                half = math.sqrt(reach2 - aside2)
                first = max(0, math.ceil((height - half) / rise))
                last = min(share.shape[1] - 1, int((height + half) / rise))
                for k in range(first, last + 1):
                    z = height - k * rise
                    share[g, k] += volume * kernel(aside2 + z * z, constants.smoothing)


@njit(**EXACT)
def furthest(
    along: Array, fewest: float, position: Array, lists: Lists, constants: Constants
) -> float:
    """Greatest position along an axis of fluid that has so many fluid neighbours or more.

    `along` (fluid,) m is that position, -inf of particles that are no front.
    """
    begin, middle, _, neighbour = lists
    reach2 = (SUPPORT * constants.smoothing.length) ** 2
    front = -math.inf
    for i in range(along.shape[0]):
        if along[i] > front:
            count = -1  # each is its own neighbour
            for k in range(begin[i], middle[i]):
                j = neighbour[k]
                x, y = position[i, 0] - position[j, 0], position[i, 1] - position[j, 1]
                z = position[i, 2] - position[j, 2]
                count += int(x * x + y * y + z * z < reach2)
            if count >= fewest:
                front = along[i]
    return front
