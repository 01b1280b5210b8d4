"""Fields over space in a table: a column for each coordinate that they depend on, and each field.

Rows are the points of a rectangular grid, in any order; between them fields are linear along each
axis, beyond them as on its edge. Along an axis that the table has no column of they are constant.
"""

import itertools
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from quintet.components.sph_fluid.setup.csv_table import read_csv

Array = NDArray[np.float64]
AXES = ("x", "y", "z")  # m
FIELDS = ("u", "v", "w", "density")  # m/s and kg/m3


@dataclass(frozen=True, eq=False)
class FieldTable:
    """Fields on the points of a rectangular grid."""

    places: dict[str, Array]  # (k,) m of each axis, ascending
    values: dict[str, Array]  # one axis after another

    def has(self, *names: str) -> bool:
        """Whether any of some fields is there."""
        return any(name in self.values for name in names)

    def at(self, points: Array, name: str) -> Array:
        """Values (n,) of a field at points (n, 3) m; 0 of a velocity that has no column."""
        values = np.zeros(len(points))
        if name not in self.values:
            return values
        lower, share = [], []
        for axis, place in self.places.items():
            coordinate = np.clip(points[:, AXES.index(axis)], place[0], place[-1])
            row = np.clip(np.searchsorted(place, coordinate) - 1, 0, max(len(place) - 2, 0))
            step = place[np.minimum(row + 1, len(place) - 1)] - place[row]
            share.append(
                np.divide(coordinate - place[row], step, out=np.zeros(len(row)), where=step > 0)
            )
            lower.append(row)
        for ends in itertools.product((0, 1), repeat=len(lower)):
            weight, index = np.ones(len(points)), []
            for end, row, part, place in zip(ends, lower, share, self.places.values(), strict=True):
                weight = weight * (part if end else 1.0 - part)
                index.append(np.minimum(row + end, len(place) - 1))
            values += weight * self.values[name][tuple(index)]
        return values


@lru_cache(maxsize=8)
def read_table(file: str) -> FieldTable:
    """Read a table; its first line names the columns."""
    name = Path(file).name
    columns, numbers = read_csv(file, "table")
    allowed = (*AXES, *FIELDS)
    axes = [column for column in columns if column in AXES]
    fields = [column for column in columns if column in FIELDS]
    right = len(set(columns)) == len(columns) and set(columns) <= set(allowed) and axes and fields
    if not right or numbers.ndim != 2 or not np.isfinite(numbers).all():
        raise ValueError(
            f"table {name} must have columns of finite numbers, each once, one of {', '.join(AXES)}"
            f" or more and one of {', '.join(FIELDS)} or more; found {', '.join(columns)[:80]} and "
            f"{len(numbers)} rows. Correct it."
        )
    column = dict(zip(columns, numbers.T, strict=True))
    places, indices = {}, []
    for axis in axes:
        places[axis], row = np.unique(column[axis], return_inverse=True)
        indices.append(row.reshape(-1))
    shape = tuple(len(axis) for axis in places.values())
    number = np.ravel_multi_index(tuple(indices), shape)
    if len(numbers) != np.prod(shape) or len(np.unique(number)) != len(numbers):
        raise ValueError(
            f"table {name} must have a row for each point of a rectangular grid, here "
            f"{' x '.join(map(str, shape))}; found {len(numbers)} rows. Complete it."
        )
    values = {}
    for field in fields:
        values[field] = np.empty(len(numbers))
        values[field][number] = column[field]
        values[field] = values[field].reshape(shape)
    return FieldTable(places, values)
