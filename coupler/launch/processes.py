"""Component processes: starting them, finding all that belong to a run, ending them."""

import contextlib
import ctypes
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from pathlib import Path

import psutil

from quintet.interfaces.lines.process_status import running
from quintet.interfaces.serving.process import SECRET

# Python, which by itself looks for modules where it is started before it looks anywhere else.
PYTHON = (sys.executable, "-P")
GRACE = 2.0  # s for a process to end by itself
KILLED = 1.0  # s within which the system has ended what was killed
SET_CHILD_SUBREAPER = 36  # of prctl
PROCESS = "QUINTET_PROCESS"  # in the environment of a process, and of those that it starts
RUN = "QUINTET_RUN"  # in the environment of all processes of a run, and of those that they start


def start(
    arguments: list[str],
    log: Path,
    threads: int,
    run: str = "",
    secret: str = "",
    launcher: Sequence[str] = (),
    mark: str = "",
) -> subprocess.Popen[bytes]:
    """Start a Python program, part of a run, in a session of its own, its output in a log.

    With a launcher it is that command's, which starts several.

    It gets the secret of the run's messages in its environment, which other users cannot see.
    """
    with open(log, "ab") as file:
        return subprocess.Popen(
            [*launcher, *PYTHON, *arguments],
            stdin=subprocess.DEVNULL,
            stdout=file,
            stderr=file,
            start_new_session=True,
            env={**environment(threads), RUN: run, SECRET: secret, PROCESS: mark},
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


def end_marked(name: str, value: str) -> None:
    """Kill all processes of this host with a variable in their environment, and see them gone.

    A solver's own child processes inherit it, whatever sessions and parents they have by now.
    A process that just starts a program shows no environment for an instant: none must be there
    twice in a row.
    """
    limit = time.monotonic() + KILLED
    absent = 0  # times in a row
    while absent < 2 and time.monotonic() < limit:
        left = [pid for pid in marked(name, value) if running(pid)]
        for pid in left:
            with contextlib.suppress(ProcessLookupError):
                os.kill(pid, signal.SIGKILL)
        absent = 0 if left else absent + 1
        time.sleep(0.01)


def marked(name: str, value: str) -> Iterator[int]:
    """Processes of this host with a variable in their environment."""
    mark = f"{name}={value}".encode()
    for entry in Path("/proc").glob("[0-9]*/environ"):
        with contextlib.suppress(OSError):
            if mark in entry.read_bytes().split(b"\0"):
                yield int(entry.parent.name)


def size_of(path: Path) -> int:
    """Size of a file [bytes]; 0 where there is none."""
    return path.stat().st_size if path.is_file() else 0


def tail(path: Path, lines: int = 12, first: int = 0) -> list[str]:
    """Last lines of a log after its first bytes; empty when there are none."""
    try:
        with open(path, "rb") as file:
            file.seek(max(first, path.stat().st_size - 16384))
            return file.read().decode(errors="replace").splitlines()[-lines:]
    except OSError:
        return []


class OwnProcesses:
    """Processes that solvers in this process start: they end with the run.

    They are children of this process, or inherit its environment, whatever session they are in.
    Orphans among them become children of this process, too.
    """

    def __init__(self, mark: str) -> None:
        self.mark, self.before = mark, set(_children())
        os.environ[RUN] = mark
        _adopt_orphans(True)

    def end(self) -> None:
        """Kill those that still run."""
        os.environ.pop(RUN, None)
        _adopt_orphans(False)
        for child in set(_children()) - self.before:
            with contextlib.suppress(psutil.Error):
                child.kill()
        end_marked(RUN, self.mark)


def _adopt_orphans(adopts: bool) -> None:
    """Become the parent of descendants whose own parent ends, or no longer; see prctl(2)."""
    ctypes.CDLL(None).prctl(SET_CHILD_SUBREAPER, int(adopts), 0, 0, 0)


def _children() -> list[psutil.Process]:
    return psutil.Process().children(recursive=True)
