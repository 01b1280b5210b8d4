"""Maps of limits in two parameters: which pairs hold, which break, and the limit by theory."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from quintet.coupler.report.panels import can_draw, curve_panels, save
from quintet.coupler.report.stability_tables import with_unit

PICTURE = "stability.png"
LOOKS = {
    "stable": {"marker": "o", "color": "tab:green"},
    "degraded": {"marker": "^", "color": "tab:orange"},
    "unstable": {"marker": "x", "color": "tab:red"},
}
LINES = {  # with a bar at each limit, which shows it also where there is but one
    "found": {"linestyle": "-", "color": "0.75", "linewidth": 4.0},
    "predicted": {"linestyle": "--", "color": "tab:blue", "linewidth": 1.2},
}
WIDE = 20.0  # ratio of the ends of an axis from which it is logarithmic
Row = dict[str, Any]


def draw_maps(
    scene: str, limits: Sequence[Row], units: Mapping[str, str], out: Path
) -> Path | None:
    """Draw a panel for each limit that was found for several values of a second parameter.

    Returns `out`, or None where there is none, or nothing can draw.
    """
    limits = [limit for limit in limits if limit["against"] and limit["runs"]]
    names = list(dict.fromkeys(limit["name"] for limit in limits))
    if not names or not can_draw():
        return None
    figure, panels = curve_panels(len(names), f"{scene}: limits of stability")
    for panel, name in zip(panels, names, strict=True):
        _draw(panel, [limit for limit in limits if limit["name"] == name], units)
    legends = [zip(*panel.get_legend_handles_labels(), strict=True) for panel in panels]
    looks = {label: handle for legend in legends for handle, label in legend}
    shown = [label for label in (*LOOKS, *LINES) if label in looks]
    handles = [looks[label] for label in shown]
    figure.legend(handles, shown, loc="outside lower center", ncols=5, fontsize=8)
    return save(figure, out)


def _draw(panel: Any, limits: Sequence[Row], units: Mapping[str, str]) -> None:
    """Draw the runs of a limit, and the lines of what was predicted and found."""
    points = {
        state: [
            (_other(limit), run["value"])
            for limit in limits
            for run in limit["runs"]
            if run["state"] == state
        ]
        for state in LOOKS
    }
    for state, pairs in points.items():
        if pairs:
            panel.scatter(*zip(*pairs, strict=True), s=22, label=state, zorder=3, **LOOKS[state])
    for key, line in LINES.items():
        known = [(_other(limit), limit[key]) for limit in limits if limit[key] is not None]
        if known:
            width = line["linewidth"]
            bar = {"marker": "_", "markersize": 18, "markeredgewidth": width}
            panel.plot(*zip(*known, strict=True), label=key, **line, **bar)
    parameter = limits[0]["parameter"]
    path = parameter if isinstance(parameter, str) else ", ".join(parameter)
    labels = [with_unit(name, units) for name in (next(iter(limits[0]["against"])), path)]
    panel.set(xlabel=labels[0], ylabel=labels[1], title=limits[0]["name"])
    every = [pair for pairs in points.values() for pair in pairs]
    for axis, values in zip("xy", zip(*every, strict=True), strict=True):
        if min(values) > 0.0 and max(values) > WIDE * min(values):
            panel.set(**{f"{axis}scale": "log"})


def _other(limit: Row) -> float:
    """Value of the second parameter."""
    return float(next(iter(limit["against"].values())))
