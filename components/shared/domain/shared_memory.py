"""Memory that ranks of one host share.

It is a file without a name rather than an MPI window: a window waits for all ranks, without a
deadline, when it is made and when it is freed. The system frees this memory when the last rank has
dropped it, or has died.
"""

import contextlib
import mmap
import os
import secrets
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from quintet.components.shared.domain.extremes import counted
from quintet.components.shared.domain.waiting import wait_for_all
from quintet.interfaces.component import Array

NO_FILE = -1
TOKENS = 1 << 62  # the file of another host may have the same process and number: its token differs


class SharedMemory(NamedTuple):
    """Numbers that rank 0 and some other ranks read and write."""

    numbers: Array | None  # (n,) float64, zeros at first; None where this rank does not share them
    is_shared: bool  # whether any rank but rank 0 has them; the same on all ranks


def share_memory(communicator: Any, count: int) -> SharedMemory:
    """Make memory for as many numbers that rank 0 shares with ranks of its host; collective.

    Parameters
    ----------
    communicator : mpi4py communicator
    count : int
        Float64 numbers.
    """
    address = np.array([0, NO_FILE, 0], np.int64)  # process, file and token of rank 0
    if communicator.rank == 0:
        address[:] = os.getpid(), *_created(count)
    wait_for_all(communicator.Ibcast(address, 0))
    process, file, token = address.tolist()
    numbers = None if file == NO_FILE else _mapped(process, file, token, count)
    (ranks,) = counted(communicator, np.array([numbers is not None])).tolist()
    if communicator.rank == 0 and file != NO_FILE:
        os.close(file)  # all that can have mapped it
    return SharedMemory(numbers if ranks > 1 else None, ranks > 1)


def _created(count: int) -> tuple[int, int]:
    """File with so many numbers, and its token; `NO_FILE` on a system without such files."""
    token, file = secrets.randbelow(TOKENS), NO_FILE
    with contextlib.suppress(AttributeError, OSError):
        file = os.memfd_create(_name(token))
        os.ftruncate(file, _size(count))
    return file, token


def _mapped(process: int, file: int, token: int, count: int) -> NDArray[np.float64] | None:
    """Numbers in a file of a process; None if there is no such file on this host."""
    path = f"/proc/{process}/fd/{file}"
    try:
        if _name(token) not in os.readlink(path):
            return None
        opened = os.open(path, os.O_RDWR)
    except OSError:
        return None
    try:
        return np.frombuffer(mmap.mmap(opened, _size(count)), np.float64, count)
    except OSError:
        return None
    finally:
        os.close(opened)


def _size(count: int) -> int:
    """Bytes of a file; an empty one cannot be mapped."""
    return max(8 * count, 1)


def _name(token: int) -> str:
    return f"quintet-{token:016x}"
