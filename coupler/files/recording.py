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

from quintet.coupler.files.disk import told
from quintet.coupler.files.hdf5 import OF_DATASET, OF_FILE, create, room
from quintet.coupler.files.run_files import RECORDING as NAME
from quintet.interfaces.component import Array, Fields, Port
from quintet.interfaces.errors import PortError, SceneError
from quintet.interfaces.params import unknown
from quintet.interfaces.ports import from_json, to_json

BATCH = 64  # rows written at once, at most; a power of two
BATCH_BYTES = 8 << 20  # of all fields of a component together
CHUNK_BYTES = 1 << 20
MARKS = {"times": "f8", "ticks": "i8", "stable_steps": "f8"}  # of every row; as in `Instant`
# Measured on noisy doubles: 200 MB/s and 0.97 of the size, against 60 MB/s and 0.89 of gzip 1,
# and 1.3 GB/s unpacked. Forces of which four in five are zero shrink to 0.43.
PACKED = {"shuffle": True, "compression": "lzf"}


class Instant(NamedTuple):
    """When a row was made: the end of a window, or the start of the run."""

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
        self._file = create(path)
        self._tracks: dict[str, _Track] = {}
        with room(self._file, OF_FILE + len(scene.encode())):
            self._file.attrs["run"] = run
            self._file.attrs["tick"] = tick  # s, in which the rows' times are counted
            self._file["scene"] = scene  # a dataset, as an attribute ends at 64 KiB
            self._file.create_group("components", track_order=True)

    @classmethod
    def resume(cls, path: Path, rows: int) -> "Recorder":
        """Go on with a recording after its first rows; later ones are forgotten."""
        made = cls.__new__(cls)
        made._tracks = {}
        try:
            made._file = h5py.File(path, "r+", locking=False)
            groups = dict(made._file["components"].items())
        except (OSError, KeyError) as error:
            raise SceneError(
                f"recording {path}: it is not whole ({error}), and the run cannot go on with it. "
                "Run the scene again."
            ) from error
        for name, group in groups.items():
            ports = from_json(str(group.attrs["ports"]))
            made._tracks[name] = _Track(group, name, ports)
        tracks = made._tracks.values()
        with room(made._file, sum(track.largest() for track in tracks)):
            for track in tracks:
                track.go_on(rows)
        return made

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
        with told(Path(self._file.filename)):
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
        self.shapes = {f"{port.name}.{f.name}": f.shape for port in ports for f in port.fields}
        for key, dtype in MARKS.items():
            if key not in group:
                group.create_dataset(key, (0,), dtype, maxshape=(None,), chunks=(1024,))
        self.times = group["times"]
        self.data: dict[str, h5py.Dataset] = dict(group["fields"].items())
        self.batch_rows: dict[str, Array] = {}  # (batch, n, *shape)
        self.batch_marks = {key: np.zeros(BATCH, dtype) for key, dtype in MARKS.items()}
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
        for key, array in fields.items():
            into = self.batch_rows[key]
            if array.shape != into.shape[1:]:
                raise PortError(
                    f"recording of {self.name}: {key} must keep its shape {into.shape[1:]}; found "
                    f"{array.shape}. The number of items of a port must not change."
                )
            into[place] = array
        for marks, mark in zip(self.batch_marks.values(), instant, strict=True):
            marks[place] = mark
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
        for key in MARKS:
            self.group[key].resize(rows, axis=0)
        self.rows = self.written = rows

    def largest(self) -> int:
        """Bytes that the rows which are kept back may need on the disk, with what they extend."""
        rows = self.rows - self.written
        size = sum((8 * rows + 1024 * 8 + OF_DATASET) for _ in MARKS)
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


def _rows_within(limit: int, row: int) -> int:
    """Power of two, at most BATCH, of rows of so many bytes that fit a limit."""
    rows = BATCH
    while rows > 1 and rows * row > limit:
        rows //= 2
    return rows


class Recording(_Closed):
    """Read a recording; `path` is the file, or the folder of its run."""

    def __init__(self, path: Path | str) -> None:
        path = Path(path)
        self.path = path / NAME if path.is_dir() else path
        if not self.path.is_file():
            raise SceneError(f"recording {self.path}: there is no such file. Run the scene first.")
        try:
            self._file = h5py.File(self.path, "r", locking=False)
            self.run = str(self._file.attrs["run"])
            self.scene = self._file["scene"].asstr()[()]
            self._groups = dict(self._file["components"].items())
        except (OSError, KeyError) as error:
            raise SceneError(
                f"recording {self.path}: it is not a whole recording of quintet ({error}). "
                "Run the scene again."
            ) from error
        self._data = {name: dict(group["fields"].items()) for name, group in self._groups.items()}

    @property
    def names(self) -> tuple[str, ...]:
        """The components, in the order in which they were announced."""
        return tuple(self._groups)

    def ports(self, name: str) -> tuple[Port, ...]:
        """Return the ports that a component gives."""
        return from_json(str(self._group(name).attrs["ports"]))

    def static(self, name: str) -> dict[str, Array]:
        """Return what a component described once."""
        group = self._group(name)
        return {key: data[()] for key, data in group.get("static", {}).items()}

    def times(self, name: str) -> Array:
        """Return the times (rows,) s of a component's rows."""
        return np.asarray(self._group(name)["times"])

    @property
    def tick(self) -> float:
        """Unit [s] in which `ticks` count."""
        return float(self._file.attrs["tick"])

    def ticks(self, name: str) -> Array:
        """Return the times (rows,) of a component's rows, int, in ticks."""
        return np.asarray(self._group(name)["ticks"])

    def fields(self, name: str) -> tuple[str, ...]:
        """Return the names of the fields that were recorded."""
        self._group(name)
        return tuple(self._data[name])

    def items(self, name: str, field: str) -> tuple[int, ...]:
        """Return the shape (n, *shape) of every row of a field."""
        return tuple(self._dataset(name, field).shape[1:])

    def field(self, name: str, field: str, rows: slice = slice(None)) -> Array:
        """Return a whole field (rows, n, *shape), or some of its rows."""
        return np.asarray(self._dataset(name, field)[rows])

    def history(self, name: str, field: str, item: int) -> Array:
        """Return one item of a field over all rows, (rows, *shape)."""
        count = self.items(name, field)[0]
        if not 0 <= item < count:
            raise SceneError(
                f"recording {self.path}: {name}.{field} has {count} items; there is no item {item}."
            )
        return np.asarray(self._dataset(name, field)[:, item])

    def row(self, name: str, k: int) -> dict[str, Array]:
        """Return all fields of a component at row `k`."""
        count = len(self._group(name)["times"])
        if not 0 <= k < count:
            raise SceneError(
                f"recording {self.path}: {name} has {count} rows; there is no row {k}. "
                "The run that it came from was shorter."
            )
        return {key: np.asarray(data[k]) for key, data in self._data[name].items()}

    def close(self) -> None:
        """End reading."""
        self._file.close()

    def _group(self, name: str) -> Any:
        return self._found(self._groups, name, name)

    def _dataset(self, name: str, field: str) -> Any:
        self._group(name)
        return self._found(self._data[name], field, f"{name}.{field}")

    def _found(self, among: dict[str, Any], name: str, place: str) -> Any:
        if name not in among:
            raise SceneError(unknown(f"recording {self.path}: {place}", name, among))
        return among[name]
