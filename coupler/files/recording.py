"""The recording: all that crossed the links, window by window, in one HDF5 file.

Row 0 of a field is the output at the start; row k is its value at the end of window k, or,
for an impulse, its integral over that window. Nothing in the file is pickled.
"""

import math
import os
from abc import ABC, abstractmethod
from pathlib import Path
from typing import Any, NamedTuple, Self

import h5py
import numpy as np

from quintet.coupler.files.disk import number_of, reporting_disk
from quintet.coupler.files.hdf5 import OF_DATASET, OF_FILE, PACKED, bound_metadata, create, room
from quintet.coupler.files.run_files import RECORDING as NAME
from quintet.interfaces.component import Array, Fields, Port, fields_of
from quintet.interfaces.errors import DiskError, PortError, SceneError
from quintet.interfaces.params import unknown
from quintet.interfaces.ports import from_json, to_json
from quintet.interfaces.recordings import (
    MARKS,
    ROW_CHECKS,
    CheckedFile,
    damaged,
    field_check,
    marks_check,
    readable,
    seal,
    seal_rows,
)

BATCH = 64  # rows written at once, at most; a power of two
BATCH_BYTES = 8 << 20  # of all fields of a component together
CHUNK_BYTES = 1 << 20
CHECKED = 256  # rows of a chunk of checksums
# Rows are written once, in whole chunks. HDF5 would still keep up to 8 MiB of each data set.
CACHE_BYTES = 1 << 14


class Instant(NamedTuple):
    """When a row was made, as in `MARKS`: the end of a window, or the start of the run."""

    time: float  # s
    ticks: int  # the same, exactly
    stable: float = math.inf  # s, largest step that the component then allowed


class _Closed(ABC):
    """What a with statement closes."""

    @abstractmethod
    def close(self) -> None:
        """End using the file; a second call does nothing."""

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


class Recorder(_Closed):
    """Write a recording; rows are collected back and written in batches."""

    def __init__(self, path: Path | str, run: str, scene: str, tick: float = 1.0) -> None:
        self._file = create(path, CACHE_BYTES)
        self._tracks: dict[str, _Track] = {}
        with room(self._file, OF_FILE + len(scene.encode())):
            self._file.attrs["run"] = run
            self._file.attrs["tick"] = tick  # s, in which the rows' times are counted
            self._file["scene"] = scene  # a dataset, as an attribute ends at 64 KiB
            self._file.create_group("components", track_order=True)

    @classmethod
    def resume(cls, path: Path, rows: int) -> "Recorder":
        """Go on with a recording after its first rows; later ones are forgotten."""
        recorder = cls.__new__(cls)
        recorder._tracks = {}
        with readable(path):
            with h5py.File(path, "r", locking=False) as file:
                CheckedFile(file, path).check_rows(rows)
            recorder._file = h5py.File(path, "r+", locking=False, rdcc_nbytes=CACHE_BYTES)
            for name, group in recorder._file["components"].items():
                ports = from_json(str(group.attrs["ports"]))
                recorder._tracks[name] = _Track(group, name, ports)
        tracks = recorder._tracks.values()
        try:
            with room(recorder._file, sum(track.largest() for track in tracks)):
                for track in tracks:
                    track.go_on(rows)
                bound_metadata(recorder._file)
        except DiskError as error:
            if number_of(error.__cause__) is not None:
                raise
            raise damaged(path, "what HDF5 knows of a data set") from error
        return recorder

    def component(self, name: str, ports: tuple[Port, ...], static: Fields) -> None:
        """Announce a component: the ports it gives, and what it described once."""
        size = sum(OF_DATASET + np.asarray(array).nbytes for array in static.values())
        with room(self._file, size + OF_FILE):
            group = self._file["components"].create_group(name)
            group.attrs["ports"] = to_json(ports)
            group.create_group("fields", track_order=True)
            for key, array in static.items():
                group[f"static/{key}"] = np.asarray(array)
            self._tracks[name] = _Track(group, name, ports)
            seal(group)

    def add(self, name: str, instant: Instant, fields: Fields) -> None:
        """Add the outputs of one component.

        Parameters
        ----------
        name : str
        instant : Instant
            The end of the window; the first row is the start of the run.
        fields : mapping of (n, *shape) arrays
            Impulses integrated over the window. Names and n stay those of the first row.
        """
        track = self._tracks[name]
        if not track.rows:
            track.check(fields)
            with room(self._file, OF_DATASET * len(fields)):
                track.begin(fields)
                bound_metadata(self._file)
        track.add(instant, fields)
        # Whole batches begin at multiples of a chunk, so that no chunk is packed twice.
        if track.rows % track.batch == 0:
            self._write(track)

    def _write(self, *tracks: "_Track") -> None:
        with room(self._file, sum(track.largest() for track in tracks)):
            for track in tracks:
                track.write()

    def flush(self) -> None:
        """Write out all rows, so that the file is whole on disk."""
        self._write(*self._tracks.values())

    def sync(self) -> None:
        """Write out all rows, and bring them from memory to the disk."""
        self.flush()
        with reporting_disk(Path(self._file.filename)):
            os.fsync(self._file.id.get_vfd_handle())

    def close(self) -> None:
        """Write out all rows and end the file; a second call does nothing."""
        if self._file:
            self.flush()
            self._file.close()


