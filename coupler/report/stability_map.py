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
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=5, fontsize=8)
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
    for key, style in (("found", "-"), ("predicted", "--")):
        known = [(_other(limit), limit[key]) for limit in limits if limit[key] is not None]
        if known:
            panel.plot(*zip(*known, strict=True), style, color="0.3", linewidth=1.0, label=key)
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
