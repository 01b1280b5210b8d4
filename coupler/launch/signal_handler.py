"""Handling of signals while a run goes on."""

import contextlib
import signal
import threading
from collections.abc import Callable, Iterator
from types import FrameType


@contextlib.contextmanager
def handled_by(
    handler: Callable[[int, FrameType | None], None],
    numbers: tuple[int, ...] = (signal.SIGINT, signal.SIGTERM),
) -> Iterator[None]:
    """Handle signals by a function; other threads than the main one cannot."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    old = {one: signal.signal(one, handler) for one in numbers}
    try:
        yield
    finally:
        for one, before in old.items():
            signal.signal(one, before)
