"""Verlet lists: for each point, those nearer than a reach, kept until points have moved.

Points come sorted by cell, so the cells of a row along x are one contiguous range. A list
is written row after row (compressed rows): first counted, then filled.
"""

from dataclasses import dataclass, field

import numpy as np
from numba import njit
from numpy.typing import NDArray

from quintet.components.shared.cells import REACH, Grid, Points, Whole, sorted_into
from quintet.components.shared.team import Team

FAST = {"fastmath": True, "error_model": "numpy", "cache": True, "nogil": True}
Rows = NDArray[np.int32]


@dataclass(slots=True)
class Neighbours:
    """Rows `begin[i]:end[i]` of `list` are i's neighbours; from `middle[i]` on, of the second group."""

    list: Rows = field(default_factory=lambda: np.zeros(0, np.int32))
    begin: Whole = field(default_factory=lambda: np.zeros(0, np.int64))  # (n,)
    middle: Whole = field(default_factory=lambda: np.zeros(0, np.int64))  # (n,)
    end: Whole = field(default_factory=lambda: np.zeros(0, np.int64))  # (n,)


@njit(**FAST)
def count(
    first: int, last: int, base: int, points: Points, cell: Whole, start: Whole,
    offset: int, grid: Grid, reach2: float, number: Whole,
) -> None:  # fmt: skip
    """Count the neighbours of points base + [first, last) in a group that begins at `offset`."""
    nx, ny, nz = grid.nx, grid.ny, grid.nz
    for i in range(base + first, base + last):
        c = cell[i]
        found = 0
        if c < nx * ny * nz:
            cx, cy, cz = c % nx, (c // nx) % ny, c // (nx * ny)
            low, high = max(cx - REACH, 0), min(cx + REACH, nx - 1)
            for kz in range(max(cz - REACH, 0), min(cz + REACH, nz - 1) + 1):
                for ky in range(max(cy - REACH, 0), min(cy + REACH, ny - 1) + 1):
                    row = nx * (ky + ny * kz)
                    begin, end = offset + start[row + low], offset + start[row + high + 1]
                    for j in range(np.uint64(begin), np.uint64(end)):
                        dx = points[i, 0] - points[j, 0]
                        dy = points[i, 1] - points[j, 1]
                        dz = points[i, 2] - points[j, 2]
                        found += int(dx * dx + dy * dy + dz * dz < reach2)
        number[i] = found


@njit(**FAST)
def fill(
    first: int, last: int, base: int, points: Points, cell: Whole, start: Whole,
    offset: int, grid: Grid, reach2: float, begin_of: Whole, list_: Rows,
) -> None:  # fmt: skip
    """Write the neighbours that `count` counted, from begin_of[i] on."""
    nx, ny, nz = grid.nx, grid.ny, grid.nz
    for i in range(base + first, base + last):
        c = cell[i]
        k = begin_of[i]
        if c < nx * ny * nz:
            cx, cy, cz = c % nx, (c // nx) % ny, c // (nx * ny)
            low, high = max(cx - REACH, 0), min(cx + REACH, nx - 1)
            for kz in range(max(cz - REACH, 0), min(cz + REACH, nz - 1) + 1):
                for ky in range(max(cy - REACH, 0), min(cy + REACH, ny - 1) + 1):
                    row = nx * (ky + ny * kz)
                    begin, end = offset + start[row + low], offset + start[row + high + 1]
                    for j in range(np.uint64(begin), np.uint64(end)):
                        dx = points[i, 0] - points[j, 0]
                        dy = points[i, 1] - points[j, 1]
                        dz = points[i, 2] - points[j, 2]
                        # Written always and kept if near: no branch to mispredict.
                        list_[k] = np.int32(j)
                        k += int(dx * dx + dy * dy + dz * dz < reach2)


