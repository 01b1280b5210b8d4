"""Worker process of a benchmark: measures one case.

``python -m quintet.coupler.bench.worker KIND NUMBER THREADS FILE`` writes its result into FILE. As
ranks of an MPI job, started with their number as a last argument, its processes measure a component
that they share out; rank 0 writes what holds for all.
The component is made twice. The first compiles all kernels and is dropped; what the process's
resident memory grows by until the second has made its lists and come through its first steps is
the component's own.
"""

import ctypes
import gc
import json
import os
import sys
import time
from pathlib import Path
from typing import Any

from quintet.interfaces.component import Component, fields_of
from quintet.interfaces.manifest import BenchCase, Manifest, find, look_in
from quintet.interfaces.serving.process import build
from quintet.interfaces.waited import TRAFFIC, WAITED


class Job:
    """The processes of a benchmark; this one, if it is no MPI job."""

    rank, size = 0, 1
    communicator: Any = None

    def sums(self, *numbers: float) -> tuple[float, ...]:
        """Sums over all processes."""
        return numbers

    def largest(self, *numbers: float) -> tuple[float, ...]:
        """Largest of each over all processes."""
        return numbers


class MpiJob(Job):
    """The ranks of an MPI job that share a component out."""

    def __init__(self) -> None:
        # Only a component of several ranks needs it.
        from mpi4py import MPI

        self.communicator = MPI.COMM_WORLD
        self.rank, self.size = self.communicator.rank, self.communicator.size

    def sums(self, *numbers: float) -> tuple[float, ...]:
        """Sums over all processes."""
        return tuple(self.communicator.allreduce(number) for number in numbers)

    def largest(self, *numbers: float) -> tuple[float, ...]:
        """Largest of each over all processes."""
        return tuple(max(self.communicator.allgather(number)) for number in numbers)


def measure(manifest: Manifest, case: BenchCase, threads: int, ranks: Job) -> dict[str, Any]:
    """Time one case; return its entry of ``quintet bench --json``."""
    order = {"params": case.params, "threads": threads, "device": case.device}
    component = begin(manifest, order, case, ranks)
    advance(component, case.warm, case)
    del component
    empty = resident()
    component = begin(manifest, order, case, ranks)
    advance(component, case.warm, case)
    (growth,) = ranks.sums(resident() - empty)
    items = component.items()
    before, spent, began = Counts(), time.process_time(), time.perf_counter()
    advance(component, case.steps, case)
    after = Counts()
    # A rank that waits polls, and where ranks share cores it does so in a part of its time.
    computed = time.process_time() - spent - (after.waited - before.waited)
    wall = time.perf_counter() - began
    cpu, idle = ranks.sums(computed, after.idle - before.idle)
    (most,) = ranks.largest(computed)
    per_step = [(b - a) / case.steps for a, b in zip(before.sent, after.sent, strict=True)]
    messages, halo, collectives, gathered = ranks.largest(*per_step)
    return {
        "name": manifest.kind,
        "case": case.name,
        "series": case.series or case.name,
        "items": items,
        "ranks": ranks.size,
        "threads": threads,
        "waits": idle / (wall * ranks.size),  # share of the time of all ranks, for each other
        "rate": items * case.steps / cpu,  # per second of processor time, that of all threads
        "wall_rate": items * case.steps / wall,
        "unit": case.unit,
        "cpu_seconds": cpu,
        "wall_seconds": wall,
        "imbalance": most * ranks.size / cpu,  # largest over mean of the ranks' processor times
        "messages": messages,  # these four a step, of the rank with most
        "halo_bytes": halo,
        "collectives": collectives,
        "gathered_bytes": gathered,
        "bytes_per_item": growth / items,
        "options": {"steps": case.steps, "warm": case.warm, "params": case.params},
    }


class Counts:
    """What this process has waited for others, and sent them, so far."""

    def __init__(self) -> None:
        self.idle, self.waited = WAITED.seconds, WAITED.processor
        self.sent = (
            TRAFFIC.messages,
            TRAFFIC.message_bytes,
            TRAFFIC.collectives,
            TRAFFIC.gathered_bytes,
        )


def begin(manifest: Manifest, order: dict[str, Any], case: BenchCase, ranks: Job) -> Component:
    """Make the component with the ports and fields of the case."""
    component = build(manifest, order, ranks.communicator)
    joined = frozenset(key.partition(".")[0] for key in (*case.static, *case.fields))
    component.bind(case.static, joined)
    component.take(case.fields)
    return component


def advance(component: Component, steps: int, case: BenchCase) -> None:
    """Advance by many stable steps, taking and giving fields at each."""
    wanted = frozenset(fields_of(component.gives))
    for _ in range(steps):
        component.take(case.fields)
        component.step(component.stable_dt())
        component.give(wanted)


def resident() -> int:
    """Resident memory of this process after freed memory was returned [bytes]."""
    gc.collect()
    ctypes.CDLL(None).malloc_trim(0)
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE")


if __name__ == "__main__":
    kind, number, threads, file, *several = sys.argv[1:]
    look_in([str(Path.cwd())] if ":" in kind else [])
    known, job = find(kind), MpiJob() if several else Job()
    result = measure(known, known.cases()[int(number)], int(threads), job)
    if job.rank == 0:
        Path(file).write_text(json.dumps(result))
