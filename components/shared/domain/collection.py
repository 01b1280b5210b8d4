"""Rows of all ranks on rank 0."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from quintet.components.shared.domain.given_rows import Giving
from quintet.components.shared.domain.waiting import wait_for_all
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
        self._communicator, self._ids = communicator, ids
        self._counts = _counts(communicator, ids)
        self._giving = Giving(communicator, int(self._counts.sum()))
        of_all = _received(communicator, np.ascontiguousarray(ids, np.int64), self._counts)
        # Blocks of ids, one after another, arrive in order.
        rises = bool(np.all(of_all[1:] > of_all[:-1]))
        self._order = None if rises else np.argsort(of_all)

    def gather(self, rows: Array) -> Array:
        """All rows (n, *shape) on rank 0, by their ids; on others their own (k, *shape).

        The dtype is float64, int64 or uint64.
        """
        received = _received(self._communicator, np.ascontiguousarray(rows), self._counts)
        if self._communicator.rank:
            return rows
        return received if self._order is None else received.take(self._order, axis=0)

    def give(self, rows: Sequence[Array]) -> Sequence[Array]:
        """The same of several arrays, through memory that is kept for the next time."""
        return self._giving.give(self._ids, rows)


def collect(communicator: Any, rows: Array) -> Array:
    """Rows (n, *shape) of all ranks on rank 0, one rank after another; on others none.

    Each rank gives its own (k, *shape), of one dtype: float64, int64 or uint64.
    """
    rows = np.ascontiguousarray(rows)
    return _received(communicator, rows, _counts(communicator, rows))


def _counts(communicator: Any, rows: Array) -> Whole:
    """How many rows each rank has."""
    counts = np.empty(communicator.size, np.int64)
    wait_for_all(communicator.Iallgather(np.array([len(rows)], np.int64), counts))
    return counts


def _received(communicator: Any, rows: Array, counts: Whole) -> Array:
    """Rows of all ranks, one rank after another; on others than rank 0 nothing."""
    shape, width = rows.shape[1:], int(np.prod(rows.shape[1:]))
    count = int(counts.sum()) if communicator.rank == 0 else 0
    received = np.empty((count, *shape), rows.dtype)
    target = [received.reshape(-1), (counts * width).tolist()] if communicator.rank == 0 else None
    others = max(received.nbytes - rows.nbytes, 0)  # on rank 0 alone
    wait_for_all(communicator.Igatherv(rows.reshape(-1), target), others)
    return received
