"""A process beside a run over memory, which ends it where the run's own watchdog cannot.

A solver that waits, or computes, with the interpreter's lock held stops all Python of its process,
the watchdog's thread included. The guard reads in memory that both share whom the run waits for and
when the watchdog last looked. When it looks no more, the guard watches in its place, by the same
rules; the stack and the exit status come from signal handlers that need no interpreter. If the
process dies without a word, as one that the system kills for want of memory, it writes that down.
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
import warnings
from collections import deque
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any, NoReturn

import numpy as np
import psutil

from quintet.coupler.coupling.participant import ComponentFailed, Participant
from quintet.coupler.launch import stack
from quintet.coupler.launch.signal_handler import ENDING
from quintet.coupler.launch.watch import Watch
from quintet.coupler.launch.watchdog import LONGEST_LOOK, Watchdog, Watched
from quintet.coupler.run.signals import StopRequest
from quintet.interfaces.component import Array
from quintet.interfaces.lines.memory import MemoryLine
from quintet.interfaces.serving.process import STACK_SIGNAL

LOOKING = 0.2  # s between two looks
SILENT = 1.0  # s without a look of its watchdog, after which a run is watched from here
ENDED = 1.0  # s for the run to end by itself
STILL = (psutil.STATUS_STOPPED, psutil.STATUS_TRACING_STOP)
CELLS = 4  # numbers that are kept of the run, and of every component
# Its number is the exit status of a run that failed: the C library's _exit, as its handler, ends
# the process with it.
FAIL = signal.SIGQUIT


class Guard:
    """The guard of this process, and what it is told.

    Parameters
    ----------
    patience : mapping
        Of every component [s], by its name.
    stop : StopRequest
        Listening: signals that nobody has read are counted in its pipe.
    report : function
        Called in the guard's process to write down why the run has failed, with the windows that
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
        self.look(())
        faulthandler.register(STACK_SIGNAL, file=self._stacks, all_threads=False)
        signal.pthread_sigmask(signal.SIG_BLOCK, ENDING)
        with warnings.catch_warnings():
            # Of threads, as those of OpenBLAS: the guard uses none of what they may hold.
            warnings.simplefilter("ignore", DeprecationWarning)
            self._pid = os.fork()
        if not self._pid:
            self._guard()
        signal.pthread_sigmask(signal.SIG_UNBLOCK, ENDING)
        self._former = signal.getsignal(FAIL) or signal.SIG_DFL
        library = ctypes.CDLL(None)
        library.signal(FAIL, ctypes.cast(library._exit, ctypes.c_void_p))

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

    def look(self, participants: Iterable[Participant]) -> None:
        """Note that the run's watchdog looks, and what is usual."""
        self._shared[0], self._shared[1] = time.monotonic(), self.stop.signals
        for one in participants:
            self._row(one.name)[3] = one.timing.usual

    def note(self, windows: int, reached: float) -> None:
        """Note how many windows are done, and the time that was reached [s]."""
        self._shared[2], self._shared[3] = windows, reached

    def close(self) -> None:
        """End the guard; a second call does nothing."""
        if not self._pid:
            return
        with contextlib.suppress(ProcessLookupError, ChildProcessError):
            os.kill(self._pid, signal.SIGKILL)
            os.waitpid(self._pid, 0)
        self._pid = 0
        if threading.current_thread() is threading.main_thread():  # else the process is left now
            signal.signal(FAIL, self._former)
            faulthandler.unregister(STACK_SIGNAL)
            os.close(self._stacks)

    # In the guard's process

    def _guard(self) -> NoReturn:
        """Watch until the run ends, by itself or from here."""
        try:
            os.setsid()
            signal.set_wakeup_fd(-1)
            for number in ENDING:
                signal.signal(number, signal.SIG_IGN)
            signal.pthread_sigmask(signal.SIG_UNBLOCK, ENDING)
            self._watch()
        finally:
            os._exit(0)

    def _watch(self) -> None:
        watchdog = Watchdog(self.stop, own=True, acts=self._is_silent)
        watched = [self._watched(name) for name in self.patience]
        last = time.monotonic()
        while os.getppid() == self._run:
            time.sleep(LOOKING)
            passed, last = min(time.monotonic() - last, LONGEST_LOOK), time.monotonic()
            if self._stands_still():
                continue
            for one in watched:
                self._read(one.participant)
                watchdog.look_for_wait(one, passed)
                if one.since and self._is_silent() and self._signals() > 1:
                    watchdog.fail(one, "kept the interpreter's lock when asked to end")
            if isinstance(watchdog.verdict, ComponentFailed):
                self._end(watchdog.verdict)
        for one in watched:
            self._read(one.participant)
        self._write_down(self._death([one.participant for one in watched]))

    def _death(self, participants: Iterable[Participant]) -> ComponentFailed:
        """Why the run's process is gone: whoever it waited for has most likely ended it."""
        cause = f"process {self._run} is gone: it ended or was killed"
        for one in participants:
            if one.keeping_others_waiting.since:
                return ComponentFailed(one.name, one.window, cause)
        return ComponentFailed("coupler", int(self._shared[2]), cause)

    def _watched(self, name: str) -> Watched:
        participant = Participant(name, MemoryLine("", name))
        log = Path(f"/proc/self/fd/{self._stacks}")
        watch = Watch(name, self._run, where=lambda: stack.of_process(self._run, STACK_SIGNAL, log))
        return Watched(participant, watch, self.patience[name])

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
        self._write_down(verdict)
        os.kill(self._run, FAIL)
        limit = time.monotonic() + ENDED
        while os.getppid() == self._run and time.monotonic() < limit:
            time.sleep(0.01)
        with contextlib.suppress(ProcessLookupError):
            os.kill(self._run, signal.SIGKILL)
        os._exit(0)
