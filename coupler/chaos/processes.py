"""Processes that are killed, stopped and slowed down."""

import contextlib
import threading
import time

import psutil

STOP, GO_ON = 0.01, 0.03  # s of a process that is slowed down


class Signals:
    """Sends signals to processes of components, now and a while later."""

    def __init__(self) -> None:
        self._over = threading.Event()
        self._threads: list[threading.Thread] = []

    def kill(self, pid: int) -> None:
        """Kill a process."""
        with contextlib.suppress(psutil.Error):
            psutil.Process(pid).kill()

    def stop(self, pid: int, seconds: float) -> None:
        """Stop a process for a while, or for good."""
        with contextlib.suppress(psutil.Error):
            process = psutil.Process(pid)
            process.suspend()
            self._begin(lambda: self._resume(process, seconds))

    def slow(self, pid: int, seconds: float) -> None:
        """Stop a process for a moment, again and again."""
        with contextlib.suppress(psutil.Error):
            process = psutil.Process(pid)
            self._begin(lambda: self._stutter(process, seconds))

    def close(self) -> None:
        """Let all processes go on that were to be stopped for a while only."""
        self._over.set()
        for thread in self._threads:
            thread.join(1.0)

    def _begin(self, act: object) -> None:
        thread = threading.Thread(target=act, name="chaos", daemon=True)  # type: ignore[arg-type]
        self._threads.append(thread)
        thread.start()

    def _resume(self, process: psutil.Process, seconds: float) -> None:
        self._over.wait(min(seconds, threading.TIMEOUT_MAX))
        with contextlib.suppress(psutil.Error):
            process.resume()

    def _stutter(self, process: psutil.Process, seconds: float) -> None:
        limit = time.monotonic() + seconds
        with contextlib.suppress(psutil.Error):
            while time.monotonic() < limit and not self._over.is_set():
                process.suspend()
                time.sleep(STOP)
                process.resume()
                self._over.wait(GO_ON)
