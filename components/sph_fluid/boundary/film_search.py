"""Which points are near to which; imported only by a scene with films.

Each list is in the order of the points, so that sums over it are those of a loop over all of them.
"""

from typing import NamedTuple

import numpy as np
from numba import njit

from quintet.components.shared.numba_options import EXACT
from quintet.components.shared.search.cells import (
    REACH,
    Grid,
    grid_around,
    number_cells,
    sorted_into,
)
from quintet.components.sph_fluid.state import Array, Whole

LISTED = 32  # per point, for which there is space at first


class Near(NamedTuple):
    """For each of m places, the numbers of the points that are near, in their order."""

    begin: Whole  # (m + 1,)
    point: Whole


def near(places: Array, points: Array, reach: float) -> Near:
    """List for each place (m, 3) m the points (n, 3) m that are nearer than a reach [m]."""
    if not len(places) or not len(points):
        return Near(np.zeros(len(places) + 1, np.int64), np.zeros(0, np.int64))
    grid = grid_around(points, reach)
    _, start, order = sorted_into(points, grid)
    cell, begin = np.empty(len(places), np.int64), np.zeros(len(places) + 1, np.int64)
    number_cells(places, grid, cell)
    found = np.empty(LISTED * len(places), np.int64)
    while list_near(places, cell, points, start, order, grid, reach * reach, begin, found) < 0:
        found = np.empty(4 * len(found), np.int64)
    return Near(begin, found)


@njit(**EXACT)
def list_near(
    places: Array, cell: Whole, points: Array, start: Whole, order: Whole, grid: Grid,
    reach2: float, begin: Whole, found: Whole,
) -> int:  # fmt: skip
    """Write the lists of `near`; how many numbers they have, or -1 where there is no space."""
    nx, ny, nz = grid.nx, grid.ny, grid.nz
    count = 0
    for i in range(places.shape[0]):
        begin[i] = count
        c = cell[i]
        if c == nx * ny * nz:
            continue
        cx, cy, cz = c % nx, (c // nx) % ny, c // (nx * ny)
        low, high = max(cx - REACH, 0), min(cx + REACH, nx - 1)
        for kz in range(max(cz - REACH, 0), min(cz + REACH, nz - 1) + 1):
            for ky in range(max(cy - REACH, 0), min(cy + REACH, ny - 1) + 1):
                row = nx * (ky + ny * kz)
                for k in range(start[row + low], start[row + high + 1]):
                    j, r2 = order[k], 0.0
                    for d in range(3):
                        r2 += (places[i, d] - points[j, d]) ** 2
                    if r2 < reach2:
                        if count == found.shape[0]:
                            return -1
                        found[count] = j
                        count += 1
        found[begin[i] : count].sort()
    begin[places.shape[0]] = count
    return count
