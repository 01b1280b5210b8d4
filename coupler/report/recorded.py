"""Recorded fields of a run as arrays with times and units."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from math import prod
from pathlib import Path
from typing import Any

import numpy as np

from quintet.coupler.files.recording import NAME, Recording
from quintet.interfaces.component import Array, Field, fields_of
from quintet.interfaces.params import unknown
from quintet.interfaces.units import INTEGRATED


@dataclass(frozen=True, slots=True)
class Series:
    """Values over the time of a run; numpy functions take it as its values.

    Attributes
    ----------
    values : array (rows, ...)
        Of a field (rows, items, ...): row 0 is the start, row k the end of window k, or, of an
        impulse, the integral over window k.
    times : array (rows,), s
    unit : str
        Of the values.
    """

    values: Array
    times: Array
    unit: str

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> Array:
        return np.array(self.values, dtype, copy=copy)

    def __len__(self) -> int:
        return len(self.values)

    def __repr__(self) -> str:
        span = f", {self.times[0]:g} to {self.times[-1]:g} s" if len(self.times) else ""
        return f"Series({self.values.shape} [{self.unit}]{span})"


class RecordedFields(Mapping[str, Series]):
    """Recorded fields of a run by ``component.port.field``, each read when it is asked for."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._fields: dict[str, tuple[str, Field]] = {}
        self._widths: dict[str, int] = {}
        if not (folder / NAME).is_file():
            return
        with Recording(folder) as recording:
            for name in recording.names:
                for key, field in fields_of(recording.ports(name)).items():
                    if key in recording.fields(name):
                        self._fields[f"{name}.{key}"] = (name, field)
                        self._widths[f"{name}.{key}"] = prod(recording.items(name, key))

    def __getitem__(self, key: str) -> Series:
        name, field = self._field(key)
        with Recording(self._folder) as recording:
            values = recording.field(name, key.partition(".")[2])
            times = recording.times(name)
        return Series(values, times, INTEGRATED[field.unit] if self.is_impulse(key) else field.unit)

    def _field(self, key: str) -> tuple[str, Field]:
        if key not in self._fields:
            raise KeyError(unknown(f"run {self._folder}: field {key}", key, self._fields))
        return self._fields[key]

    def is_impulse(self, key: str) -> bool:
        """Whether a field is recorded as its integral over every window."""
        return self._field(key)[1].centring == "impulse"

    def width(self, key: str) -> int:
        """How many numbers a row of a field has."""
        self._field(key)
        return self._widths[key]

    def rate(self, key: str) -> Series:
        """A field in its own unit; of an impulse the mean over every window, nan at the start."""
        series = self[key]
        if not self.is_impulse(key):
            return series
        lengths = np.diff(series.times, prepend=np.nan)
        spread = lengths.reshape(-1, *[1] * (series.values.ndim - 1))
        return Series(series.values / spread, series.times, self._field(key)[1].unit)

    def __contains__(self, key: object) -> bool:
        return key in self._fields

    def __iter__(self) -> Iterator[str]:
        return iter(self._fields)

    def __len__(self) -> int:
        return len(self._fields)

    def __repr__(self) -> str:
        return f"RecordedFields({', '.join(self._fields) or 'nothing recorded'})"
