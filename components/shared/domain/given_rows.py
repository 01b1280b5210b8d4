"""Rows of all ranks in the arrays that rank 0 gives to the component's partners.

Ranks of the host of rank 0 write their rows where they belong, into memory that they share with it:
no row is sent, and rank 0 does not sort them. Ranks of other hosts send theirs.
"""

import sys
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from quintet.components.shared.domain.shared_memory import SharedMemory, share_memory
from quintet.components.shared.domain.waiting import wait, wait_for_all
from quintet.interfaces.component import Array

Whole = NDArray[np.int64]
Kinds = tuple[tuple[tuple[int, ...], np.dtype[Any]], ...]  # shapes and types of rows
TAG = 31
FIRST, SPARE = 0, 1  # memories


class GivenRows:
    """Arrays of which every rank writes its own rows; all methods are called on all ranks.

    Parameters
    ----------
    communicator : mpi4py communicator
    count : int
        Rows of all ranks.
    like : sequence of (any, *shape) arrays
        One for each array that is given, with the shape of its rows, and its dtype: float64, int64
        or uint64.
    """

    def __init__(self, communicator: Any, count: int, like: Sequence[Array]) -> None:
        self._communicator, self._count = communicator, count
        self._rows = [(array.shape[1:], array.dtype) for array in like]
        self._widths = [int(np.prod(shape)) for shape, _ in self._rows]
        self._memories: list[SharedMemory] = []  # the first, and a spare one if it was needed
        self._unused = 0  # references to the first memory while no array in it is used
        self._memory = np.zeros(1, np.int64)  # number of the one that is written
        self._broadcast: Any = None  # request: that number, from rank 0
        self._ids: Whole = np.zeros(0, np.int64)
        self._arrays: Sequence[Array] = ()  # that this rank writes

    def begin(self, ids: Whole) -> tuple[Whole, Sequence[Array]]:
        """Return the arrays into which this rank writes its rows, and the place of each.

        Parameters
        ----------
        ids : (k,) int array
            Of the rows of this rank; the ids of all ranks are 0 to count - 1, each once.

        Returns
        -------
        (k,) int array
        sequence of (n, *shape) arrays
        """
        numbers, self._ids = self._chosen_memory(), ids
        is_packed = numbers is None and self._communicator.rank > 0
        count = len(ids) if is_packed else self._count
        if numbers is None:
            numbers = np.empty(count * sum(self._widths))
        self._arrays = self._parts(numbers, count)
        return np.arange(count) if is_packed else ids, self._arrays

    def finish(self) -> Sequence[Array]:
        """All rows (count, *shape) of each array on rank 0, by their ids; on others their own.

        The arrays belong to the caller: their memory is not written again before it drops them.
        """
        rank, number = self._communicator.rank, int(self._memory[0])
        arrays, self._arrays = self._arrays, ()
        has_sent = rank > 0 and self._memories[number].numbers is None
        sent = len(self._ids) if has_sent else 0
        counts = None if rank else np.empty(self._communicator.size, np.int64)
        # From then on rank 0 knows that all others have written their rows.
        request = self._communicator.Igather(np.array([sent], np.int64), counts)
        wait_for_all(request, 0 if rank else self._bytes_of_others())
        if counts is None:
            if sent:
                self._send(arrays)
            return arrays
        self._finish_broadcast()
        for sender in np.flatnonzero(counts).tolist():
            self._receive(sender, int(counts[sender]), arrays)
        return [array.copy() for array in arrays] if number == SPARE else arrays

    def _chosen_memory(self) -> Array | None:
        """Memory that nobody uses, on ranks that share it with rank 0."""
        if not self._memories:
            self._make_memory()
            self._unused = self._references()
        if self._memories[FIRST].is_shared:
            self._memory[0] = SPARE if self._references() > self._unused else FIRST
            self._broadcast = self._communicator.Ibcast(self._memory, 0)
            if self._communicator.rank:
                self._finish_broadcast()
            if self._memory[0] == len(self._memories):
                self._make_memory()
        return self._memories[int(self._memory[0])].numbers

    def _make_memory(self) -> None:
        count = self._count * sum(self._widths)
        self._memories.append(share_memory(self._communicator, count))

    def _references(self) -> int:
        """References to the first memory; each array in it, or part of one, adds to them."""
        return sys.getrefcount(self._memories[FIRST].numbers)

    def _finish_broadcast(self) -> None:
        if self._broadcast is not None:
            wait_for_all(self._broadcast)
            self._broadcast = None

    def _parts(self, numbers: Array, count: int) -> Sequence[Array]:
        """Arrays (count, *shape) in one piece of memory (numbers,)."""
        ends = count * np.cumsum(self._widths)[:-1]
        parts = np.split(numbers, ends)
        return [
            part.view(dtype).reshape(count, *shape)
            for part, (shape, dtype) in zip(parts, self._rows, strict=True)
        ]

    def _bytes_of_others(self) -> int:
        """Bytes of the rows of other ranks, which ranks of other hosts would send."""
        return 8 * sum(self._widths) * (self._count - len(self._ids))

    def _send(self, arrays: Sequence[Array]) -> None:
        """Send own rows and their ids to rank 0, all as bits of floats."""
        flat = [np.asarray(self._ids, np.int64), *(array.reshape(-1) for array in arrays)]
        packed = np.concatenate([np.ascontiguousarray(part).view(np.float64) for part in flat])
        wait(self._communicator.Isend(packed, 0, TAG))

    def _receive(self, rank: int, count: int, arrays: Sequence[Array]) -> None:
        """Write the rows that another rank sends into arrays of all rows."""
        packed = np.empty(count * (1 + sum(self._widths)))
        wait(self._communicator.Irecv(packed, rank, TAG))
        ids = packed[:count].view(np.int64)
        for array, part in zip(arrays, self._parts(packed[count:], count), strict=True):
            array[ids] = part


class Giving:
    """Gives arrays of all rows; keeps memory for each set of arrays that is given again and again.

    Parameters
    ----------
    communicator : mpi4py communicator
    count : int
        Rows of all ranks.
    """

    def __init__(self, communicator: Any, count: int) -> None:
        self._communicator, self._count = communicator, count
        self._given: dict[Kinds, GivenRows] = {}

    def give(self, ids: Whole, rows: Sequence[Array]) -> Sequence[Array]:
        """All rows (count, *shape) of some arrays on rank 0, by their ids; on others their own.

        Parameters
        ----------
        ids : (k,) int array
            Of the rows of this rank; the ids of all ranks are 0 to count - 1, each once.
        rows : sequence of (k, *shape) arrays
            Of float64, int64 or uint64.
        """
        if not rows:
            return ()
        kinds = tuple([(array.shape[1:], array.dtype) for array in rows])
        if kinds not in self._given:
            self._given[kinds] = GivenRows(self._communicator, self._count, rows)
        places, arrays = self._given[kinds].begin(ids)
        for array, part in zip(arrays, rows, strict=True):
            array[places] = part
        return self._given[kinds].finish()
