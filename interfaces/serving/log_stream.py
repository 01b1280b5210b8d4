"""Output into a log whose disk may be full, or to a reader that may leave: what fails is lost."""

import contextlib
import io
import os
import stat
import sys
from collections.abc import Callable
from typing import Any


class LogStream(io.RawIOBase):
    """A stream of bytes that never fails."""

    def __init__(self, number: int) -> None:
        self.number = number

    def writable(self) -> bool:
        """See `io.RawIOBase`."""
        return True

    def fileno(self) -> int:
        """See `io.RawIOBase`."""
        return self.number

    def write(self, data: Any) -> int:
        """Write, or leave out: a run must not end because nobody can read of it."""
        with contextlib.suppress(OSError):
            return os.write(self.number, data)
        return len(data)


def print_into_logs() -> None:
    """Let this process print into logs, where its standard output and errors are files."""
    _replace_streams(stat.S_ISREG)


def outlive_readers() -> None:
    """Let this process go on where nobody reads its standard output and errors any more."""
    _replace_streams(stat.S_ISFIFO)


def _replace_streams(is_replaced: Callable[[int], bool]) -> None:
    for name, number in (("stdout", 1), ("stderr", 2)):
        if getattr(sys, name) is getattr(sys, f"__{name}__") and is_replaced(
            os.fstat(number).st_mode
        ):
            stream = io.BufferedWriter(LogStream(number))
            text = io.TextIOWrapper(stream, "utf-8", "backslashreplace", line_buffering=True)
            setattr(sys, name, text)
