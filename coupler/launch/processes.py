"""Component processes: starting them, watching them while an answer is awaited, ending them."""

import contextlib
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

from quintet.interfaces.lines.process_status import processor_time, running, state

QUIET_FACTOR, QUIET_EXTRA = 3.0, 5.0  # inactive for 3 usual windows and 5 s: hanging
BUSY = 0.02  # share of a core below which a process counts as inactive
INTERVAL = 0.5  # s between two readings of a process's times
STATES = {"R": "running", "S": "sleeping", "D": "waiting for a disk", "T": "stopped"}
# Python, which by itself looks for modules where it is started before it looks anywhere else.
PYTHON = (sys.executable, "-P")
GRACE = 2.0  # s for a process to end by itself


@dataclass(slots=True)
class Watch:
    """Watches a process of this host: whether it ended, or uses no processor time."""

    name: str
    pid: int
    process: subprocess.Popen[bytes] | None = None  # when it is our own child
    usual: Callable[[], float] = lambda: 0.0  # s, its usual time for an answer
    shared: list[str] = field(default_factory=list)  # files in shared memory that it maps
    _read_at: float = 0.0
    _spent: float = 0.0
    _active: float = 0.0

    def reset(self) -> None:
        """Restart the measurement of inactivity, when an answer is first awaited."""
        self._read_at = 0.0

    def __call__(self) -> str:
        """Return why no answer can be expected; "" while the process is active."""
        if not self.alive():
            return self.ending()
        now = time.monotonic()
        if not self._read_at:
            self._active, self._read_at, self._spent = now, now, processor_time(self.pid)
        if now - self._read_at < INTERVAL:
            return ""
        spent = processor_time(self.pid)
        if spent - self._spent > BUSY * (now - self._read_at):
            self._active = now
        self._read_at, self._spent = now, spent
        quiet = now - self._active
        if quiet > QUIET_FACTOR * self.usual() + QUIET_EXTRA:
            return (
                f"stopped responding: no answer and no processor time for {quiet:.1f} s "
                f"(process {self.pid} is {STATES.get(state(self.pid), 'unknown')})"
            )
        return ""

    def alive(self) -> bool:
        """Whether the process still runs."""
        return self.process.poll() is None if self.process else running(self.pid)

    def ending(self) -> str:
        """Describe how the process ended."""
        code = self.process.returncode if self.process else None
        if code is None:
            return f"process {self.pid} is gone: it ended or was killed"
        if code < 0:
            return f"process {self.pid} was killed by signal {-code} ({signal.Signals(-code).name})"
        return f"process {self.pid} ended by itself with status {code}, before it was told to"

    def end(self, grace: float) -> None:
        """Wait for the process to end, then kill it; remove its files in shared memory."""
        limit = time.monotonic() + grace
        while self.alive() and time.monotonic() < limit:
            time.sleep(0.01)
        if self.alive():
            with contextlib.suppress(ProcessLookupError):
                os.kill(self.pid, signal.SIGKILL)
        if self.process:
            self.process.wait()
        for path in self.shared:
            with contextlib.suppress(OSError):
                os.unlink(path)


def start(arguments: list[str], log: Path, threads: int) -> subprocess.Popen[bytes]:
    """Start a Python program in a session of its own, its output in a log."""
    with open(log, "ab") as file:
        return subprocess.Popen(
            [*PYTHON, *arguments],
            stdin=subprocess.DEVNULL,
            stdout=file,
            stderr=file,
            start_new_session=True,
            env=environment(threads),
        )


def environment(threads: int) -> dict[str, str]:
    """Environment of a component: size of its thread pools, import path, passive waiting."""
    known = os.environ.get("PYTHONPATH", "").split(os.pathsep)
    path = os.pathsep.join(filter(None, known))  # nothing between two separators: where we are
    sizes = dict.fromkeys(("NUMBA_NUM_THREADS", "OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"), threads)
    return {
        **os.environ,
        **{name: str(size) for name, size in sizes.items()},
        "PYTHONPATH": path,
        "OMP_WAIT_POLICY": "passive",
    }


def tail(path: Path, lines: int = 12) -> list[str]:
    """Last lines of a log; empty when there is none."""
    try:
        with open(path, "rb") as file:
            file.seek(max(0, path.stat().st_size - 16384))
            return file.read().decode(errors="replace").splitlines()[-lines:]
    except OSError:
        return []
