"""Checksums of recordings: who writes one, and who reads or replays it, agree on them here.

A recording is an HDF5 file, whose default format has no checksums: a changed byte would give other
numbers. Every row of a field has a CRC-32 of its bytes, its name and its number, and so have the
marks of every row (its time, in seconds and ticks, and the stable step); what is written once has
one for each component and one for the file. They are of what is read, not of the bytes on the disk:
damage of HDF5's own tables, which leads to other data, is noticed as well.
"""

import contextlib
import sys
import zlib
from collections.abc import Iterable, Iterator
from struct import Struct
from typing import Any

import numpy as np
from numpy.typing import NDArray

from quintet.interfaces.errors import SceneError

Rows = NDArray[Any]
MARKS = {"times": "f8", "ticks": "i8", "stable_steps": "f8"}  # of every row
PACKED_MARKS = Struct("<dqd")  # the same, as bytes
CHECK = "check"  # attribute of the file, and of each component
ROW_CHECKS = "row_checks"  # dataset (rows, 1 + fields) u4 of a component: marks, then each field
# What h5py, numpy and JSON raise for a file that is not as it was written.
UNREADABLE = (
    ArithmeticError,
    AssertionError,
    AttributeError,
    LookupError,
    MemoryError,
    OSError,
    RuntimeError,
    SystemError,
    TypeError,
    ValueError,
)
_told: set[str] = set()  # recordings without checksums, of which this process has told


def checksum(label: str, *parts: Any) -> int:
    """CRC-32 of a label and arrays or bytes after it."""
    crc = zlib.crc32(label.encode())
    for part in parts:
        if isinstance(part, bytes):
            crc = zlib.crc32(part, crc)
        elif np.size(part):  # of no items there is no buffer
            crc = zlib.crc32(np.ascontiguousarray(part).data.cast("B"), crc)
    return crc


def marks_check(name: str, row: int, marks: Iterable[float]) -> int:
    """Checksum of the marks of a row, in the order of `MARKS`."""
    return zlib.crc32(PACKED_MARKS.pack(*marks), zlib.crc32(f"{name}/{row}".encode()))


def field_check(name: str, key: str, row: int, array: Rows) -> int:
    """Checksum of a row (n, *shape) of a field, contiguous."""
    label = zlib.crc32(f"{name}.{key}/{row}".encode())
    return zlib.crc32(array.data, label) if array.size else label  # of no items: no buffer


def file_check(file: Any) -> int:
    """Checksum of what a recording says of itself: run, tick, scene, and names of components."""
    names = "\n".join(file["components"])
    tick = np.float64(file.attrs["tick"])
    return checksum(f"{file.attrs['run']}\n{names}\n", file["scene"][()], tick)


def component_check(group: Any) -> int:
    """Checksum of what is written once of a component: ports, static fields, layout of fields."""
    static = group.get("static", {})
    texts = [f"static {k} {array.dtype} {array.shape}" for k, array in static.items()]
    texts += [f"field {k} {array.dtype} {array.shape[1:]}" for k, array in group["fields"].items()]
    label = "\n".join([group.name, str(group.attrs["ports"]), *texts])
    return checksum(label, *(array[()] for array in static.values()))


def seal(group: Any) -> None:
    """Write the checksums of what is written once: of a component, and of its file."""
    group.attrs[CHECK] = np.uint32(component_check(group))
    group.file.attrs[CHECK] = np.uint32(file_check(group.file))


def seal_rows(group: Any, name: str, rows: int) -> None:
    """Write the checksums of rows that were written without."""
    layout = {"maxshape": (None, 1 + len(group["fields"])), "chunks": True}
    group.create_dataset(ROW_CHECKS, (rows, 1 + len(group["fields"])), "u4", **layout)
    for row, column, check in _checks(group, name, rows):
        group[ROW_CHECKS][row, column] = check


def _checks(group: Any, name: str, rows: int) -> Iterator[tuple[int, int, int]]:
    """Row, column and checksum of the first rows of a component as they are read."""
    marks = [group[key][:rows] for key in MARKS]
    for row in range(rows):
        yield row, 0, marks_check(name, row, [mark[row] for mark in marks])
    for column, (key, data) in enumerate(group["fields"].items(), 1):
        size = data.chunks[0] if data.chunks else max(rows, 1)  # each chunk is unpacked once
        for first in range(0, rows, size):
            for row, array in enumerate(data[first : min(first + size, rows)], first):
                yield row, column, field_check(name, key, row, array)


