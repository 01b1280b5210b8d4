"""Recorded fields as columns with names and units, for tables of other programs.

Pandas and xarray are loaded by the functions that make their objects: nothing else needs them.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from quintet.coupler.report.recorded import RecordedFields, Series
from quintet.interfaces.component import Array
from quintet.interfaces.errors import SceneError
from quintet.interfaces.libraries import require
from quintet.interfaces.params import unknown

if TYPE_CHECKING:
    import pandas
    import xarray

MOST = 1000  # columns of a field that nobody named: of more, thousands of particles as a rule
AXES = {3: "xyz", 4: "wxyz"}  # of vectors and of rotations
MEAN = "mean over each window"
INSTANT = "at the end of each window"


@dataclass(frozen=True, slots=True)
class Columns:
    """A recorded field as a table: a row for the start, and one for the end of each window.

    Attributes
    ----------
    names : list of str
        As ``velocity 3 x [m/s]``: field, item if there are several, axis, unit.
    times : (rows,) float array, s
    values : (rows, columns) float array
    """

    names: list[str]
    times: Array
    values: Array


def columns_of(field: str, series: Series) -> Columns:
    """Lay out a field; `field` begins the names of its columns."""
    rows, count, *shape = series.values.shape
    items = [f" {item}" for item in range(count)] if count != 1 else [""]
    parts = [f" {'.'.join(map(str, place))}" if place else "" for place in np.ndindex(*shape)]
    if len(shape) == 1 and shape[0] in AXES:
        parts = [f" {axis}" for axis in AXES[shape[0]]]
    names = [f"{field}{item}{part} [{series.unit}]" for item in items for part in parts]
    return Columns(names, series.times, series.values.reshape(rows, len(names)))


def chosen(fields: RecordedFields, wanted: Iterable[str]) -> tuple[list[str], list[str]]:
    """Keys of the fields that are wanted, and of those left out because they are too wide.

    `wanted` has ``component``, ``component.port`` or ``component.port.field``; without any all
    fields of at most `MOST` columns are.
    """
    wanted, keys = list(wanted), list(fields)
    if not wanted:
        narrow = [key for key in keys if fields.width(key) <= MOST]
        return narrow, [key for key in keys if key not in narrow]
    known = sorted({".".join(key.split(".")[:k]) for key in keys for k in (1, 2, 3)})
    if lacking := [name for name in wanted if name not in known]:
        raise SceneError(*(unknown(f"recorded field {name}", name, known) for name in lacking))
    parts = [name.split(".") for name in wanted]
    return [key for key in keys if any(key.split(".")[: len(p)] == p for p in parts)], []


def to_pandas(fields: RecordedFields, wanted: Iterable[str]) -> "pandas.DataFrame":
    """One column for each number of the fields that are wanted, by the time [s] of the rows."""
    require("pandas", "to_pandas")
    # Start-up: only this function needs it.
    import pandas

    frames = []
    for key in chosen(fields, wanted)[0]:
        columns = columns_of(key, fields.rate(key))
        index = pandas.Index(columns.times, name="time [s]")
        frames.append(pandas.DataFrame(columns.values, index, columns.names))
    if not frames:
        return pandas.DataFrame(index=pandas.Index([], name="time [s]", dtype=float))
    return pandas.concat(frames, axis=1)


def to_xarray(fields: RecordedFields, wanted: Iterable[str]) -> "xarray.Dataset":
    """A variable (time, item, axis) for each of the fields, with its units and what it means."""
    require("xarray", "to_xarray")
    # Start-up: only this function needs it.
    import xarray

    arrays = [_data_array(xarray, key, fields) for key in chosen(fields, wanted)[0]]
    return xarray.Dataset({array.name: array for array in _with_same_times(arrays)})


def _data_array(xarray: Any, key: str, fields: RecordedFields) -> Any:
    series = fields.rate(key)
    shape = series.values.shape[2:]
    port = key.rpartition(".")[0]
    coordinates: dict[str, Any] = {"time": ("time", series.times, {"units": "s"})}
    dims = ["time", f"{port}.item"]  # ports have as many items as they like
    for place, size in enumerate(shape):
        axis = "axis" if shape == (3,) else f"{key}.axis{place}"
        dims.append(axis)
        if size in AXES and len(shape) == 1:
            coordinates[axis] = (axis, list(AXES[size]), {})
    meaning = {"units": series.unit, "cell_methods": MEAN if fields.is_impulse(key) else INSTANT}
    return xarray.DataArray(series.values, coordinates, dims, key, meaning)


def _with_same_times(arrays: list[Any]) -> Iterator[Any]:
    """Give arrays whose times differ a dimension of their own, named after their component."""
    if not arrays:
        return
    first = arrays[0].time.values
    for array in arrays:
        if np.array_equal(array.time.values, first):
            yield array
        else:
            yield array.rename(time=f"{array.name.partition('.')[0]}.time")
