"""The processes of a component of several MPI ranks, watched as one."""

import contextlib
import math
import os
import time
from dataclasses import dataclass, field

import psutil

from quintet.coupler.launch.mpi_job import files_of
from quintet.coupler.launch.process_probe import IDLE, ProcessProbe

# In whose calls a rank waits for others, or for orders.
WAITING = ("/shared/domain/waiting.py", "/lines/transport.py", "/serving/ranks.py")


@dataclass(slots=True)
class RanksProbe(ProcessProbe):
    """Reads what the ranks of a component do; its own process, if any, is their launcher.

    Parameters
    ----------
    ranks : list of ProcessProbe
        One for each rank in order, named after rank and host; empty until they have joined.
    """

    ranks: list[ProcessProbe] = field(default_factory=list)
    _at_work: list[ProcessProbe] = field(default_factory=list)  # that waited for no other

    def alive(self) -> bool:
        """Whether all processes still run."""
        launched = self.process is None or self.process.poll() is None
        return launched and not self.given_up and all(rank.alive() for rank in self.ranks)

    def ending(self) -> str:
        """Describe how the first that ended did; others may end as they miss it."""
        ended = [rank for rank in self.ranks if not rank.alive() or rank.ended_at() < math.inf]
        if not ended or self.given_up:
            return ProcessProbe.ending(self)
        first = min(ended, key=ProcessProbe.ended_at)
        return f"{first.name}: {first.ending()}"

    def ended_at(self) -> float:
        """When the exit status of the first that ended was written; inf if none was."""
        return min((rank.ended_at() for rank in self.ranks), default=math.inf)

    def stopped(self) -> bool:
        """Whether a rank was stopped; asked again and again."""
        stopped = [rank for rank in self.ranks if rank.stopped()]
        for rank in stopped:
            rank.activity = "stopped"
        return bool(stopped)

    def begin(self) -> None:
        """Begin to find out what the ranks do: from now on."""
        self.activity, self._at_work = "", []
        for rank in self.ranks:
            rank.begin()

    def leave_out(self) -> None:
        """See `ProcessProbe.leave_out`."""
        ProcessProbe.leave_out(self)
        for rank in self.ranks:
            rank.leave_out()

    def read(self) -> None:
        """Find out what the ranks did since the last reading, now and then."""
        if not self.ranks:  # those of their launcher's children
            ProcessProbe.read(self)
            return
        for rank in self.ranks:
            rank.read()
        doing = [rank.activity for rank in self.ranks if rank.pid]
        self.activity = next((activity for activity in doing if activity != IDLE), IDLE)
        if not all(doing):
            self.activity = ""

    def described(self) -> str:
        """What the ranks do, in words; if one alone is stopped, at work or computes, that one."""
        if self.awaited or not self.ranks:
            return ProcessProbe.described(self)
        if self.activity != "stopped" and len(self._at_work) == 1:
            return f"{self._at_work[0].name}: {self._at_work[0].described()}"
        for activity in ("stopped", "computing"):
            doing = [rank for rank in self.ranks if rank.activity == activity]
            if len(doing) == 1:
                return f"{doing[0].name}: {doing[0].described()}"
        return "; ".join(f"{rank.name}: {rank.described()}" for rank in self.ranks)

    def calls(self) -> str:
        """Where in its code the first rank is that waits for no other."""
        stacks = [rank.where() for rank in self.ranks]
        at_work = [n for n, stack in enumerate(stacks) if stack and not _waits(stack)]
        self._at_work = [self.ranks[n] for n in at_work]
        return stacks[at_work[0]] if at_work else stacks[0] if stacks else ""

    def pids(self) -> list[int]:
        """See `ProcessProbe.pids`."""
        return [rank.pid for rank in self.ranks if rank.pid]

    def end(self, grace: float) -> None:
        """Wait for the processes to end, then kill them; remove their files in shared memory."""
        limit = time.monotonic() + grace
        for rank in self.ranks:
            rank.end(max(0.0, limit - time.monotonic()))
        ProcessProbe.end(self, max(0.0, limit - time.monotonic()))

    def kill(self) -> None:
        """Kill the processes; remove the files of those that have not told of them."""
        started = _descendants(self.process.pid) if self.process else []
        files = {path for process in started for path in files_of(process.pid)}
        for rank in self.ranks:
            rank.kill()
        ProcessProbe.kill(self)
        for process in started:
            with contextlib.suppress(psutil.Error):
                process.kill()
        for path in files:
            with contextlib.suppress(OSError):
                os.unlink(path)


def _waits(stack: str) -> bool:
    """Whether a rank waits for others, or for orders."""
    return any(at in stack for at in WAITING)


def _descendants(pid: int) -> list[psutil.Process]:
    try:
        return psutil.Process(pid).children(recursive=True)
    except psutil.Error:
        return []
