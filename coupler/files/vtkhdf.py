"""VTKHDF files: views of a component over time, as temporal PolyData for ParaView.

The layout is VTKHDF 2.0. What does not change from step to step is stored once and pointed
to by every step, so that an append extends only the points, their fields and the times. Points of
no polygon are vertices. Every dataset has its unit as an attribute, and the field data lists
them, for ParaView shows no attributes.
"""

from collections.abc import Mapping
from pathlib import Path

import h5py
import numpy as np

from quintet.coupler.files.disk import PART, removed_on_failure
from quintet.coupler.files.hdf5 import bound_metadata, create, room
from quintet.coupler.files.vtkhdf_reader import SCENE, UNITS, read_step, scene, times, units
from quintet.interfaces.component import Array
from quintet.interfaces.errors import PortError, SceneError
from quintet.interfaces.ports import RANK
from quintet.interfaces.recordings import checksum

BLOCK = 1024  # entries by which the small tables grow; readers take the first NSteps
CHUNK = 1 << 16  # points in the largest chunk
TABLES = 1 << 19  # bytes of all small tables, a block of each
TOPOLOGIES = ("Vertices", "Lines", "Polygons", "Strips")
NOTHING: Mapping[str, str] = {}
Topology = tuple[Array, Array]  # corners of all cells, where each begins


