"""A run as Python objects: results, ledger and recorded fields as arrays with units."""

import base64
import csv
import io
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from rich import box
from rich.console import Console

from quintet.coupler.files.checksums import KEY, require_same
from quintet.coupler.files.run_files import LEDGER, PICTURES, SCENE
from quintet.coupler.report import columns, show
from quintet.coupler.report.recorded import RecordedFields, Series
from quintet.coupler.report.views import Views
from quintet.coupler.scene.read import parse
from quintet.interfaces.errors import RunError, SceneError

if TYPE_CHECKING:
    import pandas
    import xarray

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


class Run:
    """A run: what it left in its folder.

    Attributes
    ----------
    folder : Path
    results : dict
        As in ``results.json``: expectations, ledger, timing, machine.
    fields : mapping of str to Series
        By ``component.port.field``.
    views : mapping of str to View
        What pictures and ParaView show, by component: ``run.views["water"].at(0.2)``.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = Path(folder).resolve()
        self.results = show.results(self.folder)
        self.fields = RecordedFields(self.folder)
        self.views = Views(self.folder)

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

    def to_pandas(self, *names: str) -> "pandas.DataFrame":
        """Recorded fields as a table, with a row for the start and the end of each window.

        Parameters
        ----------
        names : str
            ``component``, ``component.port`` or ``component.port.field``. Without any, all fields
            of at most 1000 numbers.

        Returns
        -------
        pandas.DataFrame
            By the time [s]; columns as ``water.gauges.pressure 3 [Pa]``: field, item if there are
            several, axis, unit. Impulses are means over each window, nan at the start.
        """
        return columns.to_pandas(self.fields, names)

    def to_xarray(self, *names: str) -> "xarray.Dataset":
        """Recorded fields as arrays (time, item, axis) with units; `names` as of `to_pandas`."""
        return columns.to_xarray(self.fields, names)

    def _require_same(self, name: str) -> None:
        """Refuse a file that was changed since the run has ended."""
        require_same(self.folder, self.results.get(KEY, {}), [name])

    @property
    def pictures(self) -> dict[str, Path]:
        """Pictures by name: scene, comparison."""
        return {path.stem: path for path in map(self.folder.joinpath, PICTURES) if path.is_file()}

    def __str__(self) -> str:
        screen = Console(file=io.StringIO(), width=WIDTH, highlight=False, markup=False)
        show.print_results(self.results, screen)
        return screen.file.getvalue()  # type: ignore[attr-defined]

    def __repr__(self) -> str:
        return f"<Run {self.results.get('scene', '?')}: {self.status}, in {self.folder}>"

    def _repr_html_(self) -> str:
        """Summary and pictures, for a notebook."""
        screen = Console(
            file=io.StringIO(), width=WIDTH, record=True, highlight=False, markup=False
        )
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
            series[key] = Series(values, times, ledger_unit(key))
    return series


def ledger_unit(column: str) -> str:
    """Unit of a column of the ledger; "" of its names."""
    if column == "time":
        return "s"
    return "1" if "residual" in column else LEDGER_UNITS.get(column.partition("_")[0], "")


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
