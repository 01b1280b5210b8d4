"""One process of a run: whether it lives, what it does, and where in its code it is."""

import contextlib
import math
import os
import signal
import subprocess
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

import psutil

from quintet.interfaces.lines.process_status import running

if TYPE_CHECKING:
    from quintet.coupler.launch.remote_host import RemoteHost

BUSY = 0.02  # share of a core below which a process does not compute
INTERVAL = 0.5  # s between two readings of processor times
IDLE = "sleeping"
SIGNALS = frozenset(map(int, signal.Signals))
WRITTEN = 0.3  # s within which the exit status of a process is written that was started for us


def killed_for_memory() -> int:
    """Processes that this system has killed so far because its memory ran out."""
    with contextlib.suppress(OSError):
        for line in Path("/proc/vmstat").read_text().splitlines():
            if line.startswith("oom_kill "):
                return int(line.split()[1])
    return 0


def signal_text(number: int) -> str:
    """Number of a signal, and its name: most of those for programs' own use have none."""
    try:
        return f"signal {number} ({signal.Signals(number).name})"
    except ValueError:
        return f"signal {number}"


@dataclass(slots=True)
class ProcessProbe:
    """Reads what a process of this host does; of one elsewhere nothing is known.

    Parameters
    ----------
    pid : int
        0: on another host.
    process : Popen or None
        When it is our own child.
    exit_file : path or None
        Where the exit status of a process is written that another process has started for us.
    shared : list of str
        Files in shared memory that it maps.
    where : function
        Returns where in its code it is, the innermost call first; "" if unknown.
    """

    name: str
    pid: int = 0
    process: subprocess.Popen[bytes] | None = None
    exit_file: Path | None = None
    shared: list[str] = field(default_factory=list)
    where: Callable[[], str] = lambda: ""
    by_hand: bool = False  # whether somebody has started it, or is to do so
    awaited: bool = False  # until somebody joins by hand under its name
    host: "RemoteHost | None" = None  # where it runs, if that may be another one than the coupler's
    given_up: str = ""  # why, if it cannot be ended from here
    activity: str = ""  # what it did since the last reading
    _read_at: float = 0.0
    _times: tuple[float, float] = (0.0, 0.0)  # s, of its own and of its children
    _looked_at: float = 0.0
    _ended: bool = False
    _stopped_since: int = -1  # switches of its main thread as it was first found so; -1: it runs
    _killed_before: int = field(default_factory=killed_for_memory)

    def alive(self) -> bool:
        """Whether the process still runs."""
        if self.given_up:
            return False
        if self.process:
            return self.process.poll() is None
        if self.pid:
            return running(self.pid)
        return self.exit_file is None or not self._has_written()

    def _has_written(self) -> bool:
        """Whether the exit status of a process elsewhere has been written; asked now and then."""
        now = time.monotonic()
        if now - self._looked_at > INTERVAL:
            self._looked_at, self._ended = now, bool(self.exit_file and self.exit_file.exists())
        return self._ended

    def ending(self) -> str:
        """Describe how the process ended."""
        if self.given_up:
            return self.given_up
        code = self.process.returncode if self.process else self._written()
        who = f"process {self.pid}" if self.pid else "its process, not on the coupler's host,"
        if code is None:
            return f"{who} is gone: it ended or was killed"
        if code < 0:
            reason = self._reason(-code) if self.pid else ""
            return f"{who} was killed by {signal_text(-code)}{reason}"
        return f"{who} ended by itself with status {code}, before it was told to"

    def ended_at(self) -> float:
        """When its exit status was written, s since the epoch; inf if it was not."""
        try:
            return self.exit_file.stat().st_mtime if self.exit_file else math.inf
        except OSError:
            return math.inf

    def _written(self) -> int | None:
        """Exit status of a process of another parent; negative: the signal that killed it."""
        limit = time.monotonic() + WRITTEN
        while self.exit_file and time.monotonic() < limit:
            with contextlib.suppress(OSError, ValueError):
                code = int(self.exit_file.read_text())
                return 128 - code if code - 128 in SIGNALS else code  # as a shell counts
            time.sleep(0.005)
        return None

    def _reason(self, number: int) -> str:
        """Why a process was killed, where the system tells."""
        if number == signal.SIGSEGV:
            return ": its compiled code used memory that is not its own; its log has the stack"
        if number == signal.SIGKILL and killed_for_memory() > self._killed_before:
            return ", most likely by the system, whose memory ran out: use fewer items or threads"
        return ""

    def stopped(self) -> bool:
        """Whether the process was stopped, and is not being debugged; asked again and again.

        It must not have run since it was first found so: one that is only slowed down goes on.
        """
        switches, before = -1, self._stopped_since
        with contextlib.suppress(psutil.Error):
            process = psutil.Process(self.pid) if self.pid else None
            if process and process.status() == psutil.STATUS_STOPPED:
                switches = sum(process.num_ctx_switches())
        self._stopped_since = switches
        return switches >= 0 and switches == before

    def begin(self) -> None:
        """Begin to find out what the process does: from now on."""
        self.activity, self._read_at = "", 0.0

    def leave_out(self) -> None:
        """Leave the time since the last reading out: telling its stack is no work of its own."""
        self._read_at = 0.0

    def read(self) -> None:
        """Find out what the process did since the last reading, now and then."""
        now = time.monotonic()
        if not self.pid or now - self._read_at < INTERVAL:
            return
        with contextlib.suppress(psutil.Error):
            process = psutil.Process(self.pid)
            times = _processor_times(process)
            if self._read_at:
                parent, children = (
                    (new - old) / (now - self._read_at)
                    for new, old in zip(times, self._times, strict=True)
                )
                self.activity = _activity(process.status(), parent, children)
            self._read_at, self._times = now, times

    def described(self) -> str:
        """What the process does, in words."""
        if self.awaited:
            return f"nobody has joined as {self.name} yet"
        if not self.pid:
            return f"its process is on {self.host.name if self.host else 'another host'}"
        return f"process {self.pid} is {self.activity or 'running'}"

    def end(self, grace: float) -> None:
        """Wait for the process to end, then kill it; remove its files in shared memory."""
        limit = time.monotonic() + grace
        while self.alive() and time.monotonic() < limit:
            time.sleep(0.01)
        self.kill()
        if self.process:
            self.process.wait()
        for path in self.shared:
            with contextlib.suppress(OSError):
                os.unlink(path)

    def pids(self) -> list[int]:
        """Processes of this host that belong to the component."""
        return [self.pid] if self.pid else []

    def kill(self) -> None:
        """Kill the process."""
        if self.pid and self.alive():
            with contextlib.suppress(ProcessLookupError, PermissionError):
                os.kill(self.pid, signal.SIGKILL)

    def give_up(self, cause: str) -> None:
        """Kill the process; count one that cannot be killed from here as dead."""
        if not self.pids():
            self.given_up = cause
        self.kill()


def _processor_times(process: psutil.Process) -> tuple[float, float]:
    """Processor time of a process and of all its children, those that ended included [s]."""
    parent = process.cpu_times()
    children = parent.children_user + parent.children_system
    for child in process.children(recursive=True):
        with contextlib.suppress(psutil.Error):
            times = child.cpu_times()
            children += times.user + times.system + times.children_user + times.children_system
    return parent.user + parent.system, children


def _activity(status: str, parent: float, children: float) -> str:
    """What a process does, from its state and the shares of a core that are used."""
    if status == psutil.STATUS_STOPPED:
        return "stopped"
    if status == psutil.STATUS_DISK_SLEEP:
        return "waiting for a disk"
    if parent > BUSY:
        return "computing"
    return "waiting for its children, which compute" if children > BUSY else IDLE
