"""A process beside a run over memory, which ends it where the run's own watchdog cannot.

A solver that waits, or computes, with the interpreter's lock held stops all Python of its process,
the watchdog's thread included. This process reads in memory that both share whom the run waits for
and when the watchdog was last at work. When the watchdog is silent, this process watches in its
place, by the same rules; the stack and the exit status come from signal handlers that need no
interpreter. If the run's process is killed, as by the system for want of memory, this one writes
that down.
"""

import contextlib
import ctypes
import faulthandler
import mmap
import os
import signal
import sys
import threading
import time
from collections import deque
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any, NoReturn

import numpy as np
import psutil

from quintet.coupler.coupling.participant import ComponentFailed, Participant
from quintet.coupler.launch import stack
from quintet.coupler.launch.companion import Companion
from quintet.coupler.launch.process_probe import ProcessProbe
from quintet.coupler.launch.watchdog import LONGEST_ROUND, Watchdog, Watched
from quintet.coupler.run.signals import StopRequest
from quintet.interfaces.component import Array
from quintet.interfaces.lines.memory import MemoryLine
from quintet.interfaces.serving.process import STACK_SIGNAL

INTERVAL = 0.2  # s between two rounds
SILENT = 1.0  # s without a round of its watchdog, after which a run is watched from here
ENDED = 1.0  # s for the run to end by itself
STILL = (psutil.STATUS_STOPPED, psutil.STATUS_TRACING_STOP)
CELLS = 4  # numbers that are kept of the run, and of every component
# Its number is the exit status of a run that failed: the C library's _exit, as its handler, ends
# the process with it.
FAIL = signal.SIGQUIT


class WatchdogProcess:
    """The process beside this one, and what is noted for it.

    Parameters
    ----------
    patience : mapping
        Of every component [s], by its name.
    stop : StopRequest
        Listening: signals that nobody has read are counted in its pipe.
    report : function
        Called in the other process to write down why the run has failed, with the windows that
        were done and the time [s] that was reached.
    """

    def __init__(
        self,
        patience: Mapping[str, float],
        stop: StopRequest,
        report: Callable[[ComponentFailed, int, float], object],
    ) -> None:
        self.patience, self.stop, self.report = patience, stop, report
        self._shared = np.frombuffer(mmap.mmap(-1, 8 * CELLS * (1 + len(patience))))
        self._stacks = os.memfd_create("stacks")
        self._run = os.getpid()
        self.note_round(())
        faulthandler.register(STACK_SIGNAL, file=self._stacks, all_threads=False)
        self._companion: Companion | None = Companion(self._watch)
        self._former = signal.getsignal(FAIL) or signal.SIG_DFL
        self._exit = os._exit
        os._exit = self._leave
        library = ctypes.CDLL(None)
        library.signal(FAIL, ctypes.cast(library._exit, ctypes.c_void_p))

    def _leave(self, status: int) -> NoReturn:
        """Leave a process as `os._exit`; that of a run that is not over has failed."""
        self._exit(int(FAIL) if os.getpid() == self._run else status)

    def follow(self, participant: Participant) -> None:
        """Note from now on when the coupler waits for a component."""
        row: Any = self._row(participant.name).data  # written to faster than an array

        def note(since: float) -> None:
            if since:
                row[1], row[2] = participant.window, participant.built
            row[0] = since

        participant.keeping_others_waiting.note = note

    def _row(self, name: str) -> Array:
        """Where a component is noted: waited since when, in which window, built, usual time."""
        first = CELLS * (1 + list(self.patience).index(name))
        return self._shared[first : first + CELLS]

    def note_round(self, participants: Iterable[Participant]) -> None:
        """Note that the run's watchdog is at work, and what is usual."""
        self._shared[0], self._shared[1] = time.monotonic(), self.stop.signals
        for participant in participants:
            self._row(participant.name)[3] = participant.timing.usual

    def note(self, windows: int, reached: float) -> None:
        """Note how many windows are done, and the time that was reached [s]."""
        self._shared[2], self._shared[3] = windows, reached

    def close(self) -> None:
        """End the other process; a second call does nothing."""
        if not self._companion:
            return
        self._companion.close()
        self._companion, os._exit = None, self._exit
        if threading.current_thread() is threading.main_thread():  # else the process is left now
            signal.signal(FAIL, self._former)
            faulthandler.unregister(STACK_SIGNAL)
            os.close(self._stacks)

    # In the other process

    def _watch(self, run: int) -> None:
        """Watch until the run ends, by itself or from here."""
        watchdog = Watchdog(self.stop, True, self._is_silent, alone=len(self.patience) == 1)
        watched = [self._watched(name) for name in self.patience]
        last = time.monotonic()
        while os.getppid() == run:
            time.sleep(INTERVAL)
            passed, last = min(time.monotonic() - last, LONGEST_ROUND), time.monotonic()
            if self._stands_still():
                continue
            for component in watched:
                self._read(component.participant)
                watchdog.check_wait(component, passed)
                if component.since and self._is_silent() and self._signals() > 1:
                    watchdog.fail(component, "kept the interpreter's lock when asked to end")
            if isinstance(watchdog.verdict, ComponentFailed):
                self._end(watchdog.verdict)
        participants = [component.participant for component in watched]
        for participant in participants:
            self._read(participant)
        self._write_down(self._death(participants))

    def _death(self, participants: Iterable[Participant]) -> ComponentFailed:
        """Why the run's process is gone: whoever it waited for has most likely ended it."""
        cause = f"process {self._run} is gone: it ended or was killed"
        for participant in participants:
            if participant.keeping_others_waiting.since:
                return ComponentFailed(participant.name, participant.window, cause)
        return ComponentFailed("coupler", int(self._shared[2]), cause)

    def _watched(self, name: str) -> Watched:
        participant = Participant(name, MemoryLine("", name))
        log = Path(f"/proc/self/fd/{self._stacks}")
        probe = ProcessProbe(
            name, self._run, where=lambda: stack.of_process(self._run, STACK_SIGNAL, log)
        )
        return Watched(participant, probe, self.patience[name])

    def _read(self, participant: Participant) -> None:
        since, window, built, usual = self._row(participant.name).tolist()
        participant.keeping_others_waiting.since = since
        participant.window, participant.built = int(window), bool(built)
        participant.timing.recent = deque([usual])

    def _is_silent(self) -> bool:
        return time.monotonic() - float(self._shared[0]) > SILENT

    def _stands_still(self) -> bool:
        """Whether the run was stopped, by a user or a debugger."""
        try:
            return psutil.Process(self._run).status() in STILL
        except psutil.Error:
            return False

    def _signals(self) -> int:
        """Signals that asked for the end, read by the run or not."""
        return int(self._shared[1]) + self.stop.unread()

    def _write_down(self, verdict: ComponentFailed) -> None:
        self.report(verdict, int(self._shared[2]), float(self._shared[3]))
        sys.stdout.flush()
        sys.stderr.flush()

    def _end(self, verdict: ComponentFailed) -> NoReturn:
        try:
            self._write_down(verdict)
        finally:  # it ends, even if it cannot be written down why
            with contextlib.suppress(ProcessLookupError):
                os.kill(self._run, FAIL)
            limit = time.monotonic() + ENDED
            while os.getppid() == self._run and time.monotonic() < limit:
                time.sleep(0.01)
            with contextlib.suppress(ProcessLookupError):
                os.kill(self._run, signal.SIGKILL)
            os._exit(0)
