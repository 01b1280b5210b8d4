"""Rows of all ranks on rank 0, in the order of their persistent ids."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from quintet.components.shared.domain.waiting import wait
from quintet.interfaces.component import Array

Whole = NDArray[np.int64]


class Collection:
    """Gathers rows on rank 0 as long as each rank owns the same ones.

    Parameters
    ----------
    communicator : mpi4py communicator
    ids : (k,) int array
        Of the rows of this rank; the ids of all ranks are 0 to n - 1, each once.
    """

    def __init__(self, communicator: Any, ids: Whole) -> None:
        self._communicator = communicator
        counts = np.empty(communicator.size, np.int64)
        wait(communicator.Iallgather(np.array([len(ids)], np.int64), counts))
        self._counts = counts
        self._ids = self._received(np.ascontiguousarray(ids, np.int64))

    def gather(self, rows: Array) -> Array:
        """All rows (n, *shape) on rank 0, by their ids; on others their own (k, *shape).

        The dtype is float64, int64 or uint64.
        """
        received = self._received(np.ascontiguousarray(rows))
        if self._communicator.rank:
            return rows
        gathered = np.empty_like(received)
        gathered[self._ids] = received
        return gathered

    def _received(self, rows: Array) -> Array:
        """Rows of all ranks, one rank after another; on others than rank 0 nothing."""
        shape, width = rows.shape[1:], int(np.prod(rows.shape[1:]))
        count = int(self._counts.sum()) if self._communicator.rank == 0 else 0
        received = np.empty((count, *shape), rows.dtype)
        counts = (self._counts * width).tolist()
        target = [received.reshape(-1), counts] if self._communicator.rank == 0 else None
        wait(self._communicator.Igatherv(rows.reshape(-1), target))
        return received
