"""Copies of the rows of other ranks, brought up to date in buffers that are made once."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from quintet.components.shared.domain.waiting import wait
from quintet.interfaces.component import Array
from quintet.interfaces.waited import TRAFFIC

Whole = NDArray[np.int64]
TAG = 23


class Halo:
    """Exchange of rows with the ranks whose rows are near.

    Parameters
    ----------
    communicator : mpi4py communicator
    sent : sequence of (k,) int array
        For each rank, the rows that it gets from this one.
    received : sequence of (m,) int array
        For each rank, the rows of this one into which its rows go, in the order in which it
        sends them.
    widths : sequence of int
        Numbers in a row of each array that is exchanged, in order: 3 of positions.
    """

    def __init__(
        self,
        communicator: Any,
        sent: Sequence[Whole],
        received: Sequence[Whole],
        widths: Sequence[int],
    ) -> None:
        self._sent = _Buffers(sent, widths)
        self._received = _Buffers(received, widths)
        self._into = [(_as_slice(rows), views) for rows, *views in self._received.blocks]
        self._communicator = communicator
        self._requests: list[Any] = []
        self._bytes = sum(buffer.nbytes for buffer in self._sent.buffers.values())

    def begin(self, *arrays: Array) -> None:
        """Send rows of C-contiguous float64 arrays (n, width); they may change afterwards."""
        for rows, *views in self._sent.blocks:
            for array, view in zip(arrays, views, strict=True):
                np.take(array, rows, axis=0, out=view, mode="clip")
        receive, send = self._communicator.Irecv, self._communicator.Isend
        self._requests = [receive(b, rank, TAG) for rank, b in self._received.buffers.items()]
        self._requests += [send(b, rank, TAG) for rank, b in self._sent.buffers.items()]
        TRAFFIC.messages += len(self._sent.buffers)
        TRAFFIC.message_bytes += self._bytes

    def finish(self, *arrays: Array) -> None:
        """Wait for the rows of the others and write them into the same arrays."""
        wait(*self._requests)
        for rows, views in self._into:
            for array, view in zip(arrays, views, strict=True):
                array[rows] = view

    def exchange(self, *arrays: Array) -> None:
        """Begin and finish at once."""
        self.begin(*arrays)
        self.finish(*arrays)


class _Buffers:
    """A buffer for each partner, and views of it for each array."""

    def __init__(self, rows_of: Sequence[Whole], widths: Sequence[int]) -> None:
        self.buffers: dict[int, Array] = {}  # by rank
        self.blocks: list[tuple[Array, ...]] = []  # rows, and a view (k, width) for each array
        for rank, rows in enumerate(rows_of):
            if len(rows):
                buffer = np.empty(len(rows) * sum(widths))
                cuts = np.cumsum([len(rows) * width for width in widths])[:-1]
                parts = zip(np.split(buffer, cuts), widths, strict=True)
                views = (part.reshape(len(rows), width) for part, width in parts)
                self.buffers[rank] = buffer
                self.blocks.append((rows, *views))


def _as_slice(rows: Whole) -> Whole | slice:
    """Rows (k,), as a slice where they stand one after another: they are written faster."""
    first = int(rows[0])
    is_block = np.array_equal(rows, np.arange(first, first + len(rows)))
    return slice(first, first + len(rows)) if is_block else rows
