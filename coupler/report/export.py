"""A run as CSV for other programs: recorded fields by port, and the ledger, units in the head."""

import csv
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from quintet.coupler.files.disk import reporting_disk
from quintet.coupler.files.run_files import LEDGER
from quintet.coupler.report.columns import Columns, chosen, columns_of
from quintet.coupler.report.run import Run, ledger_unit
from quintet.interfaces.errors import SceneError

FOLDER = "export"  # in that of the run


@dataclass(frozen=True)
class Exported:
    """What was written, and which fields were left out because they are too wide."""

    files: list[Path]
    left_out: list[str]


def export(
    folder: Path, wanted: Iterable[str] = (), out: Path | None = None, force: bool = False
) -> Exported:
    """Write the recorded fields of a run, a file for each port, and its ledger.

    Parameters
    ----------
    folder : Path
        Of a run, also one that failed or was interrupted.
    wanted : str
        ``component``, ``component.port`` or ``component.port.field``; without any, all fields of at
        most 1000 numbers.
    out : Path, optional
        Folder of the files; ``export`` in that of the run if not given.
    force : bool
        Replace files of the same names.
    """
    run = Run(folder)
    keys, left_out = chosen(run.fields, wanted)
    place = folder / FOLDER if out is None else out
    if place.resolve() == run.folder:
        raise SceneError(
            f"export: {place} must not be the folder of the run, whose {LEDGER} it would replace. "
            "Name another by --out."
        )
    ports = dict.fromkeys(key.rpartition(".")[0] for key in keys)
    files = {port: place / f"{port}.csv" for port in ports}
    ledger = [place / LEDGER] if (folder / LEDGER).is_file() else []
    if not files and not ledger:
        raise SceneError(
            f"run {folder}: it has neither recorded fields nor a ledger to export. Name the folder "
            "of another run, or set output.record = true."
        )
    if not force and (existing := [path for path in (*files.values(), *ledger) if path.exists()]):
        raise SceneError(
            f"export: {existing[0]} must not exist; {len(existing)} of the files do. Name another "
            "folder by --out, or use --force."
        )
    if place.exists() and not place.is_dir():
        raise SceneError(f"export: {place} must be a folder; found a file. Name another by --out.")
    with reporting_disk(place):
        place.mkdir(parents=True, exist_ok=True)
    for port, path in files.items():
        of_port = [key for key in keys if key.rpartition(".")[0] == port]
        _write_columns(path, [_columns(run, key) for key in of_port])
    for path in ledger:
        _write_ledger(folder / LEDGER, path)
    return Exported([*files.values(), *ledger], left_out)


def _columns(run: Run, key: str) -> Columns:
    return columns_of(key.rpartition(".")[2].replace("_", " "), run.fields.rate(key))


def _write_columns(path: Path, fields: Sequence[Columns]) -> None:
    """Write fields of one port, which have the same times; what is not known is left empty."""
    head = ["time [s]", *(name for columns in fields for name in columns.names)]
    values = np.column_stack([columns.values for columns in fields])
    rows = zip(fields[0].times.tolist(), values.tolist(), strict=True)
    _write(path, head, ([time, *map(_cell, row)] for time, row in rows))


def _cell(value: float) -> float | str:
    return value if value == value else ""  # nan: a mean before the first window


def _write_ledger(source: Path, path: Path) -> None:
    """Copy the ledger, with units in its head."""
    with open(source, newline="") as file:
        head, *rows = csv.reader(file)
    units = [ledger_unit(name) for name in head]
    names = [f"{name} [{unit}]" if unit else name for name, unit in zip(head, units, strict=True)]
    _write(path, names, rows)


def _write(path: Path, head: Sequence[str], rows: Iterable[Sequence[Any]]) -> None:
    with reporting_disk(path), open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(head)
        writer.writerows(rows)
