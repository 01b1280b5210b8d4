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
        if polls > SOON:
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
