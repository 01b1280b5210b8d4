"""Rows sent to the ranks that need them, and lists that every rank learns from all others."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from quintet.components.shared.domain.waiting import wait_for_all
from quintet.interfaces.component import Array
from quintet.interfaces.waited import TRAFFIC


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
    wait_for_all(communicator.Ialltoall(counts, coming))
    sent = np.ascontiguousarray(np.concatenate(rows))
    received = np.empty((int(coming.sum()), *shape), sent.dtype)
    away = np.delete(counts, communicator.rank)
    TRAFFIC.messages += int(np.count_nonzero(away))
    TRAFFIC.message_bytes += int(away.sum()) * width * sent.itemsize
    wait_for_all(
        communicator.Ialltoallv(
            [sent.reshape(-1), (counts * width).tolist()],
            [received.reshape(-1), (coming * width).tolist()],
        )
    )
    return np.split(received, np.cumsum(coming)[:-1])


def share(communicator: Any, values: Array) -> list[Array]:
    """Let every rank have the values (k,) of each; k may differ, the dtype not."""
    counts = np.empty(communicator.size, np.int64)
    wait_for_all(communicator.Iallgather(np.array([len(values)], np.int64), counts))
    received = np.empty(int(counts.sum()), values.dtype)
    values = np.ascontiguousarray(values)
    request = communicator.Iallgatherv(values, [received, counts.tolist()])
    wait_for_all(request, received.nbytes - values.nbytes)
    return np.split(received, np.cumsum(counts)[:-1])
