"""A table that grows: rows of a CSV file, each whole on the disk or not there at all."""

import contextlib
import csv
import io
import os
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from quintet.coupler.files.disk import Writing, check_length, disk_error

BATCH = 1 << 14  # characters that are kept back at most


class TableFile:
    """Appends rows; with no path, nowhere."""

    def __init__(self, path: Path | None, size: int = 0) -> None:
        """Begin the file, or go on with the first `size` bytes of it."""
        self.path, self.size = path, size  # bytes on the disk
        self._kept = io.StringIO()
        self._rows = csv.writer(self._kept)
        self._file = -1
        if path is None:
            return
        if size:
            check_length(path, size)
        try:
            self._file = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_CLOEXEC, 0o666)
            os.ftruncate(self._file, size)
        except OSError as error:
            raise disk_error(path, error) from error

    def write(self, row: Iterable[Any]) -> None:
        """Add a row."""
        if self._file >= 0:
            self._rows.writerow(row)
            if self._kept.tell() > BATCH:
                self.flush()

    def flush(self) -> int:
        """Write out all rows; return the length of the file [bytes]."""
        data = self._kept.getvalue().encode()
        if data and self._file >= 0:
            self._kept.seek(0)
            self._kept.truncate()
            self._append(data)
        return self.size

    def _append(self, data: bytes) -> None:
        assert self.path is not None
        at = self.size
        try:
            Writing.begin(self.path)
            while data:
                written = os.pwrite(self._file, data, at)
                at, data = at + written, data[written:]
        except OSError as error:
            with contextlib.suppress(OSError):
                os.ftruncate(self._file, self.size)  # no half row
            raise disk_error(self.path, error) from error
        self.size = at

    def sync(self) -> int:
        """Bring all rows to the disk; return the length of the file [bytes]."""
        size = self.flush()
        if self._file >= 0:
            os.fsync(self._file)
        return size

    def cut(self, size: int) -> None:
        """Forget all that was written after a length of the file [bytes]."""
        self.flush()
        if self._file >= 0:
            os.ftruncate(self._file, size)
            self.size = size

    def close(self) -> None:
        """Write out all rows and close the file; a second call does nothing."""
        try:
            self.flush()
        finally:
            if self._file >= 0:
                os.close(self._file)
            self._file = -1
