"""Signals that end a run: SIGINT, SIGTERM, SIGHUP, and the end of the process that started it."""

import array
import contextlib
import fcntl
import os
import signal
import sys
import termios
import threading
from collections.abc import Callable, Iterator
from types import FrameType

from quintet.coupler.launch.signal_handler import ENDING, handled_by, silence, terminals
from quintet.coupler.launch.watchdog import POKE
from quintet.interfaces.lines.process_status import running
from quintet.interfaces.serving.process import STARTER


class StopRequest:
    """Whether a run should end early: a signal asked for it, or its starter ended.

    Signals are counted through a pipe that the system writes to: a handler in Python is called when
    the solver that computes in this thread comes back, and another thread may see the pipe before.
    """

    def __init__(self) -> None:
        self._starter = int(os.environ.get(STARTER, "0"))  # process that cleans up after the run
        self._signals = 0
        self._terminals: list[int] = []  # that standard output and errors are, while we listen
        self._pipe = -1  # where their numbers arrive, while we listen
        self._lock = threading.RLock()  # a handler may come while it is held
        self.leave: Callable[[], None] | None = None  # ends this process, where that may be done

    def __call__(self) -> bool:
        """Return whether to end."""
        return self.asked or (self._starter > 0 and not running(self._starter))

    @property
    def asked(self) -> bool:
        """Whether a signal asked for it."""
        self._count()
        return self._signals > 0

    def at_once(self) -> bool:
        """Return whether to end without waiting for anything: there was a second signal."""
        self._count()
        return self._signals > 1

    @property
    def signals(self) -> int:
        """How many signals have asked for it, as far as they were read."""
        return self._signals

    def unread(self) -> int:
        """Signals in the pipe that nobody has read."""
        count = array.array("i", [0])
        with self._lock:
            if self._pipe >= 0:
                fcntl.ioctl(self._pipe, termios.FIONREAD, count)
        return count[0]

    def _count(self) -> None:
        with self._lock, contextlib.suppress(BlockingIOError):
            if self._pipe < 0:
                return
            for number in os.read(self._pipe, 64):
                if number == signal.SIGHUP:  # a shell and the system both send it
                    silence(self._terminals)
                if number in ENDING and not (self._signals and number == signal.SIGHUP):
                    self._signals += 1
                    if self._signals == 1:
                        name = signal.Signals(number).name
                        print(f"\n{name}: ending after this window", file=sys.stderr, flush=True)

    @contextlib.contextmanager
    def listening(self, judged: Callable[[], bool] = lambda: False) -> Iterator[None]:
        """Handle signals: the first ends the run after this window, the second at once.

        Where `judged`, a poke ends it too: what runs in this thread is interrupted.
        """

        def ask(number: int, _: FrameType | None) -> None:
            if number == POKE:
                if judged():
                    raise KeyboardInterrupt
            elif self.at_once():
                raise KeyboardInterrupt

        if threading.current_thread() is not threading.main_thread():
            yield
            return
        self._terminals = terminals()
        self._pipe, end = os.pipe2(os.O_NONBLOCK | os.O_CLOEXEC)
        former = signal.set_wakeup_fd(end, warn_on_full_buffer=False)
        try:
            with handled_by(ask, (*ENDING, POKE)):
                yield
        finally:
            signal.set_wakeup_fd(former)
            self._count()
            with self._lock:
                pipe, self._pipe = self._pipe, -1
            os.close(pipe)
            os.close(end)
