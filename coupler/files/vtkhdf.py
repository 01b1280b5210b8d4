"""VTKHDF files: views of a component over time, as temporal PolyData for ParaView.

The layout is VTKHDF 2.0. What does not change from step to step is stored once and pointed
to by every step, so that an append extends only the points, their fields and the times.
"""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from quintet.coupler.files.disk import PART, removed_on_failure
from quintet.coupler.files.hdf5 import create, room
from quintet.interfaces.component import Array
from quintet.interfaces.errors import PortError, SceneError

BLOCK = 1024  # entries by which the small tables grow; readers take the first NSteps
CHUNK = 1 << 16  # points in the largest chunk
TABLES = 1 << 19  # bytes of all small tables, a block of each
TOPOLOGIES = ("Vertices", "Lines", "Polygons", "Strips")
Topology = tuple[Array, Array]  # corners of all cells, where each begins


class VtkHdf:
    """Write the views of a component, one step at a time.

    The file is whole after every append, even if the process is killed, and may be read
    while it grows.
    """

    def __init__(self, path: Path | str) -> None:
        self._file = create(path)
        with room(self._file, TABLES):
            self._root = self._file.create_group("VTKHDF")
            self._root.attrs["Version"] = np.array([2, 0])
            self._root.attrs.create("Type", b"PolyData", dtype=h5py.string_dtype("ascii", 8))
            self._tables = self._root.create_group("Steps")
            self._tables.attrs["NSteps"] = np.int64(0)
            self._values = _table(self._tables, "Values", dtype="f8")
        self._data: dict[str, h5py.Dataset] = {}  # "points" and the fields
        self._parts: dict[int, int] = {}  # number of points -> entry of the table of counts
        self._steps = 0
        self._rows = 0  # points written so far
        self._corners = 0  # points that the cells need
        self._is_cloud = True  # no cells: every point is drawn

    def append(self, time: float, view: Mapping[str, Array]) -> None:
        """Append the view of a component at a time.

        Parameters
        ----------
        time : float, s
        view : mapping of arrays
            ``points`` (n, 3) m; optional ``cells`` (m, 3 or 4), numbers of corner points, -1
            ends a triangle, taken from the first step; all others are fields (n,) or (n, k).
            The names must not change; n may.
        """
        arrays = {k: np.asarray(v, np.float32) for k, v in view.items() if k != "cells"}
        _require_points(arrays)
        count, cells = len(arrays["points"]), np.asarray(view.get("cells", ()))
        with room(self._file, _largest(arrays) + 2 * cells.nbytes):
            if not self._data:
                self._begin(arrays, view.get("cells"))
            self._require_same(arrays)
            self._append(time, count, arrays)

    def _append(self, time: float, count: int, arrays: dict[str, Array]) -> None:
        for key, dataset in self._data.items():
            dataset.resize(self._rows + count, axis=0)
            dataset[self._rows :] = arrays[key].reshape(count, *dataset.shape[1:])
        self._add_step(time, count)
        self._rows += count

    def close(self) -> None:
        """Close the file; a second call does nothing."""
        self._file.close()

    def _begin(self, arrays: dict[str, Array], cells: Array | None) -> None:
        count = len(arrays["points"])
        fields = self._root.create_group("PointData")
        for key, array in arrays.items():
            group, name = (self._root, "Points") if key == "points" else (fields, key)
            item = array.shape[1:] if array.ndim < 3 else (int(np.prod(array.shape[1:])),)
            self._data[key] = _table(group, name, item, "f4", min(max(count, 256), CHUNK))
        for name, item, fill in (
            ("PartOffsets", (), 0),
            ("PointOffsets", (), 0),
            ("NumberOfParts", (), 1),
            ("CellOffsets", (len(TOPOLOGIES),), 0),
            ("ConnectivityIdOffsets", (len(TOPOLOGIES),), 0),
        ):
            _table(self._tables, name, item, fill=fill)
        offsets = self._tables.create_group("PointDataOffsets")
        for key in fields:  # one and the same dataset, under the name of each field
            offsets[key] = self._tables["PointOffsets"]
        self._begin_topologies(cells)

    def _begin_topologies(self, cells: Array | None) -> None:
        counts = _table(self._root, "NumberOfPoints")
        drawn = "Vertices" if cells is None else "Polygons"
        for name in TOPOLOGIES:
            group = self._root.create_group(name)
            _table(group, "Connectivity", chunk=4096)
            _table(group, "Offsets", chunk=4096).resize(1, axis=0)
            if name == "Vertices" and cells is None:  # as many as there are points
                group["NumberOfCells"] = group["NumberOfConnectivityIds"] = counts
            elif name != drawn:
                _table(group, "NumberOfCells")
                group["NumberOfConnectivityIds"] = group["NumberOfCells"]
        if cells is not None:
            self._is_cloud = False
            self._add_polygons(np.asarray(cells, np.int64))

    def _add_polygons(self, cells: Array) -> None:
        connectivity, offsets = _flat(cells)
        group = self._root["Polygons"]
        _extend(group["Connectivity"], connectivity, 0)
        _extend(group["Offsets"], offsets, 0)
        _table(group, "NumberOfCells", fill=len(cells))
        _table(group, "NumberOfConnectivityIds", fill=len(connectivity))
        self._corners = int(cells.max(initial=-1)) + 1

    def _require_same(self, arrays: dict[str, Array]) -> None:
        if arrays.keys() != self._data.keys():
            wrong = sorted(arrays.keys() ^ self._data.keys())[0]
            raise PortError(
                f"view of step {self._steps}: its names must stay those of the first step; "
                f"{wrong} {'appeared' if wrong in arrays else 'is missing'}. Correct view()."
            )
        for key, array in arrays.items():
            if array[:1].size and array[0].size != np.prod(self._data[key].shape[1:], dtype=int):
                raise PortError(
                    f"view of step {self._steps}: {key} must keep the shape of its items; found "
                    f"{array.shape} after {self._data[key].shape[1:]}. Correct view()."
                )
        if len(arrays["points"]) < self._corners:
            raise PortError(
                f"view of step {self._steps}: cells use {self._corners} points; found "
                f"{len(arrays['points'])}. Cells must not change while points vanish."
            )

    def _add_step(self, time: float, count: int) -> None:
        is_new = count not in self._parts
        part = self._parts.setdefault(count, len(self._parts))
        if is_new:
            self._put(self._root["NumberOfPoints"], part, count)
            for name in TOPOLOGIES:
                for table in ("NumberOfCells", "NumberOfConnectivityIds"):
                    _reserve(self._root[name][table], part)
            if self._is_cloud:
                self._reserve_vertices(count)
        for name, value in (("PartOffsets", part), ("PointOffsets", self._rows)):
            self._put(self._tables[name], self._steps, value)
        for name in ("NumberOfParts", "CellOffsets", "ConnectivityIdOffsets"):
            _reserve(self._tables[name], self._steps)
        self._values.resize(self._steps + 1, axis=0)  # exact: readers size their list by it
        self._values[self._steps] = time
        self._steps += 1
        self._tables.attrs.modify("NSteps", np.int64(self._steps))

    def _put(self, dataset: h5py.Dataset, entry: int, value: int) -> None:
        _reserve(dataset, entry)
        dataset[entry] = value

    def _reserve_vertices(self, count: int) -> None:
        """Extend the vertices: vertex i is point i, in one list shared by all steps."""
        group = self._root["Vertices"]
        have = len(group["Connectivity"])
        if count > have:
            want = np.arange(have, count + count // 4)
            _extend(group["Connectivity"], want, have)
            _extend(group["Offsets"], want + 1, have + 1)


def resume(path: Path, time: float) -> VtkHdf:
    """Continue a file after its steps up to a time [s]; later steps are dropped."""
    part = path.with_name(path.name + PART)
    with removed_on_failure(part):
        made = VtkHdf(part)
        for k, when in enumerate(times(path)):
            if when <= time:
                made.append(*read_step(path, k))
        part.replace(path)
    return made


def _largest(arrays: dict[str, Array]) -> int:
    """Bytes that a step may need on the disk: its points and fields, chunks begun, vertices."""
    points = len(arrays["points"])
    chunks = min(max(points, 256), CHUNK) * sum(4 * max(1, a[:1].size) for a in arrays.values())
    return sum(array.nbytes for array in arrays.values()) + chunks + 24 * points + TABLES


def _require_points(arrays: dict[str, Array]) -> None:
    points = arrays.get("points")
    if points is None or points.ndim != 2 or points.shape[1] != 3:
        found = "nothing" if points is None else f"shape {points.shape}"
        raise PortError(f"a view must have points of shape (n, 3); found {found}. Correct view().")
    for key, array in arrays.items():
        if not array.ndim or len(array) != len(points):
            raise PortError(
                f"view field {key} must have one row for each of {len(points)} points; found "
                f"shape {array.shape}. Correct view()."
            )


def _table(
    group: h5py.Group,
    name: str,
    item: tuple[int, ...] = (),
    dtype: str = "i8",
    chunk: int = BLOCK,
    fill: int = 0,
) -> h5py.Dataset:
    return group.create_dataset(
        name, (0, *item), dtype, maxshape=(None, *item), chunks=(chunk, *item), fillvalue=fill
    )


def _reserve(dataset: h5py.Dataset, entry: int) -> None:
    if entry >= len(dataset):
        dataset.resize(entry + BLOCK, axis=0)


def _extend(dataset: h5py.Dataset, values: Array, start: int) -> None:
    dataset.resize(start + len(values), axis=0)
    dataset[start:] = values


def _flat(cells: Array) -> Topology:
    """Flatten cells to connectivity and offsets, without the -1 that end triangles."""
    used = cells >= 0
    return cells[used], np.concatenate([[0], np.cumsum(used.sum(axis=1))])


def _padded(connectivity: Array, offsets: Array) -> Array:
    """Inverse of `_flat`: cells padded with -1."""
    sizes = np.diff(offsets)
    used = np.arange(sizes.max(initial=3)) < sizes[:, None]
    cells = np.full(used.shape, -1, np.int64)
    cells[used] = connectivity
    return cells


def _open(path: Path | str) -> h5py.File:
    try:
        file = h5py.File(path, "r", locking=False)
    except OSError as error:
        raise SceneError(
            f"view file {path}: it must be a VTKHDF file; {error}. Run the scene again."
        ) from error
    if "VTKHDF/Steps" not in file:
        file.close()
        raise SceneError(f"view file {path}: it has no steps of VTKHDF. Run the scene again.")
    return file


def times(path: Path | str) -> Array:
    """Return the times (steps,) s of a file."""
    with _open(path) as file:
        return np.asarray(file["VTKHDF/Steps/Values"])


def read_step(path: Path | str, k: int) -> tuple[float, dict[str, Array]]:
    """Read step `k` of a file: its time [s], and its view in float32."""
    with _open(path) as file:
        root: Any = file["VTKHDF"]
        count = int(root["Steps"].attrs["NSteps"])
        if not 0 <= k < count:
            raise SceneError(f"view file {path}: it has {count} steps; there is no step {k}.")
        start = int(root["Steps/PointOffsets"][k])
        end = start + int(root["NumberOfPoints"][root["Steps/PartOffsets"][k]])
        view = {"points": root["Points"][start:end]}
        view |= {name: data[start:end] for name, data in root["PointData"].items()}
        polygons = root["Polygons"]
        if len(polygons["Connectivity"]):
            view["cells"] = _padded(polygons["Connectivity"][:], polygons["Offsets"][:])
        return float(root["Steps/Values"][k]), view
