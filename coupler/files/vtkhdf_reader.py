"""Reading of view files: the steps of a component's view, as they were appended."""

import contextlib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from quintet.interfaces.component import Array
from quintet.interfaces.errors import SceneError
from quintet.interfaces.recordings import UNREADABLE

UNITS, SCENE = "units", "scene"  # texts: "NAME UNIT; ..." of points and fields; what ran


def _padded(connectivity: Array, offsets: Array) -> Array:
    """Inverse of `_flat`: cells padded with -1."""
    sizes = np.diff(offsets)
    used = np.arange(sizes.max(initial=3)) < sizes[:, None]
    cells = np.full(used.shape, -1, np.int64)
    cells[used] = connectivity
    return cells


@contextlib.contextmanager
def _open(path: Path | str) -> Iterator[h5py.File]:
    """Open a view file, and turn errors of reading it into one sentence."""
    try:
        with h5py.File(path, "r", locking=False) as file:
            if "VTKHDF/Steps" not in file:
                raise SceneError(
                    f"view file {path}: it has no steps of VTKHDF. Run the scene again."
                )
            yield file
    except UNREADABLE as error:
        cause = " ".join(str(error).split())
        raise SceneError(
            f"view file {path}: it must be a VTKHDF file; {cause}. Run the scene again."
        ) from error


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
        for name, data in root.get("CellData", {}).items():
            count = len(view["cells"])
            first = int(root[f"Steps/CellDataOffsets/{name}"][k]) + _loose(root)
            view[name] = data[first : first + count]
        return float(root["Steps/Values"][k]), view


def _loose(root: Any) -> int:
    """Points of no polygon: they come first among the cells."""
    return len(root["Vertices/Connectivity"])


def units(path: Path | str) -> dict[str, str]:
    """Return the units of all fields of a file, in the order of its view; "" where unknown."""
    with _open(path) as file:
        root: Any = file["VTKHDF"]
        listed = [entry.partition(" ") for entry in _text(root, UNITS).split("; ") if entry]
        by_name = {name: unit for name, _, unit in listed if name != "points"}
        known = [*root["PointData"], *root.get("CellData", ())]
        return by_name | {name: "" for name in known if name not in by_name}


def scene(path: Path | str) -> str:
    """Return what ran when a file was written; "" where it does not say."""
    with _open(path) as file:
        return _text(file["VTKHDF"], SCENE)


def _text(root: Any, name: str) -> str:
    data = root.get(f"FieldData/{name}")
    return "" if data is None else str(data.asstr("utf-8")[0])
