"""Partners of balls that may touch, of balls sorted in space."""

from typing import NamedTuple

import numpy as np
from numba import njit

from quintet.components.dem_bodies.kernels.geometry import row_vector, sphere_plane
from quintet.components.dem_bodies.state import (
    RADIUS,
    Model,
    Numbers,
    Short,
    Whole,
)
from quintet.components.shared.numba_options import EXACT
from quintet.components.shared.rotations import dot, sub
from quintet.components.shared.search.cells import LAYER, ROW

# First key, and how many follow, of each range of later rows that may be near.
AHEAD = ((0, 1), (ROW - 1, 2), (LAYER - ROW - 1, 2), (LAYER - 1, 2), (LAYER + ROW - 1, 2))


class Sorted(NamedTuple):
    """Balls in the order of the keys of their cells."""

    keys: Whole  # (b,) rising
    width: float  # m, of a cell


@njit(**EXACT)
def list_partners(
    first_row: int, last_row: int, model: Model, motion: Numbers, keys: Whole, skin: float,
    begin: Whole, partner: Short,
) -> int:  # fmt: skip
    """Write partners of the rows [first_row, last_row), while there is room, and where rows begin.

    Return the number of partners. Nothing is written of other rows.
    """
    planes, rows, count, listed = model.plane.shape[0], motion.shape[0], keys.shape[0], 0
    low, high = np.zeros(5, np.int64), np.zeros(5, np.int64)
    for a in range(first_row, last_row):
        begin[a] = listed
        x, radius = row_vector(motion, a), motion[a, RADIUS]
        for p in range(planes):
            if sphere_plane(x, radius, row_vector(model.plane, p), model.plane[p, 3])[0] < skin:
                if listed < partner.shape[0]:
                    partner[listed] = rows + p
                listed += 1
        for k in range(5):
            first = keys[a] + AHEAD[k][0]
            last = first + AHEAD[k][1]
            while low[k] < count and keys[low[k]] < first:
                low[k] += 1
            while high[k] < count and keys[high[k]] <= last:
                high[k] += 1
            for b in range(max(low[k], a + 1), high[k]):
                d, near = sub(x, row_vector(motion, b)), radius + motion[b, RADIUS] + skin
                if dot(d, d) < near * near:
                    if listed < partner.shape[0]:
                        partner[listed] = b
                    listed += 1
    begin[last_row] = listed
    return listed
