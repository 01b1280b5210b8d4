"""Waiting for other ranks without holding the core, and with an end."""

import os
import time
from typing import Any

from mpi4py import MPI

from quintet.interfaces.errors import LineError
from quintet.interfaces.waited import TRAFFIC, WAITED

# s; ranks that others wait for may compute long. One that is dead or hangs is noticed earlier, by
# the coupler, which then ends all ranks of the component.
LONGEST = 86400.0
SOON = 200  # polls, some 50 µs, in which another rank answers that is as far
OFTEN = 1000  # polls between two looks at the clock
# What launchers call the number of ranks that they started on this host: MPICH, Open MPI.
RANKS_HERE = ("MPI_LOCALNRANKS", "OMPI_COMM_WORLD_LOCAL_SIZE")


def polls_before_yielding() -> int:
    """Polls after which a waiting rank yields its core.

    None where more ranks than cores are on this host: the rank that is awaited may need the core.
    """
    ranks = max(int(os.environ.get(name, "0")) for name in RANKS_HERE)
    return 0 if ranks > len(os.sched_getaffinity(0)) else SOON


POLLS = polls_before_yielding()


def wait(*requests: Any) -> None:
    """Wait until all requests are done; other processes may use the core meanwhile.

    Raises
    ------
    LineError
        If they are not done within a day.
    """
    waiting, polls = list(requests), 0
    began, spent = time.perf_counter(), time.thread_time()
    while not MPI.Request.Testall(waiting):
        polls += 1
        if polls > POLLS:
            os.sched_yield()
        if polls % OFTEN == 0 and time.perf_counter() - began > LONGEST:
            raise LineError(f"another rank must answer within {LONGEST:g} s; it did not.")
    WAITED.seconds += time.perf_counter() - began
    WAITED.processor += time.thread_time() - spent


def wait_for_all(request: Any, gathered: int = 0) -> None:
    """Wait for an operation of all ranks, which brings so many bytes of other ranks here."""
    TRAFFIC.collectives += 1
    TRAFFIC.gathered_bytes += gathered
    wait(request)
