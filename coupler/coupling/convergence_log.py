"""The convergence log: how often each window was repeated, and what every field then lacked."""

import csv
import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from quintet.coupler.coupling.convergence_measure import Residual
from quintet.coupler.coupling.residual_scaling import Key


def log_file(group: str) -> str:
    """Name of the log of a group, "" for the whole run."""
    return f"convergence-{group}.csv" if group else "convergence.csv"


@dataclass(frozen=True, slots=True)
class ConvergenceRow:
    """One window."""

    window: int
    repetitions: int  # after the first time that it was stepped
    residuals: Mapping[Key, Residual]  # of the last


class ConvergenceLog:
    """Writes a row per window: its number, repetitions, relative residual of each field."""

    def __init__(self, path: Path | None, size: int = 0) -> None:
        """Begin the file, or go on with the first `size` bytes of it; with no path, write none."""
        self._file = open(path, "a" if size else "w", newline="") if path else None
        self._rows = csv.writer(self._file) if self._file else None
        self._begun = bool(size)
        if self._file and size:
            self._file.truncate(size)
            self._file.seek(0, os.SEEK_END)

    def write(self, row: ConvergenceRow) -> None:
        """Add a row."""
        if not self._rows:
            return
        if not self._begun:
            names = [".".join(key) for key in row.residuals]
            self._rows.writerow(["window", "repetitions", *names])
            self._begun = True
        relative = [one.relative for one in row.residuals.values()]
        self._rows.writerow([row.window, row.repetitions, *relative])

    def size(self) -> int:
        """Length of the file with all that was written [bytes], for a snapshot."""
        if not self._file:
            return 0
        self._file.flush()
        return self._file.tell()

    def cut(self, size: int) -> None:
        """Forget all that was written after a length of the file [bytes]."""
        if self._file:
            self._file.flush()
            self._file.truncate(size)
            self._file.seek(0, os.SEEK_END)
            self._begun = self._begun and size > 0

    def close(self) -> None:
        """Close the file."""
        if self._file:
            self._file.close()