class _Track:
    """The rows of one component."""

    def __init__(self, group: h5py.Group, name: str, ports: tuple[Port, ...]) -> None:
        self.group, self.name = group, name
        self.shapes = {key: field.shape for key, field in fields_of(ports).items()}
        for key, dtype in MARKS.items():
            if key not in group:
                group.create_dataset(key, (0,), dtype, maxshape=(None,), chunks=(1024,))
        self.times = group["times"]
        self.data: dict[str, h5py.Dataset] = dict(group["fields"].items())
        self.batch_rows: dict[str, Array] = {}  # (batch, n, *shape)
        self.batch_marks = {key: np.zeros(BATCH, dtype) for key, dtype in MARKS.items()}
        self.batch_checks = np.zeros((0, 0), "u4")  # (batch, 1 + fields)
        self.batch = BATCH
        self.rows = 0  # taken
        self.written = 0

    def add(self, instant: Instant, fields: Fields) -> None:
        if fields.keys() != self.batch_rows.keys():
            raise PortError(
                f"recording of {self.name}: row {self.rows} must have the fields of the first, "
                f"{', '.join(self.batch_rows)}; found {', '.join(fields)}. Correct give()."
            )
        place = self.rows - self.written
        checks = self.batch_checks[place]
        for column, (key, into) in enumerate(self.batch_rows.items(), 1):
            array = fields[key]
            if array.shape != into.shape[1:]:
                raise PortError(
                    f"recording of {self.name}: {key} must keep its shape {into.shape[1:]}; found "
                    f"{array.shape}. The number of items of a port must not change."
                )
            into[place] = array
            checks[column] = field_check(self.name, key, self.rows, into[place])
        for marks, mark in zip(self.batch_marks.values(), instant, strict=True):
            marks[place] = mark
        checks[0] = marks_check(self.name, self.rows, instant)
        self.rows += 1

    def go_on(self, rows: int) -> None:
        """Keep the first rows of a file that was there."""
        if len(self.times) < rows:
            raise SceneError(
                f"recording of {self.name}: it must have {rows} rows to go on; found "
                f"{len(self.times)}. Run the scene again."
            )
        row = sum(8 * int(np.prod(data.shape[1:])) for data in self.data.values())
        self.batch = _rows_within(BATCH_BYTES, row)
        for key, dataset in self.data.items():
            dataset.resize(rows, axis=0)
            self.batch_rows[key] = np.zeros((self.batch, *dataset.shape[1:]))
        if ROW_CHECKS not in self.group:
            seal_rows(self.group, self.name, rows)
        for key in (*MARKS, ROW_CHECKS):
            self.group[key].resize(rows, axis=0)
        seal(self.group)
        self.batch_checks = np.zeros((self.batch, 1 + len(self.data)), "u4")
        self.rows = self.written = rows

    def largest(self) -> int:
        """Bytes that the rows which are kept back may need on the disk, with what they extend."""
        rows = self.rows - self.written
        size = sum((8 * rows + 1024 * 8 + OF_DATASET) for _ in MARKS)
        size += (rows + CHECKED) * 4 * (1 + len(self.data)) + OF_DATASET
        for data in self.data.values():
            row = 8 * int(np.prod(data.shape[1:]))
            size += (rows + data.chunks[0]) * row + OF_DATASET
        return size

    def write(self) -> None:
        """Append the collected rows; the times last, as they say how many rows there are."""
        count = self.rows - self.written
        if not count:
            return
        for key, dataset in self.data.items():
            dataset.resize(self.rows, axis=0)
            dataset[self.written :] = self.batch_rows[key][:count]
        self.group[ROW_CHECKS].resize(self.rows, axis=0)
        self.group[ROW_CHECKS][self.written :] = self.batch_checks[:count]
        for key, marks in reversed(self.batch_marks.items()):
            self.group[key].resize(self.rows, axis=0)
            self.group[key][self.written :] = marks[:count]
        self.written = self.rows

    def check(self, fields: Fields) -> None:
        """Refuse a first row that does not have the fields of the ports."""
        for key, array in fields.items():
            if key not in self.shapes:
                raise PortError(unknown(f"recording of {self.name}: {key}", key, self.shapes))
            if array.shape[1:] != self.shapes[key]:
                raise PortError(
                    f"recording of {self.name}: {key} must have shape (n, *{self.shapes[key]}); "
                    f"found {array.shape}. Correct give(), or the port."
                )

    def begin(self, fields: Fields) -> None:
        """Lay out a data set for every field of the first row."""
        self.batch = _rows_within(BATCH_BYTES, sum(8 * array.size for array in fields.values()))
        for key, array in fields.items():
            rows = min(self.batch, _rows_within(CHUNK_BYTES, 8 * array.size))
            self.batch_rows[key] = np.zeros((self.batch, *array.shape))
            self.data[key] = self.group["fields"].create_dataset(
                key,
                (0, *array.shape),
                "f8",
                maxshape=(None, *(n or None for n in array.shape)),  # an axis may not end at 0
                chunks=(rows, *(max(1, n) for n in array.shape)),
                **PACKED,
            )
        columns = 1 + len(fields)
        self.batch_checks = np.zeros((self.batch, columns), "u4")
        self.group.create_dataset(
            ROW_CHECKS, (0, columns), "u4", maxshape=(None, columns), chunks=(CHECKED, columns)
        )
        seal(self.group)


