"""Results of a sweep: a table for the screen, a table for programs, a picture."""

import csv
import io
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from rich.table import Table

from quintet.coupler.files.disk import write_whole
from quintet.coupler.report.panels import can_draw, curve_panels, save
from quintet.coupler.report.work_precision import three_digits
from quintet.coupler.scene.overrides import value_text
from quintet.coupler.scene.sweep_axes import Axis

MOST_ROWS = 60  # of the table on the screen
MOST_CURVES = 10  # in a panel; more are drawn as points, coloured by one key
SPAN = 30.0  # largest over smallest value from which an axis is logarithmic
Row = dict[str, Any]


def units_of(rows: Sequence[Row]) -> dict[str, str]:
    """Quantities of the runs, with their units."""
    return {name: unit for row in rows for name, unit in row["units"].items()}


def table(axes: Sequence[Axis], rows: Sequence[Row]) -> Table:
    """One row for each run: keys, quantities, status, times; of many runs the first."""
    units = units_of(rows)
    screen_table = Table(box=None, pad_edge=False)
    heads = [axis.label for axis in axes] + [f"{name} [{unit}]" for name, unit in units.items()]
    for head in (*heads, "status", "wall [s]", "CPU [s]", "run"):
        left = head in ("status", "run")
        screen_table.add_column(head, justify="left" if left else "right", overflow="fold")
    for row in rows[:MOST_ROWS]:
        keys = [value_text(row["settings"][axis.path], axis.path) for axis in axes]
        values = [_value(row, name) for name in units]
        times = [three_digits(row["wall"]), three_digits(row["cpu"])]
        screen_table.add_row(*keys, *values, _state(row), *times, row["run"])
    if len(rows) > MOST_ROWS:
        screen_table.caption = f"the first {MOST_ROWS} of {len(rows)} runs; all are in sweep.csv"
    return screen_table


def _value(row: Row, name: str) -> str:
    value = row["values"].get(name)
    return "-" if value is None else f"{value:.6g}"


def _state(row: Row) -> str:
    """Status; of runs that are done, whether all expectations are met, where there are any."""
    if row["status"] != "done" or not row["values"]:
        return str(row["status"])
    return "done, met" if row["met"] else "done, not met"


def write_csv(axes: Sequence[Axis], rows: Sequence[Row], path: Path) -> None:
    """Write all runs: hash, keys, status, quantities, errors against references, times."""
    units, text = units_of(rows), io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    keys = [axis.path for axis in axes]
    values = [f"{name} [{unit}]" for name, unit in units.items()]
    errors = [f"error of {name} [{unit}]" for name, unit in units.items()]
    times = ["wall [s]", "cpu [s]", "memory [bytes]"]
    writer.writerow(["run", *keys, "status", "met", *values, *errors, *times, "cause"])
    for row in rows:
        cells = [row["run"], *(_cell(row["settings"][key]) for key in keys), row["status"]]
        cells += ["" if not row["values"] else str(row["met"]).lower()]
        cells += [row["values"].get(name) for name in units]
        cells += [row["errors"].get(name) for name in units]
        writer.writerow([*cells, row["wall"], row["cpu"], row["memory"], row["cause"]])
    write_whole(path, text.getvalue())


def _cell(value: Any) -> Any:
    return value if isinstance(value, (int, float, str)) else value_text(value)


def draw(axes: Sequence[Axis], rows: Sequence[Row], out: Path, title: str = "") -> Path | None:
    """Draw every quantity over the first key with numbers, a panel each.

    Other keys make a curve for each combination; of many, points coloured by the first other key.
    Returns `out`, or None where there is nothing to be drawn, or nothing can draw.
    """
    done = [row for row in rows if row["status"] == "done"]
    names = [
        name for name in units_of(done) if any(row["values"].get(name) is not None for row in done)
    ]
    if not names or not can_draw():
        return None
    across = next((axis for axis in axes if _numbers(axis.values)), axes[0])
    others = [axis for axis in axes if axis is not across]
    figure, panels = curve_panels(len(names), title)
    for panel, name in zip(panels, names, strict=True):
        _draw(panel, name, across, others, [r for r in done if r["values"].get(name) is not None])
    return save(figure, out)


def _numbers(values: Sequence[Any]) -> bool:
    return all(isinstance(v, (int, float)) and not isinstance(v, bool) for v in values)


def _draw(panel: Any, name: str, across: Axis, others: Sequence[Axis], rows: Sequence[Row]) -> None:
    places, names = _places(across), _short_names([across, *others])
    groups: dict[str, list[Row]] = {}
    for row in rows:
        groups.setdefault(_name(row, others, names), []).append(row)
    curves = len(groups) <= MOST_CURVES
    if not curves:
        groups = {}
        for row in rows:
            groups.setdefault(_name(row, others[:1], names), []).append(row)
    for number, (label, some) in enumerate(groups.items()):
        points = sorted((places[_text(row, across)], row["values"][name]) for row in some)
        style = {"marker": "o", "markersize": 4, "color": f"C{number % 10}"}
        style |= {"linewidth": 1.2} if curves else {"linestyle": "none", "alpha": 0.6}
        panel.plot(*zip(*points, strict=True), label=label, **style)
    _axes(panel, name, across, places, rows)
    if len(groups) > 1 or next(iter(groups)):
        panel.legend(fontsize=7, frameon=False)


def _short_names(axes: Sequence[Axis]) -> dict[str, str]:
    """Last part of each path; the whole path where several keys end in the same one."""
    last = {axis.path: axis.path.rpartition(".")[2] for axis in axes}
    parts = list(last.values())
    return {path: part if parts.count(part) == 1 else path for path, part in last.items()}


def _name(row: Row, axes: Sequence[Axis], names: Mapping[str, str]) -> str:
    """Name a combination of keys."""
    return ", ".join(f"{names[axis.path]} = {_text(row, axis)}" for axis in axes)


def _text(row: Row, axis: Axis) -> str:
    return value_text(row["settings"][axis.path], axis.path)


def _places(axis: Axis) -> dict[str, float]:
    """Where the values of a key stand: numbers where they are, others one after the other."""
    texts = [value_text(value, axis.path) for value in axis.values]
    numbers = axis.values if _numbers(axis.values) else range(len(texts))
    return dict(zip(texts, map(float, numbers), strict=True))


def _axes(
    panel: Any, name: str, across: Axis, places: dict[str, float], rows: Sequence[Row]
) -> None:
    if not _numbers(across.values):
        panel.set_xticks(list(places.values()), list(places))
    elif min(places.values()) > 0.0 and max(places.values()) > SPAN * min(places.values()):
        panel.set_xscale("log")
    panel.set_title(name, fontsize=9)
    panel.set(xlabel=across.label, ylabel=f"{name} [{rows[0]['units'][name]}]")
    panel.grid(alpha=0.3)
