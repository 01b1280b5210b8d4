"""Which points are near to which; imported only by a scene with films.

Each list is in the order of the points, so that sums over it are those of a loop over all of them.
"""

import numpy as np

from quintet.components.shared.search.cells import (
    grid_around,
    number_cells,
    sorted_into,
)
from quintet.components.sph_fluid.boundary.kernels.films import Near, list_near
from quintet.components.sph_fluid.state import Array

LISTED = 32  # per point, for which there is space at first


def near(places: Array, points: Array, reach: float) -> Near:
    """List for each place (m, 3) m the points (n, 3) m that are nearer than a reach [m]."""
    if not len(places) or not len(points):
        return Near(np.zeros(len(places) + 1, np.int64), np.zeros(0, np.int64))
    grid = grid_around(points, reach)
    _, start, order = sorted_into(points, grid)
    cell, begin = np.empty(len(places), np.int64), np.zeros(len(places) + 1, np.int64)
    number_cells(places, grid, cell)
    listed = np.empty(LISTED * len(places), np.int64)
    while list_near(places, cell, points, start, order, grid, reach * reach, begin, listed) < 0:
        listed = np.empty(4 * len(listed), np.int64)
    return Near(begin, listed)
