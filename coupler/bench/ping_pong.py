"""Latency and bandwidth of a message between two ranks, as components of several ranks send them.

Two ranks send an array there and back: neither blocks, both poll, as in a solver's halo. The
latency is half the median round trip of eight bytes, Python's share in it included; the bandwidth
is that of a megabyte, less the latency.
"""

import json
import os
import statistics
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np

from quintet.coupler.bench.cost_model import Network
from quintet.coupler.launch.mpi_job import find_launcher
from quintet.coupler.launch.processes import RUN, end_marked, start, tail
from quintet.interfaces.errors import QuintetError

ROUNDS = {1: 3000, 1 << 17: 300}  # doubles in a message: round trips measured
WARM = 50  # round trips before these
SOON = 200  # polls before the core is given to others


def measure_network() -> Network:
    """Measure between two ranks of this host."""
    with tempfile.TemporaryDirectory() as folder:
        log, file = Path(folder) / "log", Path(folder) / "times.json"
        line = ["-m", "mpi4py", "-m", "quintet.coupler.bench.ping_pong", str(file)]
        process = start(line, log, 1, run=folder, launcher=[*find_launcher(), "-n", "2"])
        try:
            status = process.wait(timeout=120.0)
        finally:
            end_marked(RUN, folder)
        if status:
            lines = "\n".join(f"    {text}" for text in tail(log))
            raise QuintetError(f"bench: the two ranks ended with status {status}:\n{lines}")
        times = {int(size): took for size, took in json.loads(file.read_text()).items()}
    return network_of(times)


def network_of(times: dict[int, float]) -> Network:
    """Latency and bandwidth of the time [s] of a message of few and of many doubles."""
    (_, latency), (many, long) = sorted(times.items())
    return Network(latency, 8 * many / max(long - latency, 1e-9))


def round_trips(communicator: Any, doubles: int, rounds: int) -> list[float]:
    """Time [s] of each round trip of a message."""
    sent, received = np.ones(doubles), np.empty(doubles)
    other = 1 - communicator.rank

    def done(request: Any) -> None:
        polls = 0
        while not request.Test():
            polls += 1
            if polls > SOON:
                os.sched_yield()

    took = []
    for _ in range(WARM + rounds):
        began = time.perf_counter()
        answer = communicator.Irecv(received, other)
        if communicator.rank == 0:
            done(communicator.Isend(sent, other))
            done(answer)
        else:
            done(answer)
            done(communicator.Isend(sent, other))
        took.append(time.perf_counter() - began)
    return took[WARM:]


def main() -> None:
    """Measure as one of two ranks; rank 0 writes the time [s] of a message of each size."""
    # Only these two processes need it.
    from mpi4py import MPI

    times = {
        size: statistics.median(round_trips(MPI.COMM_WORLD, size, rounds)) / 2.0
        for size, rounds in ROUNDS.items()
    }
    if MPI.COMM_WORLD.rank == 0:
        Path(sys.argv[1]).write_text(json.dumps(times))


if __name__ == "__main__":
    main()