def _rows_within(limit: int, row: int) -> int:
    """Power of two, at most BATCH, of rows of so many bytes that fit a limit."""
    rows = BATCH
    while rows > 1 and rows * row > limit:
        rows //= 2
    return rows


class Recording(_Closed):
    """Read a recording; `path` is the file, or the folder of its run.

    Rows are checked against their checksums when they are read.
    """

    def __init__(self, path: Path | str) -> None:
        self.path = Path(path) / NAME if Path(path).is_dir() else Path(path)
        if not self.path.is_file():
            raise SceneError(f"recording {self.path}: there is no such file. Run the scene first.")
        self._file: Any = None
        try:
            with readable(self.path):
                self._file = h5py.File(self.path, "r", locking=False)
                self.run = str(self._file.attrs["run"])
                self.scene = self._file["scene"].asstr()[()]
                self._tick = float(self._file.attrs["tick"])
                self._checked = CheckedFile(self._file, self.path)
                self._names = tuple(self._file["components"])
                groups = {name: self._checked.component(name) for name in self._names}
                self._ports = {
                    name: from_json(str(group.attrs["ports"])) for name, group in groups.items()
                }
                self._data = {name: dict(group["fields"]) for name, group in groups.items()}
        except SceneError:
            self.close()
            raise

    @property
    def names(self) -> tuple[str, ...]:
        """The components, in the order in which they were announced."""
        return self._names

    def ports(self, name: str) -> tuple[Port, ...]:
        """Return the ports that a component gives."""
        self._require(name)
        return self._ports[name]

    def static(self, name: str) -> dict[str, Array]:
        """Return what a component described once."""
        self._require(name)
        with readable(self.path):
            group = self._checked.component(name)
            return {key: data[()] for key, data in group.get("static", {}).items()}

    def times(self, name: str) -> Array:
        """Return the times (rows,) s of a component's rows."""
        return self.marks(name)["times"]

    @property
    def tick(self) -> float:
        """Unit [s] in which `ticks` count."""
        return self._tick

    def ticks(self, name: str) -> Array:
        """Return the times (rows,) of a component's rows, int, in ticks."""
        return self.marks(name)["ticks"]

    def fields(self, name: str) -> tuple[str, ...]:
        """Return the names of the fields that were recorded."""
        self._require(name)
        return tuple(self._data[name])

    def items(self, name: str, field: str) -> tuple[int, ...]:
        """Return the shape (n, *shape) of every row of a field."""
        self._require(name, field)
        return tuple(self._data[name][field].shape[1:])

    def field(self, name: str, field: str, rows: slice = slice(None)) -> Array:
        """Return a whole field (rows, n, *shape), or some of its rows."""
        self._require(name, field)
        with readable(self.path):
            return self._checked.field(name, field, rows)

    def history(self, name: str, field: str, item: int) -> Array:
        """Return one item of a field over all rows, (rows, *shape)."""
        count = self.items(name, field)[0]
        if not 0 <= item < count:
            raise SceneError(
                f"recording {self.path}: {name}.{field} has {count} items; there is no item {item}."
            )
        rows, size = len(self._data[name][field]), self._data[name][field].chunks[0]
        # Whole rows are read, for checksums are theirs; a chunk at a time, to save memory.
        parts = [
            self.field(name, field, slice(first, first + size))[:, item]
            for first in range(0, max(rows, 1), size)
        ]
        return np.concatenate(parts)

    def row(self, name: str, k: int) -> dict[str, Array]:
        """Return all fields of a component at row `k`."""
        count = len(self.times(name))
        if not 0 <= k < count:
            raise SceneError(
                f"recording {self.path}: {name} has {count} rows; there is no row {k}. "
                "The run that it came from was shorter."
            )
        return {key: self.field(name, key, slice(k, k + 1))[0] for key in self._data[name]}

    def close(self) -> None:
        """End reading."""
        if self._file:
            self._file.close()

    def marks(self, name: str) -> dict[str, Array]:
        """Return time [s], ticks and stable step [s] of a component's rows, each (rows,)."""
        self._require(name)
        with readable(self.path):
            return self._checked.marks(name)

    def _require(self, name: str, field: str | None = None) -> None:
        """Refuse the name of a component, or of a field, that is not there."""
        place = f"recording {self.path}: {name}"
        if name not in self._data:
            raise SceneError(unknown(place, name, self._data))
        if field is not None and field not in self._data[name]:
            raise SceneError(unknown(f"{place}.{field}", field, self._data[name]))
