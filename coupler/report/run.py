"""A run as Python objects: results, ledger and recorded fields as arrays with units."""

import base64
import csv
import io
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from rich import box
from rich.console import Console

from quintet.coupler.files.checksums import KEY, require_same
from quintet.coupler.files.recording import NAME, Recording
from quintet.coupler.files.run_files import LEDGER, PICTURES, SCENE
from quintet.coupler.report import show
from quintet.coupler.scene.read import parse
from quintet.interfaces.component import Array, Field, fields_of
from quintet.interfaces.errors import RunError, SceneError
from quintet.interfaces.params import unknown
from quintet.interfaces.units import INTEGRATED

WIDTH = 110  # characters, of tables in a notebook
ENDED = (0, 1, 130)  # exit status of a run that did not fail: met, not met, interrupted
LEDGER_UNITS = {
    "impulse": "N s",
    "work": "J",
    "heat": "J",
    "mass": "kg",
    "momentum": "kg m/s",
    "kinetic": "J",
    "potential": "J",
    "internal": "J",
    "link": "J",
    "dissipated": "J",
}


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
        if not (folder / NAME).is_file():
            return
        with Recording(folder) as recording:
            for name in recording.names:
                for key, field in fields_of(recording.ports(name)).items():
                    if key in recording.fields(name):
                        self._fields[f"{name}.{key}"] = (name, field)

    def __getitem__(self, key: str) -> Series:
        if key not in self._fields:
            raise KeyError(unknown(f"run {self._folder}: field {key}", key, self._fields))
        name, field = self._fields[key]
        with Recording(self._folder) as recording:
            values = recording.field(name, key.partition(".")[2])
            times = recording.times(name)
        return Series(values, times, INTEGRATED[field.unit] if is_impulse(field) else field.unit)

    def __contains__(self, key: object) -> bool:
        return key in self._fields

    def __iter__(self) -> Iterator[str]:
        return iter(self._fields)

    def __len__(self) -> int:
        return len(self._fields)

    def __repr__(self) -> str:
        return f"RecordedFields({', '.join(self._fields) or 'nothing recorded'})"


def is_impulse(field: Field) -> bool:
    """Whether a field is recorded as its integral over every window."""
    return field.centring == "impulse"


class Run:
    """A run: what it left in its folder.

    Attributes
    ----------
    folder : Path
    results : dict
        As in ``results.json``: expectations, ledger, timing, machine.
    fields : mapping of str to Series
        By ``component.port.field``.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = Path(folder).resolve()
        self.results = show.results(self.folder)
        self.fields = RecordedFields(self.folder)

    @property
    def status(self) -> str:
        """One of done, interrupted and failed."""
        return str(self.results.get("status", "unknown"))

    @property
    def ok(self) -> bool:
        """Whether the run is done and meets all expectations that are required."""
        return self.status == "done" and all(
            outcome["met"] or not outcome["required"] for outcome in self.expectations.values()
        )

    @property
    def expectations(self) -> dict[str, dict[str, Any]]:
        """Expectations by name: value, reference, within, unit, met, source."""
        return {outcome["name"]: outcome for outcome in self.results.get("expect") or []}

    @property
    def scene(self) -> dict[str, Any]:
        """The scene as it ran, with presets and settings applied."""
        self._require_same(SCENE)
        return parse(self.folder / SCENE)

    @property
    def ledger(self) -> dict[str, dict[str, Series]]:
        """The ledger by link or component, then by column."""
        path = self.folder / LEDGER
        if not path.is_file():
            return {}
        self._require_same(LEDGER)
        with open(path, newline="") as file:
            rows = list(csv.DictReader(file))
        return {name: _columns(rows, name) for name in dict.fromkeys(row["name"] for row in rows)}

    def _require_same(self, name: str) -> None:
        """Refuse a file that was changed since the run has ended."""
        require_same(self.folder, self.results.get(KEY, {}), [name])

    @property
    def pictures(self) -> dict[str, Path]:
        """Pictures by name: scene, comparison."""
        return {path.stem: path for path in map(self.folder.joinpath, PICTURES) if path.is_file()}

    def __str__(self) -> str:
        screen = Console(file=io.StringIO(), width=WIDTH)
        show.print_results(self.results, screen)
        return screen.file.getvalue()  # type: ignore[attr-defined]

    def __repr__(self) -> str:
        return f"<Run {self.results.get('scene', '?')}: {self.status}, in {self.folder}>"

    def _repr_html_(self) -> str:
        """Summary and pictures, for a notebook."""
        screen = Console(file=io.StringIO(), width=WIDTH, record=True, highlight=False)
        show.print_results(self.results, screen, box.SIMPLE_HEAD)
        text = screen.export_html(inline_styles=True, code_format="<pre>{code}</pre>")
        images = (base64.b64encode(path.read_bytes()) for path in self.pictures.values())
        return text + "".join(f'<img src="data:image/png;base64,{i.decode()}">' for i in images)

    def _repr_png_(self) -> bytes | None:
        """The first picture, for a notebook."""
        first = next(iter(self.pictures.values()), None)
        return first.read_bytes() if first else None


def _columns(rows: list[dict[str, str]], name: str) -> dict[str, Series]:
    """Columns of the ledger that have values for a link or component."""
    of_name = [row for row in rows if row["name"] == name]
    keys = [key for key in of_name[0] if key not in ("time", "name")]
    series = {}
    for key in keys:
        known = [(float(row["time"]), float(row[key])) for row in of_name if row[key]]
        if known:
            times, values = np.array(known).T
            unit = "1" if "residual" in key else LEDGER_UNITS.get(key.partition("_")[0], "")
            series[key] = Series(values, times, unit)
    return series


def finished(folder: Path, status: int) -> Run:
    """Open a run that just ended with an exit status; RunError if it failed."""
    try:
        run = Run(folder)
    except SceneError as error:
        raise RunError(f"run {folder}: it failed without results. See its log.", folder) from error
    if status not in ENDED:
        fault = run.results.get("fault") or {}
        raise RunError(
            f"run {folder}: {fault.get('component', 'it')} failed in window "
            f"{fault.get('window', 0)}: {fault.get('cause', 'no cause is known')}.",
            folder,
        )
    return run
