"""What is printed into a log whose disk may be full: what finds no room there is left out."""

import contextlib
import io
import os
import stat
import sys
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
    for name, number in (("stdout", 1), ("stderr", 2)):
        if not stat.S_ISREG(os.fstat(number).st_mode):
            continue
        stream = io.BufferedWriter(LogStream(number))
        text = io.TextIOWrapper(stream, "utf-8", "backslashreplace", line_buffering=True)
        setattr(sys, name, text)
