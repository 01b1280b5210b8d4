"""Handling of SIGINT, SIGTERM and SIGHUP while a run goes on."""

import contextlib
import os
import signal
import threading
from collections.abc import Callable, Iterable, Iterator
from types import FrameType


@contextlib.contextmanager
def handled_by(handler: Callable[[int, FrameType | None], None]) -> Iterator[None]:
    """Handle them by a function; other threads than the main one cannot.

    The end of a terminal that is ignored already, as under nohup, stays so.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    handled = [signal.SIGINT, signal.SIGTERM]
    if signal.getsignal(signal.SIGHUP) is not signal.SIG_IGN:
        handled.append(signal.SIGHUP)
    terminals = [number for number in (1, 2) if os.isatty(number)]

    def handle(number: int, frame: FrameType | None) -> None:
        if number == signal.SIGHUP:
            _silence(terminals)
        handler(number, frame)

    old = {one: signal.signal(one, handle) for one in handled}
    try:
        yield
    finally:
        for one, before in old.items():
            signal.signal(one, before)


def _silence(terminals: Iterable[int]) -> None:
    """Let what is said to a terminal that is gone go nowhere, instead of being an error."""
    nowhere = os.open(os.devnull, os.O_WRONLY)
    for number in terminals:
        os.dup2(nowhere, number)
    os.close(nowhere)
