"""A command of another program in a process of its own: its CPU time, its limit, its end."""

import contextlib
import os
import shutil
import signal
import subprocess
import sys
import time
import uuid
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from quintet.coupler.launch.companion import Companion, once_gone
from quintet.coupler.launch.processes import end_marked, environment

POLL = 0.02  # s between two polls of the process
MARK = "QUINTET_PEER"  # in the environment of a command, and of all that it starts
THREADS = 1  # of every program, so that CPU times compare
DONE, FAILED, STALLED, INTERRUPTED = "done", "failed", "stalled", "interrupted"


@dataclass(frozen=True, slots=True)
class Ended:
    """How a command ended and what it cost; times in s, memory in bytes."""

    status: str
    exit: int  # exit status; of a signal its number, negative
    wall: float = 0.0
    cpu: float = 0.0  # user and system time of the process and all that it waited for
    memory: int = 0  # peak of the largest process


def executable(word: str) -> str | None:
    """Full path of a program: beside the Python that runs quintet, or in PATH."""
    beside = os.path.dirname(sys.executable)
    return shutil.which(word, path=os.pathsep.join([beside, os.environ.get("PATH", os.defpath)]))


def run_command(
    command: list[str],
    folder: Path,
    log: Path,
    seconds: float,
    stop: Callable[[], bool],
    variables: Mapping[str, str],
) -> Ended:
    """Run a command in a folder until it ends, or time is up, or it is stopped.

    No process that it started survives it, whatever session that is in by then; nor if this
    process is killed.

    Parameters
    ----------
    command : list of str
    folder : Path
        In which it runs.
    log : Path
        To which its output is added.
    seconds : float
        After which it is killed, with all that it started.
    stop : callable
        Whether to end early.
    variables : mapping
        Of its environment, where they are not set already.
    """
    mark = uuid.uuid4().hex
    marks = {**variables, **environment(THREADS), "PWD": str(folder), MARK: mark}
    end_all = partial(end_marked, MARK, mark)
    companion = Companion(once_gone(end_all))
    try:
        began = time.monotonic()
        with open(log, "ab") as file:
            process = subprocess.Popen(
                command,
                cwd=folder,
                stdin=subprocess.DEVNULL,
                stdout=file,
                stderr=file,
                start_new_session=True,
                env=marks,
            )
        return _wait(process, began, seconds, stop)
    finally:
        end_all()
        companion.close()


def _wait(
    process: subprocess.Popen[bytes], began: float, seconds: float, stop: Callable[[], bool]
) -> Ended:
    """Wait for the end of a process, or kill its session; return how it ended and its costs."""
    reason = ""
    try:
        ended, code, used = os.wait4(process.pid, os.WNOHANG)
        while not ended:
            if not reason and (stop() or time.monotonic() > began + seconds):
                reason = INTERRUPTED if stop() else STALLED
                _kill(process.pid)
            time.sleep(POLL)
            ended, code, used = os.wait4(process.pid, os.WNOHANG)
    except BaseException:
        _kill(process.pid)
        process.wait()
        raise
    _kill(process.pid)  # the rest of its session, also without the mark
    process.returncode = os.waitstatus_to_exitcode(code)
    return Ended(
        reason or (DONE if process.returncode == 0 else FAILED),
        process.returncode,
        time.monotonic() - began,
        used.ru_utime + used.ru_stime,
        used.ru_maxrss * 1024,
    )


def _kill(session: int) -> None:
    with contextlib.suppress(ProcessLookupError):
        os.killpg(session, signal.SIGKILL)
