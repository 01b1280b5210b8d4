"""Points of a device sorted by cell, and their neighbour lists, as `shared/search` makes them.

The order is that of `search.cells.sort_cells`, a stable one, whatever the device: keys of cell and
row are all different. A bitonic sort has no atomic operations and needs no memory beside the keys.
"""

from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from quintet.components.shared.opencl.arrays import GROUP, DeviceArray, run
from quintet.components.shared.opencl.program import Program
from quintet.components.shared.opencl.types import bytes_of
from quintet.components.shared.search.cells import REACH, Grid, cell_of

SOURCE = Path(__file__).with_name("cells.cl")
# Work items that find the greatest of their rows: those of a processor, and before them those of
# other devices, which hide the latency of their memory by many.
PARTS, MANY_PARTS = 256, 1 << 16
GRID = Grid(0.0, 0.0, 0.0, 1.0, 1, 1, 1, 0, 1, 2)  # of the types that every one has
BLOCK = 1024  # keys that a group of work items sorts in its local memory, a power of two
FEWEST = 32  # neighbours that lists have room for at first


def source(program: Program) -> str:
    """Print the laws of cells; return the kernels."""
    name, _ = program.add(cell_of, 0.0, 0.0, 0.0, GRID)
    names = {"REACH": REACH, "BLOCK": BLOCK, "cell_of": name, "Grid": program.struct(GRID)}
    defined = "\n".join(f"#define {macro} {meaning}" for macro, meaning in names.items())
    return f"{defined}\n{SOURCE.read_text()}"


class NearLists(NamedTuple):
    """Neighbour lists on a device: row i has its k-th at i row_stride + k item_stride."""

    near: DeviceArray
    middle: DeviceArray  # (n,) how many are of the first group
    end: DeviceArray  # (n,) how many there are
    row_stride: np.int64
    item_stride: np.int64


class Cells:
    """Sorting and searching on one device.

    Parameters
    ----------
    queue : pyopencl.CommandQueue
    kernels : pyopencl.Program
        Built from a program that has `source`.
    by_rows : bool
        Whether the lists of a row stand together, as processors read them.
    """

    def __init__(self, queue: Any, kernels: Any, by_rows: bool) -> None:
        self.queue, self.by_rows, self.width = queue, by_rows, FEWEST
        self._number_rows = kernels.number_rows
        self._sort_pass, self._sort_blocks = kernels.sort_pass, kernels.sort_blocks
        self._start_cells, self._greatest = kernels.start_cells, kernels.greatest
        self._search = kernels.search
        self._room: DeviceArray | None = None  # of all lists: they are the largest array by far
        sizes = (PARTS,) if by_rows else (MANY_PARTS, PARTS)
        self._parts = [DeviceArray(queue, (size, 4)) for size in sizes]

    def greatest(self, rows: DeviceArray, count: int) -> NDArray[np.float64]:
        """Greatest (4,) of each column of `count` rows (n, 4)."""
        for parts in self._parts:
            run(self.queue, self._greatest, parts.shape[0], rows, np.int32(count), parts)
            rows, count = parts, parts.shape[0]
        greatest: NDArray[np.float64] = rows.get().max(axis=0)
        return greatest

    def sorted_keys(self, position: DeviceArray, first: int, count: int, grid: Grid) -> DeviceArray:
        """Keys (any,) of `count` rows from `first` on, by cell and then by row."""
        size = max(1 << (count - 1).bit_length(), BLOCK)
        key = DeviceArray(self.queue, (size,), np.int64)
        numbers = (np.int32(first), np.int32(count), bytes_of(grid, np.float64), key)
        run(self.queue, self._number_rows, size, position, *numbers)
        items = size // BLOCK * GROUP
        run(self.queue, self._sort_blocks, items, key, np.int32(2), np.int32(BLOCK))
        part = 2 * BLOCK
        while part <= size:
            distance = part >> 1
            while distance >= BLOCK:
                run(self.queue, self._sort_pass, size, key, np.int32(part), np.int32(distance))
                distance >>= 1
            run(self.queue, self._sort_blocks, items, key, np.int32(part), np.int32(part))
            part <<= 1
        return key

    def starts(self, key: DeviceArray, first: int, count: int, grid: Grid) -> DeviceArray:
        """Rows (cells + 2,) where each cell starts, of sorted rows from `first` on."""
        start = DeviceArray(self.queue, (grid.cells + 2,), np.int32)
        numbers = (np.int32(count), np.int64(grid.cells), np.int32(first), start)
        run(self.queue, self._start_cells, count + 1, key, *numbers)
        return start

    def lists(
        self, position: DeviceArray, places: DeviceArray | None, split: int, count: int, grid: Grid,
        starts: tuple[DeviceArray, DeviceArray], reach: float, extremes: DeviceArray,
        names: DeviceArray | None = None,
    ) -> NearLists:  # fmt: skip
        """List the neighbours within a reach [m] of each row; rows are sorted by cell.

        Parameters
        ----------
        position : (n, 4) array, m
        places : (n - split or more, 3) array, m, or None
            Places that look in place of rows from `split` on, and lists for more places than there
            are rows; these look for the first alone.
        extremes : (n or more, 4) array
            Written; it has a row for each list.
        names : (any,) int32 array, or None
            What lists call each row; then all lists are of places, the first `split` of both
            groups, and the rows of both groups may be others.
        """
        looking = 0 if names else split
        count = max(count, looking + places.shape[0]) if places else count
        middle, end = (DeviceArray(self.queue, (count,), np.int32) for _ in range(2))
        while True:
            by_rows = (self.width, 1) if self.by_rows else (1, count)
            row_stride, item_stride = map(np.int64, by_rows)
            near = self._room_for(count * self.width)
            run(
                self.queue, self._search, count, position, names, places, np.int32(looking),
                np.int32(split), np.int32(count), bytes_of(grid, np.float64), *starts,
                np.float64(reach * reach), np.int32(self.width), row_stride, item_stride, near,
                middle, end, extremes,
            )  # fmt: skip
            longest = int(self.greatest(extremes, count)[0])
            if longest <= self.width:
                return NearLists(near, middle, end, row_stride, item_stride)
            self.width = longest + longest // 8

    def _room_for(self, neighbours: int) -> DeviceArray:
        """Room for lists of so many neighbours, the former lists' own where it is large enough."""
        if self._room is None or self._room.shape[0] < neighbours:
            self._room = DeviceArray(self.queue, (neighbours,), np.int32)
        return self._room
