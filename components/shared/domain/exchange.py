"""Rows sent to the ranks that need them, and lists that every rank learns from all others."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from quintet.components.shared.domain.waiting import wait
from quintet.interfaces.component import Array


def send_rows(communicator: Any, rows: Sequence[Array]) -> list[Array]:
    """Send each rank its rows; return what each rank has sent here.

    Parameters
    ----------
    communicator : mpi4py communicator
    rows : sequence of (k, *shape) array
        One for each rank, in their order; of one dtype, float64, int64 or uint64, and one shape.

    Returns
    -------
    list of (m, *shape) array
        One of each rank, in their order.
    """
    shape, width = rows[0].shape[1:], int(np.prod(rows[0].shape[1:]))
    counts = np.array([len(part) for part in rows], np.int64)
    coming = np.empty_like(counts)
    wait(communicator.Ialltoall(counts, coming))
    sent = np.ascontiguousarray(np.concatenate(rows))
    received = np.empty((int(coming.sum()), *shape), sent.dtype)
    wait(
        communicator.Ialltoallv(
            [sent.reshape(-1), (counts * width).tolist()],
            [received.reshape(-1), (coming * width).tolist()],
        )
    )
    return np.split(received, np.cumsum(coming)[:-1])


def share(communicator: Any, values: Array) -> list[Array]:
    """Let every rank have the values (k,) of each; k may differ, the dtype not."""
    counts = np.empty(communicator.size, np.int64)
    wait(communicator.Iallgather(np.array([len(values)], np.int64), counts))
    received = np.empty(int(counts.sum()), values.dtype)
    wait(communicator.Iallgatherv(np.ascontiguousarray(values), [received, counts.tolist()]))
    return np.split(received, np.cumsum(counts)[:-1])
