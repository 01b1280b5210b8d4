"""The rank that owns something, in words."""

import os
from typing import Any

import numpy as np

from quintet.components.shared.domain.extremes import greatest
from quintet.components.shared.domain.waiting import wait

LONGEST = 64  # bytes of the name of a host


def owner_of(communicator: Any, ids: Any, wanted: int) -> str:
    """Name the rank, and its host, that owns an item; on all ranks.

    Parameters
    ----------
    communicator : mpi4py communicator
    ids : (k,) int array
        Of the items of this rank.
    wanted : int
        The id of the item, on rank 0; others may have any number.

    Returns
    -------
    str
        Such as ``" (rank 1 on host)"``, to be put after the item's name.
    """
    item = np.array([wanted], np.int64)
    wait(communicator.Ibcast(item, 0))
    owns = bool((ids == item[0]).any())
    (rank,) = greatest(communicator, np.array([communicator.rank if owns else -1])).tolist()
    if rank < 0:
        return ""
    host = np.zeros(LONGEST, np.uint8)
    if communicator.rank == rank:
        name = os.uname().nodename.encode()[:LONGEST]
        host[: len(name)] = np.frombuffer(name, np.uint8)
    wait(communicator.Ibcast(host, rank))
    return f" (rank {rank} on {host.tobytes().rstrip(bytes(1)).decode(errors='replace')})"