@contextlib.contextmanager
def readable(path: object) -> Iterator[None]:
    """Turn errors of reading a recording into one sentence."""
    try:
        yield
    except UNREADABLE as error:
        cause = " ".join(f"{type(error).__name__}: {error}".split())
        raise SceneError(
            f"recording {path}: it must be a whole recording of quintet; reading it found {cause}. "
            "As it is not a whole recording, copy it again from where it was made, or run the "
            "scene again."
        ) from error


def damaged(path: object, part: str) -> SceneError:
    """Say which part of a recording is not as it was written."""
    return SceneError(
        f"recording {path}: {part} is not as it was written: the file was changed or cut. Copy it "
        "again from where it was made, or run the scene again (--resume, if it was interrupted)."
    )


class CheckedFile:
    """A recording that is read: everything is checked before it is used.

    Parameters
    ----------
    file : h5py.File
    path : path
        As it is named in sentences.
    """

    def __init__(self, file: Any, path: object) -> None:
        self.file, self.path = file, path
        groups = dict(file["components"].items())
        sealed = [CHECK in file.attrs, *(CHECK in group.attrs for group in groups.values())]
        sealed += [ROW_CHECKS in group for group in groups.values()]
        self.has_checks = any(sealed)
        if self.has_checks and (not all(sealed[: 1 + len(groups)])):
            raise damaged(path, "one of its checksums")
        if not self.has_checks:
            _tell(path)
        elif file.attrs[CHECK] != file_check(file):
            raise damaged(path, "its head")
        self._groups = groups
        self._checked: set[str] = set()
        self._marks: dict[str, dict[str, Rows]] = {}

    def component(self, name: str) -> Any:
        """Group of a component, its static part and its length checked once."""
        group = self._groups[name]
        if name not in self._checked:
            if self.has_checks and group.attrs[CHECK] != component_check(group):
                raise damaged(self.path, f"the head of {name}")
            self._check_lengths(name, group)
            self._checked.add(name)
        return group

    def _check_lengths(self, name: str, group: Any) -> None:
        rows = len(group["times"])
        parts = [*(group[key] for key in MARKS), *group["fields"].values()]
        if self.has_checks and (rows or ROW_CHECKS in group):
            parts.append(group[ROW_CHECKS])
            if parts[-1].shape[1:] != (1 + len(group["fields"]),):
                raise damaged(self.path, f"the table of checksums of {name}")
        if any(len(part) != rows for part in parts):
            least = min(len(part) for part in parts)
            raise damaged(self.path, f"the number of windows of {name} (at least {least})")

    def marks(self, name: str) -> dict[str, Rows]:
        """Marks (rows,) of all rows of a component."""
        if name in self._marks:
            return self._marks[name]
        group = self.component(name)
        marks = {key: np.asarray(group[key]) for key in MARKS}
        if self.has_checks and len(marks["times"]):
            for row, wanted in enumerate(group[ROW_CHECKS][:, 0]):
                if marks_check(name, row, [mark[row] for mark in marks.values()]) != wanted:
                    raise damaged(self.path, f"window {row} of the time of {name}")
        self._marks[name] = marks
        return marks

    def field(self, name: str, key: str, rows: slice = slice(None)) -> Rows:
        """Rows (rows, n, *shape) of a field."""
        group = self.component(name)
        data = group["fields"][key]
        rows_read = np.asarray(data[rows])
        if self.has_checks and len(rows_read):
            column = 1 + list(group["fields"]).index(key)
            numbers = range(*rows.indices(len(data)))
            wanted = group[ROW_CHECKS][rows, column]
            for row, array, check in zip(numbers, rows_read, wanted, strict=True):
                if field_check(name, key, row, array) != check:
                    raise damaged(self.path, f"window {row} of {name}.{key}")
        return rows_read

    def check_rows(self, rows: int) -> None:
        """Check the first rows of all components, which a run goes on after."""
        for name, group in self._groups.items():
            if self.has_checks and group.attrs[CHECK] != component_check(group):
                raise damaged(self.path, f"the head of {name}")
            if not self.has_checks or len(group["times"]) < rows:
                continue  # too few are told of by who goes on
            wanted = group[ROW_CHECKS][:rows]
            for row, column, check in _checks(group, name, rows):
                if check != wanted[row, column]:
                    key = ["", *group["fields"]][column]
                    part = f"{name}.{key}" if key else f"the time of {name}"
                    raise damaged(self.path, f"window {row} of {part}")


def _tell(path: object) -> None:
    """Say once that changes of a recording could not be noticed."""
    if str(path) not in _told:
        _told.add(str(path))
        print(
            f"quintet: recording {path} has no checksums: an earlier version wrote it, and bytes "
            "that were changed since are not noticed.",
            file=sys.stderr,
            flush=True,
        )
