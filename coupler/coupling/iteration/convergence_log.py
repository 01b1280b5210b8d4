"""The convergence log: how often each window was repeated, and what every field then lacked."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from quintet.coupler.coupling.iteration.convergence_measure import Residual
from quintet.coupler.coupling.iteration.residual_scaling import Key
from quintet.coupler.files.table_file import TableFile


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
        self._table = TableFile(path, size)
        self._begun = bool(size)

    def write(self, row: ConvergenceRow) -> None:
        """Add a row."""
        if not self._begun:
            names = [".".join(key) for key in row.residuals]
            self._table.write(["window", "repetitions", *names])
            self._begun = True
        relative = [residual.relative for residual in row.residuals.values()]
        self._table.write([row.window, row.repetitions, *relative])

    def size(self) -> int:
        """Length of the file with all that was written [bytes], for a snapshot."""
        return self._table.flush()

    def sync(self) -> None:
        """Bring all that was written to the disk."""
        self._table.sync()

    def cut(self, size: int) -> None:
        """Forget all that was written after a length of the file [bytes]."""
        self._table.cut(size)
        self._begun = self._begun and size > 0

    def close(self) -> None:
        """Close the file."""
        self._table.close()
