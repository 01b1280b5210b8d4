"""Work-precision diagram: error against run time, of all refinements of a study."""

import itertools
import math
import textwrap
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from quintet.coupler.report.panels import can_draw, curve_panels, save

Row = dict[str, Any]
LINE = 66  # characters in a panel's title
COLOURS = {
    "coupling": "tab:orange",
    "time step": "tab:green",
    "spacing": "tab:blue",
    "model": "tab:purple",
}
COSTS = {  # kinds of time that stand for the cost of another program's run
    "cpu": "CPU time, time steps",
    "wall": "wall time, time steps",
    "process": "CPU time, whole process",
}
PEERS = ("tab:red", "tab:brown", "tab:olive", "tab:cyan")  # other programs, in turn
MARKERS = "sD^v"  # of their series
RIGHT = 0.65  # of the logarithmic axis, from where labels stand left of their points
SMALLEST_SLOPE = 0.02  # of a line to which a triangle is drawn


def three_digits(value: float | None) -> str:
    """Format with three digits; a dash for None."""
    return "-" if value is None else f"{value:.3g}"


def pareto_front(costs: Sequence[float], errors: Sequence[float]) -> list[int]:
    """Numbers of the points that no other beats in both cost and error, by rising cost."""
    front: list[int] = []
    for number in sorted(range(len(costs)), key=lambda n: (costs[n], errors[n])):
        if not front or errors[number] < errors[front[-1]]:
            front.append(number)
    return front


def draw(summary: Row, out: Path) -> Path | None:
    """Draw error over processor time, both on a logarithmic scale, a panel for each expectation.

    Filled points meet all expectations; a line joins those that no other refinement beats; a
    triangle has the slope of the errors of each kind over the time. Squares are runs of other
    programs.

    Returns `out`, or None where no refinement has an error to be drawn, or nothing can draw.
    """
    done = [row for row in summary["rows"] if row["status"] == "done" and row["cpu"] > 0.0]
    names = list(dict.fromkeys(n for row in done for n, e in row["errors"].items() if e))
    if not names or not can_draw():
        return None
    figure, panels = curve_panels(len(names), summary["scene"])
    labelled: dict[str, Any] = {}
    for panel, name in zip(panels, names, strict=True):
        rows = [row for row in done if row["errors"].get(name)]
        _draw(panel, name, rows, summary["kinds"])
        for number, peer in enumerate(summary.get("peers", ())):
            _draw_peer(panel, name, peer, PEERS[number % len(PEERS)])
        for handle, label in zip(*panel.get_legend_handles_labels(), strict=True):
            labelled.setdefault(label, handle)
    columns = min(len(labelled), 3 if len(names) == 1 else 5)
    figure.legend(
        labelled.values(), labelled, loc="outside lower center", ncols=columns, fontsize=8
    )
    return save(figure, out)


def _draw(panel: Any, name: str, rows: Sequence[Row], kinds: Row) -> None:
    panel.set(xscale="log", yscale="log")
    for kind in dict.fromkeys(row["kind"] for row in rows):
        for met, words in ((True, ", all met"), (False, ", not all met"), (None, "")):
            some = [row for row in rows if row["kind"] == kind and row["met"] is met]
            if some:
                _points(panel, name, some, kind, words, met is not False)
    costs, errors = [row["cpu"] for row in rows], [row["errors"][name] for row in rows]
    front = pareto_front(costs, errors)
    best = [costs[k] for k in front], [errors[k] for k in front]
    panel.plot(*best, color="0.4", linewidth=1.0, zorder=1, label="Pareto front")
    right = min(costs) ** (1.0 - RIGHT) * max(costs) ** RIGHT
    for row, cost, error in zip(rows, costs, errors, strict=True):
        side = {"xytext": (-5, -10), "ha": "right"} if cost > right else {"xytext": (5, 4)}
        panel.annotate(row["label"], (cost, error), textcoords="offset points", fontsize=7, **side)
    if within := rows[-1]["within"].get(name):
        style = {"color": "grey", "linewidth": 0.8, "linestyle": "--"}
        panel.axhline(within, label="within", **style)
    panel.margins(0.25)
    orders = [_order(kind, kinds[kind]["orders"].get(name)) for kind in kinds]
    for kind in kinds:
        _triangle(panel, [row for row in rows if kind in row["ladders"]], name, kind)
    lines = textwrap.wrap(name, LINE, max_lines=2, placeholder=" …")
    lines += textwrap.wrap("; ".join(filter(None, orders)), LINE, max_lines=2, placeholder=" …")
    panel.set_title("\n".join(lines), fontsize=9)
    panel.set(xlabel="processor time [s]", ylabel=f"error [{rows[-1]['units'][name]}]")
    panel.grid(which="both", alpha=0.3)


