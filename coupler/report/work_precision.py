"""Work-precision diagram: error against run time, as a table and as a picture."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from rich.table import Table

from quintet.coupler.report.panels import can_draw, curve_panels, save

Row = dict[str, Any]


def table(rows: Sequence[Row]) -> Table:
    """One column for each refinement, one row for each expectation's error and each cost."""
    summary = Table(box=None, pad_edge=False)
    summary.add_column("", overflow="fold")
    for row in rows:
        summary.add_column(row["label"], justify="right", overflow="fold")
    units = {name: unit for row in rows for name, unit in row["units"].items()}
    states = [row["status"] if row["status"] != "done" else _met(row) for row in rows]
    summary.add_row("", *states)
    for name, unit in units.items():
        errors = [three_digits(row["errors"].get(name)) for row in rows]
        summary.add_row(f"error of {name} [{unit}]", *errors)
    for name, key in (("CPU [s]", "cpu"), ("wall [s]", "wall"), ("size", "size")):
        summary.add_row(name, *(three_digits(row[key]) for row in rows))
    shares = ["-" if row["overhead"] is None else f"{100.0 * row['overhead']:.1f}" for row in rows]
    summary.add_row("coupling [%]", *shares)
    memories = [three_digits(row["memory"] / 1e6 if row["memory"] else None) for row in rows]
    summary.add_row("memory [MB]", *memories)
    summary.add_row("items", *(str(row["items"]) for row in rows))
    return summary


def _met(row: Row) -> str:
    return "met" if row["met"] else "not met"


def three_digits(value: float | None) -> str:
    """Format with three digits; a dash for None."""
    return "-" if value is None else f"{value:.3g}"


def draw(rows: Sequence[Row], out: Path, title: str = "") -> Path | None:
    """Draw error over processor time, both on a logarithmic scale, a panel for each expectation.

    Returns `out`, or None where no refinement has an error to be drawn, or nothing can draw.
    """
    done = [row for row in rows if row["status"] == "done" and row["cpu"] > 0.0]
    names = list(dict.fromkeys(n for row in done for n, e in row["errors"].items() if e))
    if not names or not can_draw():
        return None
    figure, panels = curve_panels(len(names), title)
    for panel, name in zip(panels, names, strict=True):
        _draw(panel, name, [row for row in done if row["errors"].get(name)])
    return save(figure, out)


def _draw(panel: Any, name: str, rows: Sequence[Row]) -> None:
    for met, filling in ((True, "full"), (False, "none")):
        some = [row for row in rows if row["met"] is met]
        style = {"markersize": 6, "color": "tab:blue", "fillstyle": filling}
        panel.loglog(
            [row["cpu"] for row in some], [row["errors"][name] for row in some], "o", **style
        )
    for row in rows:
        place = (row["cpu"], row["errors"][name])
        panel.annotate(row["label"], place, (5, 4), textcoords="offset points", fontsize=8)
    if within := rows[-1]["within"][name]:
        panel.axhline(within, color="grey", linewidth=0.8, linestyle="--")
    panel.set_title(name, fontsize=9)
    panel.set(xlabel="processor time [s]", ylabel=f"error [{rows[-1]['units'][name]}]")
    panel.margins(0.25)
    panel.grid(which="both", alpha=0.3)
