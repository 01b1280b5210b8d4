"""Verlet lists: for each point, those nearer than a reach, kept until points have moved.

Points come in two groups, each sorted by cell, so that the cells of a row along the grid's x are
one contiguous range. The first group (what moves by itself) looks for both, the second (walls) for
the first only: each from where it is, or from query points that stand for it. A solver without
walls has one group. Each share of the rows has its part of the memory, where its lists are written
one after another. Where they do not fit, all is searched again with twice as much.
"""

from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from quintet.components.shared.numba_options import FAST
from quintet.components.shared.search.cells import (
    REACH,
    Grid,
    Points,
    Whole,
    grid_around,
    number_cells,
    sorted_into,
)
from quintet.components.shared.threads import Team

FEWEST = 100  # neighbours that a row has space for; memory that none is written to costs nothing
MOST = 4000  # neighbours, beyond which memory is given back


class Lists(NamedTuple):
    """Neighbour lists as kernels take them."""

    begin: Whole  # (n,)
    middle: Whole  # (n,)
    end: Whole  # (n,)
    neighbour: NDArray[np.int32]


@dataclass(slots=True)
class NeighbourLists:
    """Lists of indices: begin[i]:middle[i] in the first group, middle[i]:end[i] in the second.

    A point of the first group is its own neighbour: at no distance, it feels no force.
    """

    list: NDArray[np.int32] = field(default_factory=lambda: np.zeros(0, np.int32))
    begin: Whole = field(default_factory=lambda: np.zeros(0, np.int64))  # (n,)
    middle: Whole = field(default_factory=lambda: np.zeros(0, np.int64))  # (n,)
    end: Whole = field(default_factory=lambda: np.zeros(0, np.int64))  # (n,)

    @property
    def arrays(self) -> Lists:
        """What kernels take."""
        return Lists(self.begin, self.middle, self.end, self.list)


class Searched(NamedTuple):
    """The points that are searched, of both groups, sorted by cell."""

    points: Points  # (3, n) m
    split: int  # how many are of the first group
    start_one: Whole  # (cells + 2,) where each cell of the first group starts
    start_two: Whole  # (cells + 2,) and of the second
    grid: Grid