def _draw_peer(panel: Any, name: str, peer: Row, colour: str) -> None:
    """Draw the runs of another program, filled where all that measures them is met."""
    done = [row for row in peer["rows"] if row["errors"].get(name) and row["cpu"] > 0.0]
    program = f"{peer['program']} {peer['version']}".strip()
    series = dict.fromkeys(row["series"] for row in peer["rows"])
    for words, marker in zip(series, itertools.cycle(MARKERS), strict=False):
        rows = [row for row in done if row["series"] == words]
        costs, errors = [row["cpu"] for row in rows], [row["errors"][name] for row in rows]
        panel.plot(costs, errors, color=colour, linewidth=0.8, linestyle=":", zorder=1)
        cost = "" if peer["cost"] == "cpu" else COSTS[peer["cost"]]
        label = ", ".join(filter(None, (program, words, cost)))
        for row, time, error in zip(rows, costs, errors, strict=True):
            style = {
                "markersize": 5,
                "color": colour,
                "fillstyle": "full" if row["met"] else "none",
            }
            panel.plot(time, error, marker, label=label, **style)
            place = {"xytext": (-5, -10), "ha": "right", "textcoords": "offset points"}
            panel.annotate(row["label"], (time, error), fontsize=7, color=colour, **place)


def _points(
    panel: Any, name: str, rows: Sequence[Row], kind: str, words: str, filled: bool
) -> None:
    costs, errors = [row["cpu"] for row in rows], [row["errors"][name] for row in rows]
    style = {"markersize": 6, "color": COLOURS[kind], "fillstyle": "full" if filled else "none"}
    panel.plot(costs, errors, "o", label=f"{kind}{words}", **style)


def _order(kind: str, order: Row | None) -> str:
    """Order of a kind with half the width of its interval, for a title."""
    if order is None:
        return ""
    text = f"{kind}: order {order['order']:.2f}"
    # A space at which no line is broken.
    return (
        text
        if order["low"] is None
        else f"{text} ±\N{NO-BREAK SPACE}{order['high'] - order['order']:.2g}"
    )


def _triangle(panel: Any, rows: Sequence[Row], name: str, kind: str) -> None:
    """Draw a triangle of the slope of errors over time, below the middle of the points."""
    costs = np.log([row["cpu"] for row in rows])
    errors = np.log([row["errors"][name] for row in rows])
    if len(rows) < 2 or np.ptp(costs) == 0.0:
        return
    slope = float(np.polyfit(costs, errors, 1)[0])
    if not SMALLEST_SLOPE < abs(slope) < math.inf:
        return
    left, wide = float(costs.mean()), 0.25 * float(np.ptp(costs))
    low = float(errors.mean()) - 0.35 * float(np.ptp(errors)) - 0.1
    corners = [(left, low), (left + wide, low + slope * wide), (left, low + slope * wide)]
    x, y = np.exp([*corners, corners[0]]).T
    colour = COLOURS[kind]
    panel.plot(x, y, color=colour, linewidth=0.8, label=f"slope of {kind} over time")
    middle = (x[0], math.sqrt(y[0] * y[2]))
    panel.annotate(
        f"{slope:.2g}", middle, (-3, 0), textcoords="offset points", fontsize=7, color=colour,
        ha="right", va="center",
    )  # fmt: skip