class VtkHdf:
    """Write the views of a component, one step at a time.

    The file is whole after every append, even if the process is killed, and may be read
    while it grows.

    Parameters
    ----------
    path : Path
    units : mapping of str
        Units of the fields, by their names, in the order of the view.
    scene : str
        What runs.
    """

    def __init__(
        self, path: Path | str, units: Mapping[str, str] = NOTHING, scene: str = ""
    ) -> None:
        self._file = create(path)
        with room(self._file, TABLES):
            self._root = self._file.create_group("VTKHDF")
            self._root.attrs["Version"] = np.array([2, 0])
            self._root.attrs.create("Type", b"PolyData", dtype=h5py.string_dtype("ascii", 8))
            self._tables = self._root.create_group("Steps")
            self._tables.attrs["NSteps"] = np.int64(0)
            self._values = _table(self._tables, "Values", dtype="f8")
        self._units, self._scene = {"points": "m", **units}, scene
        self._data: dict[str, h5py.Dataset] = {}  # "points" and the fields over points
        self._cell_data: dict[str, h5py.Dataset] = {}
        self._told: list[h5py.Dataset] = []  # where each step finds the texts
        self._parts: dict[int, int] = {}  # number of points -> entry of the table of counts
        self.check = 0  # checksum of all that was appended
        self._steps = 0
        self._rows = 0  # points written so far
        self._corners = 0  # points that the cells need
        self._cells = 0  # polygons
        self._loose = 0  # points of no polygon
        self._is_cloud = True  # no cells: every point is drawn

    def append(self, time: float, view: Mapping[str, Array]) -> None:
        """Append the view of a component at a time.

        Parameters
        ----------
        time : float, s
        view : mapping of arrays
            ``points`` (n, 3) m; optional ``cells`` (m, 3 or more), numbers of corner points, -1
            after the last corner, taken from the first step; all others are fields with n rows,
            or, if these are other numbers, m. The names must not change, but for ``rank``, which
            a run may begin or cease to have when it is resumed; n may change.
        """
        arrays = {k: np.asarray(v, np.float32) for k, v in view.items() if k != "cells"}
        cells = np.asarray(view.get("cells", ()))
        with room(self._file, _largest(arrays) + 2 * cells.nbytes):
            if not self._data:
                self._begin(arrays, view.get("cells"))
                bound_metadata(self._file)
            _require_points({k: array for k, array in arrays.items() if k not in self._cell_data})
            arrays = self._with_ranks(arrays)
            self._require_same(arrays)
            self._append(time, arrays)

    def _append(self, time: float, arrays: dict[str, Array]) -> None:
        count = len(arrays["points"])
        parts = (part for key in sorted(arrays) for part in (key.encode(), arrays[key]))
        self.check = checksum(f"{self.check} {time!r}", *parts)
        for key, dataset in self._data.items():
            dataset.resize(self._rows + count, axis=0)
            dataset[self._rows :] = arrays[key].reshape(count, *dataset.shape[1:])
        for key, dataset in self._cell_data.items():
            self._append_cells(key, dataset, arrays[key])
        self._add_step(time, count)
        self._rows += count

    def _with_ranks(self, arrays: dict[str, Array]) -> dict[str, Array]:
        """Add or drop the rank of each point, as the first step has it; one rank is number 0."""
        if (RANK.name in arrays) == (RANK.name in self._data):
            return arrays
        if RANK.name in self._data:
            return {**arrays, RANK.name: np.zeros(len(arrays["points"]), np.float32)}
        return {key: array for key, array in arrays.items() if key != RANK.name}

    def _append_cells(self, key: str, dataset: h5py.Dataset, array: Array) -> None:
        """Append a field over the polygons; vertices, which come before them, have no value."""
        first = len(dataset)
        dataset.resize(first + self._loose + self._cells, axis=0)
        dataset[first : first + self._loose] = np.nan
        dataset[first + self._loose :] = array.reshape(self._cells, *dataset.shape[1:])
        self._put(self._tables[f"CellDataOffsets/{key}"], self._steps, first)

    def close(self) -> None:
        """Close the file; a second call does nothing."""
        self._file.close()

    def _begin(self, arrays: dict[str, Array], cells: Array | None) -> None:
        count, polygons = len(arrays.get("points", ())), 0 if cells is None else len(cells)
        over_cells = {k for k, v in arrays.items() if v.ndim and len(v) == polygons != count}
        _require_points({k: array for k, array in arrays.items() if k not in over_cells})
        fields = self._root.create_group("PointData")
        for key, array in arrays.items():
            if key not in over_cells:
                group, name = (self._root, "Points") if key == "points" else (fields, key)
                self._data[key] = self._field(group, name, array, self._units.get(key, ""))
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
        for key in over_cells:
            group = self._root.require_group("CellData")
            self._cell_data[key] = self._field(group, key, arrays[key], self._units.get(key, ""))
            _table(self._tables.require_group("CellDataOffsets"), key)
        self._begin_topologies(cells, count)
        self._values.attrs["units"] = "s"
        known = {key: unit for key, unit in self._units.items() if key in arrays}
        self._tell(UNITS, "; ".join(f"{key} {unit}" for key, unit in known.items()))
        self._tell(SCENE, self._scene)

    def _field(self, group: h5py.Group, name: str, array: Array, unit: str) -> h5py.Dataset:
        item = array.shape[1:] if array.ndim < 3 else (int(np.prod(array.shape[1:])),)
        dataset = _table(group, name, item, "f4", min(max(len(array), 256), CHUNK))
        if unit:
            dataset.attrs["units"] = unit
        return dataset

    def _tell(self, name: str, text: str) -> None:
        """Write a text that holds at all steps: one value at the same place of each."""
        group = self._root.require_group("FieldData")
        # VTK reads no other type of text; what is not ASCII passes as it stands.
        group.create_dataset(name, data=[text.encode()], dtype=h5py.string_dtype("ascii"))
        for key, item, fill in (("FieldDataOffsets", (), 0), ("FieldDataSizes", (2,), 1)):
            self._told.append(_table(self._tables.require_group(key), name, item, fill=fill))

    def _begin_topologies(self, cells: Array | None, count: int) -> None:
        counts = _table(self._root, "NumberOfPoints")
        drawn = ("Vertices",) if cells is None else ("Vertices", "Polygons")
        for name in TOPOLOGIES:
            group = self._root.create_group(name)
            _table(group, "Connectivity", chunk=4096)
            _table(group, "Offsets", chunk=4096).resize(1, axis=0)
            if name == "Vertices" and cells is None:  # as many as there are points
                group["NumberOfCells"] = group["NumberOfConnectivityIds"] = counts
            elif name not in drawn:
                _table(group, "NumberOfCells")
                group["NumberOfConnectivityIds"] = group["NumberOfCells"]
        if cells is not None:
            whole = np.asarray(cells, np.int64)
            loose = np.setdiff1d(np.arange(count), whole)
            self._is_cloud, self._cells, self._loose = False, len(whole), len(loose)
            self._add_cells("Polygons", whole)
            self._add_cells("Vertices", loose[:, None])

    def _add_cells(self, topology: str, cells: Array) -> None:
        connectivity, offsets = _flat(cells)
        self.check = checksum(f"{self.check} {topology}", connectivity, offsets)
        group = self._root[topology]
        _extend(group["Connectivity"], connectivity, 0)
        _extend(group["Offsets"], offsets, 0)
        _table(group, "NumberOfCells", fill=len(cells))
        _table(group, "NumberOfConnectivityIds", fill=len(connectivity))
        self._corners = max(self._corners, int(cells.max(initial=-1)) + 1)

    def _require_same(self, arrays: dict[str, Array]) -> None:
        data = self._data | self._cell_data
        if arrays.keys() != data.keys():
            wrong = sorted(arrays.keys() ^ data.keys())[0]
            raise PortError(
                f"view of step {self._steps}: its names must stay those of the first step; "
                f"{wrong} {'appeared' if wrong in arrays else 'is missing'}. Correct view()."
            )
        for key, array in arrays.items():
            rows = self._cells if key in self._cell_data else len(array)
            size = np.prod(data[key].shape[1:], dtype=int)
            if len(array) != rows or (array[:1].size and array[0].size != size):
                raise PortError(
                    f"view of step {self._steps}: {key} must keep the shape of its items; found "
                    f"{array.shape} after {data[key].shape[1:]}. Correct view()."
                )
        if len(arrays["points"]) < self._corners:
            raise PortError(
                f"view of step {self._steps}: cells use {self._corners} points; found "
                f"{len(arrays['points'])}. Cells must not change while points vanish."
            )

    def _add_step(self, time: float, count: int) -> None:
        is_new = count not in self._parts
        part = self._parts.setdefault(count, len(self._parts))
        if is_new:  # exact: of a file with one step VTK takes each entry for a piece of its own
            self._root["NumberOfPoints"].resize(part + 1, axis=0)
            self._root["NumberOfPoints"][part] = count
            for name in TOPOLOGIES:
                for table in ("NumberOfCells", "NumberOfConnectivityIds"):
                    self._root[name][table].resize(part + 1, axis=0)
            if self._is_cloud:
                self._reserve_vertices(count)
        for name, value in (("PartOffsets", part), ("PointOffsets", self._rows)):
            self._put(self._tables[name], self._steps, value)
        constant = ("NumberOfParts", "CellOffsets", "ConnectivityIdOffsets")
        for table in (*(self._tables[name] for name in constant), *self._told):
            _reserve(table, self._steps)
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