@njit(**FAST)
def search(
    first: int, last: int, query_points: Points, cell: Whole, both: int, searched: Searched,
    name: NDArray[np.int32] | None, reach2: float, per_row: int, lists: Lists,
) -> bool:  # fmt: skip
    """List the neighbours of some points.

    Parameters
    ----------
    first, last : int
        Rows of the points that look.
    query_points, cell : (m, 3) float array, m, and (m,) int array
        All points that look, and their cells.
    both : int
        How many of these, the first, look for both groups; others for the first group alone.
    searched : Searched
    name : (n,) int32 array, or None
        What lists call each searched point; None: its row.
    reach2 : float, m2
    per_row : int
        Neighbours that each row has space for, taken together.
    lists : Lists
        Written.

    Returns
    -------
    bool
        Whether there was space.
    """
    points, split, start_one, start_two, grid = searched
    begin_of, middle_of, end_of, listed = lists
    nx, ny, nz = grid.nx, grid.ny, grid.nz
    k, limit = first * per_row, last * per_row
    for i in range(first, last):
        c = cell[i]
        begin_of[i] = k
        middle_of[i] = k
        if c < nx * ny * nz:
            x, y, z = query_points[i, 0], query_points[i, 1], query_points[i, 2]
            cx, cy, cz = c % nx, (c // nx) % ny, c // (nx * ny)
            low, high = max(cx - REACH, 0), min(cx + REACH, nx - 1)
            for group in range(2 if i < both else 1):
                start = start_one if group == 0 else start_two
                base = group * split
                for kz in range(max(cz - REACH, 0), min(cz + REACH, nz - 1) + 1):
                    for ky in range(max(cy - REACH, 0), min(cy + REACH, ny - 1) + 1):
                        row = nx * (ky + ny * kz)
                        begin, end = base + start[row + low], base + start[row + high + 1]
                        if k + end - begin > limit:
                            return False
                        for j in range(np.uint64(begin), np.uint64(end)):
                            dx, dy, dz = x - points[0, j], y - points[1, j], z - points[2, j]
                            # Always written, kept if near: no branch to mispredict.
                            if name is None:
                                listed[k] = np.int32(j)
                            else:
                                listed[k] = name[j]
                            k += int(dx * dx + dy * dy + dz * dz < reach2)
                if group == 0:
                    middle_of[i] = k
        end_of[i] = k
    return True


class Around(NamedTuple):
    """Rows that others may have as neighbours, as of `neighbours_among`; with copies and images."""

    points: Points  # (n, 3) m
    first: Whole  # (k,) rows of the first group
    second: Whole  # (m,) rows of the second
    looking: Points  # (q, 3) m, points that look: the first group's own, then others
    grid: Grid


def neighbours_within(
    reach: float,
    points: Points,
    split: int,
    team: Team,
    query_points: Points | None = None,
    buffer: NDArray[np.int32] | None = None,
    grid: Grid | None = None,
) -> NeighbourLists:
    """List what is nearer than a reach.

    Parameters
    ----------
    reach : float, m
    points : (n, 3) float array, m
        Both groups, each in the order that `sorted_into` gives for this reach.
    split : int
        How many of them are the first group; n if there is but one.
    team : Team
    query_points : (any, 3) float array, m
        Places that look for the first group in place of the second group's.
    buffer : (any,) int32 array
        Memory of lists no longer wanted: fresh one costs as much as half of the search.
    grid : Grid
        Cells by which the points are sorted; by default those around the first group.

    Returns
    -------
    NeighbourLists
        A list for each point of the first group, then for each of the second or query point.
    """
    grid = grid or grid_around(points[:split], reach)
    _, start_one, _ = sorted_into(points[:split], grid)
    _, start_two, _ = sorted_into(points[split:], grid)
    start = points if query_points is None else np.concatenate([points[:split], query_points])
    columns = np.ascontiguousarray(points.T)
    searched = Searched(columns, split, start_one, start_two, grid)
    return _lists(start, split, searched, None, reach, team, buffer)


def neighbours_among(
    reach: float, points: Points, first: Whole, second: Whole, query_points: Points, both: int,
    team: Team, buffer: NDArray[np.int32] | None = None, grid: Grid | None = None,
) -> NeighbourLists:  # fmt: skip
    """List what is nearer than a reach, of points in any order.

    Parameters
    ----------
    reach : float, m
    points : (n, 3) float array, m
    first, second : (k,) and (m,) int arrays
        Rows of the points of each group, in the order in which lists have those of a cell.
    query_points : (q, 3) float array, m
        Points that look.
    both : int
        How many of these, the first, look for both groups; others for the first group alone.
    team, buffer, grid
        As of `neighbours_within`.

    Returns
    -------
    NeighbourLists
        A list for each point that looks.
    """
    grid = grid or grid_around(points.take(first, 0), reach)
    _, start_one, order_one = sorted_into(points.take(first, 0), grid)
    _, start_two, order_two = sorted_into(points.take(second, 0), grid)
    row = np.concatenate([first[order_one], second[order_two]])
    columns, name = np.ascontiguousarray(points.take(row, 0).T), row.astype(np.int32)
    searched = Searched(columns, len(first), start_one, start_two, grid)
    return _lists(query_points, both, searched, name, reach, team, buffer)


def _lists(
    query_points: Points, both: int, searched: Searched, name: NDArray[np.int32] | None,
    reach: float, team: Team, buffer: NDArray[np.int32] | None,
) -> NeighbourLists:  # fmt: skip
    """Lists of points that look, the first of them for both groups."""
    rows = len(query_points)
    cell = np.empty(rows, np.int64)
    number_cells(query_points, searched.grid, cell)
    begin, middle, end = (np.empty(rows, np.int64) for _ in range(3))
    if buffer is None or len(buffer) > MOST * rows:
        buffer = np.empty(0, np.int32)
    while True:
        per_row = len(buffer) // rows
        lists = Lists(begin, middle, end, buffer)
        numbers = (cell, both, searched, name, reach * reach, per_row, lists)
        if all(team.run(search, rows, query_points, *numbers)):
            return NeighbourLists(buffer, begin, middle, end)
        buffer = np.empty(rows * max(FEWEST, 2 * per_row), np.int32)
