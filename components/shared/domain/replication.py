"""Rows of all ranks on every rank, for what cannot be shared out."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from quintet.components.shared.domain.exchange import share
from quintet.components.shared.domain.waiting import wait_for_all
from quintet.interfaces.component import Array

Whole = NDArray[np.int64]


class Replication:
    """Gathers rows on every rank as long as each rank owns the same ones.

    Parameters
    ----------
    communicator : mpi4py communicator
    ids : (k,) int array
        Of the rows of this rank; the ids of all ranks are 0 to n - 1, each once.
    width : int
        Numbers in a row.
    """

    def __init__(self, communicator: Any, ids: Whole, width: int) -> None:
        self._communicator = communicator
        ids_of_all = share(communicator, np.ascontiguousarray(ids, np.int64))
        self._counts = [width * len(part) for part in ids_of_all]
        self._ids = np.concatenate(ids_of_all)
        self._received = np.empty((len(self._ids), width))

    def gather(self, rows: Array) -> Array:
        """All rows (n, width) of float64, by their ids."""
        sent = np.ascontiguousarray(rows).reshape(-1)
        target = [self._received.reshape(-1), self._counts]
        others = self._received.nbytes - sent.nbytes
        wait_for_all(self._communicator.Iallgatherv(sent, target), others)
        gathered = np.empty_like(self._received)
        gathered[self._ids] = self._received
        return gathered