def resume(path: Path, time: float, check: int | None = None) -> VtkHdf:
    """Continue a file after its steps up to a time [s]; later steps are dropped.

    `check` is the checksum of what these steps must hold, where that is known.
    """
    part = path.with_name(path.name + PART)
    with removed_on_failure(part):
        file = VtkHdf(part, units(path), scene(path))
        for k, when in enumerate(times(path)):
            if when <= time:
                file.append(*read_step(path, k))
        if check is not None and file.check != check:
            file.close()
            raise SceneError(
                f"view file {path}: its steps up to {time:g} s must be as the run wrote them; they "
                "were changed or cut. Copy the file again from where it was made, or run the scene "
                "again."
            )
        part.replace(path)
    return file


def _largest(arrays: dict[str, Array]) -> int:
    """Bytes that a step may need on the disk: its points and fields, chunks begun, vertices."""
    rows = max((len(array) for array in arrays.values() if array.ndim), default=0)
    widths = sum(4 * max(1, array.size // max(1, rows)) for array in arrays.values())
    chunks = min(max(rows, 256), CHUNK) * widths
    return 2 * sum(array.nbytes for array in arrays.values()) + chunks + 24 * rows + TABLES


def _require_points(arrays: dict[str, Array]) -> None:
    points = arrays.get("points")
    if points is None or points.ndim != 2 or points.shape[1] != 3:
        shape = "nothing" if points is None else f"shape {points.shape}"
        raise PortError(f"a view must have points of shape (n, 3); found {shape}. Correct view().")
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
