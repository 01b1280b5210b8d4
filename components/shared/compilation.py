"""Notices of the compilation of kernels: which one, and how many functions are done."""

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


@cache
def announce() -> None:
    """Say from now on what is compiled."""
    event.register("numba:compile", CompilationNotices())
