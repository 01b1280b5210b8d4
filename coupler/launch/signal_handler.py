"""Handling of signals while a run goes on."""

import contextlib
import os
import signal
import threading
from collections.abc import Callable, Iterable, Iterator
from types import FrameType

ENDING = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)  # they end a run in order


@contextlib.contextmanager
def handled_by(
    handler: Callable[[int, FrameType | None], None], numbers: Iterable[int] = ENDING
) -> Iterator[None]:
    """Handle signals by a function; other threads than the main one cannot.

    The end of a terminal that is ignored already, as under nohup, stays so.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    ignored = signal.getsignal(signal.SIGHUP) is signal.SIG_IGN
    descriptors = terminals()

    def handle(number: int, frame: FrameType | None) -> None:
        if number == signal.SIGHUP:
            silence(descriptors)
        handler(number, frame)

    handled = [number for number in numbers if not (ignored and number == signal.SIGHUP)]
    old = {number: signal.signal(number, handle) for number in handled}
    try:
        yield
    finally:
        for number, before in old.items():
            signal.signal(number, before)


def terminals() -> list[int]:
    """Standard output and errors, as far as they are a terminal's."""
    return [number for number in (1, 2) if os.isatty(number)]


def silence(gone: Iterable[int]) -> None:
    """Let what is said to a terminal that is gone go nowhere, instead of being an error."""
    nowhere = os.open(os.devnull, os.O_WRONLY)
    for number in gone:
        os.dup2(nowhere, number)
    os.close(nowhere)
