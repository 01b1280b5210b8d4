"""Handling of SIGINT and SIGTERM while a run goes on."""

import contextlib
import signal
import threading
from collections.abc import Callable, Iterator
from types import FrameType


@contextlib.contextmanager
def handled_by(handler: Callable[[int, FrameType | None], None]) -> Iterator[None]:
    """Handle SIGINT and SIGTERM by a function; other threads than the main one cannot."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    old = {one: signal.signal(one, handler) for one in (signal.SIGINT, signal.SIGTERM)}
    try:
        yield
    finally:
        for one, before in old.items():
            signal.signal(one, before)
