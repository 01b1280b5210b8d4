"""Round trip of bytes over zenoh or MPI alone, as a reference for the exchange.

Two processes fill an array, send its bytes, read what came, and send it back: no header, no
numbers of messages, no check, no deadline but that of the process that started them.
"""

import statistics
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np

from quintet.coupler.launch.mpi_job import find_launcher
from quintet.coupler.launch.processes import GRACE, PYTHON, environment
from quintet.interfaces.errors import QuintetError
from quintet.interfaces.lines.endpoint import free_port

WARM = 100  # windows before the clock starts
PATIENCE = 120.0  # s for all windows
LINGER = 0.3  # s for the last message to be sent before the session closes
LINES = 8  # of each process's output, in an error message
Send = Callable[[bytearray], None]
Receive = Callable[[], Any]
Channel = tuple[bool, Send, Receive]  # whether it is the leader


def round_trip(transport: str, size: int, windows: int) -> float:
    """Median round-trip time [s] of `size` bytes over the library alone."""
    program = ["-m", "quintet.coupler.bench.raw_transport", transport, str(size), str(windows)]
    if transport == "mpi":
        both = [*find_launcher(), "-n", "2", *PYTHON, "-m", "mpi4py", *program]
        return _result([_started(both)])
    line = [*PYTHON, *program, f"tcp/127.0.0.1:{free_port()}"]
    return _result([_started([*line, "leader"]), _started([*line, "follower"])])


def _started(line: list[str]) -> "subprocess.Popen[bytes]":
    return subprocess.Popen(
        line,
        env=environment(1),
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        start_new_session=True,
    )


def _result(processes: "list[subprocess.Popen[bytes]]") -> float:
    """Wait for all processes to end; return the number that the first printed last."""
    limit, first = time.monotonic() + PATIENCE, processes[0]
    try:
        while first.poll() is None and time.monotonic() < limit:
            if any(process.poll() for process in processes):
                break
            time.sleep(0.05)
    finally:
        status = [process.poll() for process in processes]
        outputs = [_end(process) for process in processes]
    if status[0] != 0:
        lines = "\n".join(
            f"    {line}" for output in outputs for line in output.splitlines()[-LINES:]
        )
        raise QuintetError(
            f"bench exchange: the library alone must end with status 0 within {PATIENCE:.0f} s; "
            f"found {status}:\n{lines}"
        )
    return float(outputs[0].split()[-1])


def _end(process: "subprocess.Popen[bytes]") -> str:
    """Terminate a process, or a launcher with its ranks; return what it printed."""
    process.terminate()
    try:
        output, _ = process.communicate(timeout=GRACE)
    except subprocess.TimeoutExpired:
        process.kill()
        output, _ = process.communicate()
    return output.decode(errors="replace")


def main() -> None:
    """Run one of the two processes."""
    transport, size, windows = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
    channel = _over_mpi if transport == "mpi" else _over_zenoh
    with channel(size) as (leads, send, receive):
        if leads:
            print(statistics.median(_lead(send, receive, size, windows)), flush=True)
        else:
            _follow(send, receive, size, windows)


def _lead(send: Send, receive: Receive, size: int, windows: int) -> list[float]:
    value, frame = np.random.default_rng(1).random(size // 8), bytearray(size)
    took = []
    for _ in range(WARM + windows):
        began = time.perf_counter()
        np.frombuffer(frame)[:] = value
        send(frame)
        float(np.frombuffer(receive()).sum())
        took.append(time.perf_counter() - began)
    return took[WARM:]


def _follow(send: Send, receive: Receive, size: int, windows: int) -> None:
    frame = bytearray(size)
    for _ in range(WARM + windows):
        value = np.frombuffer(receive())
        float(value.sum())
        np.frombuffer(frame)[:] = value
        send(frame)


@contextmanager
def _over_mpi(size: int) -> Iterator[Channel]:
    # Only the library that is measured is loaded.
    from mpi4py import MPI

    comm, buffer = MPI.COMM_WORLD, bytearray(size)
    other = 1 - comm.rank

    def receive() -> bytearray:
        comm.Recv([buffer, MPI.BYTE], other)
        return buffer

    yield comm.rank == 0, lambda frame: comm.Send([frame, MPI.BYTE], other), receive


@contextmanager
def _over_zenoh(_: int) -> Iterator[Channel]:
    # Only the library that is measured is loaded.
    import zenoh

    from quintet.interfaces.lines.zenoh import configuration

    endpoint, me = sys.argv[4:]
    other = "follower" if me == "leader" else "leader"
    with zenoh.open(configuration(endpoint, me == "follower", None)) as session:
        inbox = session.declare_subscriber(f"round_trip/{me}", zenoh.handlers.FifoChannel(4))
        outbox: Any = session.declare_publisher(  # typed as a plain bool in zenoh's stub
            f"round_trip/{other}", congestion_control=zenoh.CongestionControl.BLOCK
        )
        limit = time.monotonic() + PATIENCE
        while not outbox.matching_status.matching and time.monotonic() < limit:
            time.sleep(0.01)
        yield me == "leader", outbox.put, lambda: inbox.recv().payload.to_bytes()
        time.sleep(LINGER)


if __name__ == "__main__":
    main()
