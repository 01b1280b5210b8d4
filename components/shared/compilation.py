"""Compilation of kernels: notices of which one, and no search for garbage meanwhile."""

import gc
import time
from functools import cache
from typing import Any

from numba.core import event

from quintet.interfaces.serving.notices import notice

INTERVAL = 0.5  # s between two notices while the functions within a kernel are compiled


class CompilationNotices(event.Listener):
    """Hears from numba of every function that it compiles, and of none that it finds on disk."""

    def __init__(self) -> None:
        self.kernels: list[str] = []  # being compiled: a kernel, and functions within functions
        self.compiled = 0
        self._said = 0.0

    def on_start(self, event: Any) -> None:
        """Say what is compiled."""
        self.kernels.append(event.data["dispatcher"].py_func.__name__)
        now = time.monotonic()
        if len(self.kernels) == 1 or now - self._said > INTERVAL:
            self._said = now
            done = f" ({self.compiled} functions done)" if self.compiled else ""
            notice(f"compiling {self.kernels[0]}{done}")

    def on_end(self, event: Any) -> None:
        """Count it."""
        self.kernels.pop()
        self.compiled += 1


class PausedCollection(event.Listener):
    """Stops Python's search for cycles of garbage while a kernel is compiled, a tenth of its time.

    A compilation makes millions of objects that it needs to its end.
    """

    def __init__(self) -> None:
        self.depth = 0  # of functions within functions
        self.collects = False  # whether Python did before

    def on_start(self, event: Any) -> None:
        """Stop before the outermost function."""
        if self.depth == 0:
            self.collects = gc.isenabled()
            gc.disable()
        self.depth += 1

    def on_end(self, event: Any) -> None:
        """Go on after it."""
        self.depth -= 1
        if self.depth == 0 and self.collects:
            gc.enable()


@cache
def announce() -> None:
    """Say from now on what is compiled, and compile without collection of garbage."""
    for listener in (CompilationNotices(), PausedCollection()):
        event.register("numba:compile", listener)
