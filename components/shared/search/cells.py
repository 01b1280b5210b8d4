"""Sorting points into cubic cells, so that near points are near in memory.

A `Grid` holds particles that stay together. Its cells are numbered along the shortest extent first
and along the longest last: the layers that a search looks through are then as small as can be, and
stay in the processor's cache.

Cell keys hold bodies that may be anywhere, however far apart: a cell has the same key wherever the
others are, keys of cells next to one another along x are consecutive, and a sorted array of them is
searched by bisection (`row_of_keys`).
"""

import math
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from quintet.components.shared.numba_options import EXACT, INNER
from quintet.interfaces.errors import StepError

REACH = 2  # cells that the search looks in each direction: cells are half as wide as it reaches
MOST = 50_000_000  # cells
BITS = 21  # of a key, for the cell's number along each axis
MIDDLE = 1 << (BITS - 1)
ROW, LAYER = 1 << BITS, 1 << 2 * BITS  # difference of keys from one row, or layer, to the next

Points = NDArray[np.float64]
Whole = NDArray[np.int64]


class Grid(NamedTuple):
    """Cells of one width around the points that are searched for; its x, y, z are any axes."""

    x: float  # m, the lowest corner
    y: float
    z: float
    per_metre: float
    nx: int  # along x, the axis along which cells are numbered first
    ny: int
    nz: int
    first: int  # which of the points' axes is x
    second: int
    third: int

    @property
    def cells(self) -> int:
        """Number of cells."""
        return self.nx * self.ny * self.nz


def corners(points: Points) -> tuple[Points, Points]:
    """Lowest and highest x, y, z (3,) m of points (n, 3 or more) m."""
    # Column by column: numpy takes twenty times as long over all at once.
    axes = points[:, 0], points[:, 1], points[:, 2]
    return np.array([axis.min() for axis in axes]), np.array([axis.max() for axis in axes])


def grid_around(points: Points, reach: float) -> Grid:
    """Cells around points (n, 3 or more) m that hold all that is nearer to one than `reach` [m]."""
    return grid_between(*corners(points), reach)


def grid_between(lowest: Points, highest: Points, reach: float) -> Grid:
    """Cells around all points between two corners (3,) m, as `grid_around`."""
    width = reach / REACH
    low = lowest - 1.001 * reach
    extent = highest + 1.001 * reach - low
    nx, ny, nz = (math.floor(edge / width) + 1 for edge in extent.tolist())
    if nx * ny * nz > MOST:
        raise StepError(
            f"particles must stay together; they spread over {extent.round(3).tolist()} m, "
            f"{nx * ny * nz} cells of {width:.3g} m. Add walls, or end the run earlier."
        )
    axes = np.argsort([nx, ny, nz], kind="stable").tolist()
    x, y, z = (float(low[axis]) for axis in axes)
    nx, ny, nz = ((nx, ny, nz)[axis] for axis in axes)
    return Grid(x, y, z, 1.0 / width, nx, ny, nz, *axes)


@njit(inline="always")
def cell_of(first, second, third, grid):  # type: ignore[no-untyped-def]
    """Cell of a point [m] along the grid's axes; one past the last cell for points outside."""
    x = (first - grid.x) * grid.per_metre
    y = (second - grid.y) * grid.per_metre
    z = (third - grid.z) * grid.per_metre
    # Compared before they are rounded: a far point's cell need not fit an integer.
    inside = 0.0 <= x < grid.nx and 0.0 <= y < grid.ny and 0.0 <= z < grid.nz
    last = grid.nx * grid.ny * grid.nz
    return int(x) + grid.nx * (int(y) + grid.ny * int(z)) if inside else last


@njit(**EXACT)
def number_cells(points: Points, grid: Grid, cell: Whole) -> None:
    """Write the cell of each point (n, 3 or more); one past the last cell for points outside."""
    for i in range(points.shape[0]):
        first, second, third = grid.first, grid.second, grid.third
        cell[i] = cell_of(points[i, first], points[i, second], points[i, third], grid)


@njit(**EXACT)
def sort_cells(cell: Whole, start: Whole, order: Whole) -> None:
    """Write the stable order that sorts points by cell, and where each cell starts in it."""
    start[:] = 0
    for i in range(cell.shape[0]):
        start[cell[i] + 1] += 1
    for c in range(1, start.shape[0]):
        start[c] += start[c - 1]
    for i in range(cell.shape[0]):
        order[start[cell[i]]] = i
        start[cell[i]] += 1
    # Each start has moved on to the next one's place.
    for c in range(start.shape[0] - 1, 0, -1):
        start[c] = start[c - 1]
    start[0] = 0


def sorted_into(points: Points, grid: Grid) -> tuple[Whole, Whole, Whole]:
    """Cell of each point (n,), start of each cell (cells + 2,), and the sorting order (n,)."""
    cell = np.empty(len(points), np.int64)
    order = np.empty(len(points), np.int64)
    start = np.empty(grid.cells + 2, np.int64)
    number_cells(points, grid, cell)
    sort_cells(cell, start, order)
    return cell, start, order


@njit(**INNER)
def number_along(x: float, width: float) -> int:
    """Number of the cell along one axis; what is very far shares the last one."""
    return int(min(max(math.floor(x / width), 2.0 - MIDDLE), MIDDLE - 2.0)) + MIDDLE


@njit(**INNER)
def key_of(x: float, y: float, z: float, width: float) -> int:
    """Key of the cell of a width [m] that a point [m] is in."""
    layer, row = number_along(z, width) << 2 * BITS, number_along(y, width) << BITS
    return int(layer + row + number_along(x, width))


@njit(**EXACT)
def keys_of(points: Points, rows: Whole, width: float) -> Whole:
    """Keys (k,) of the cells of some rows (k,) of points (n, 3 or more) m."""
    keys = np.empty(rows.shape[0], np.int64)
    for k in range(rows.shape[0]):
        i = rows[k]
        keys[k] = key_of(points[i, 0], points[i, 1], points[i, 2], width)
    return keys


@njit(**INNER)
def rows_below(keys: Whole, key: int) -> int:
    """How many of sorted keys (n,) are less than one, by bisection."""
    # numpy's own is for any numbers, and takes a second and a half to compile.
    low, high = 0, keys.shape[0]
    while low < high:
        middle = (low + high) // 2
        if keys[middle] < key:
            low = middle + 1
        else:
            high = middle
    return low


@njit(**INNER)
def row_of_keys(keys: Whole, first: int, last: int) -> tuple[int, int]:
    """Range of what is in cells `first` to `last`, both included, among sorted keys (n,)."""
    return rows_below(keys, first), rows_below(keys, last + 1)
