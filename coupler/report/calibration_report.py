"""Results of a calibration: sentences for the screen, and the misfit over each key."""

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from quintet.coupler.report.comparison import shortened
from quintet.coupler.report.panels import can_draw, curve_panels, save

RUN, INTERVAL, BEST = "tab:blue", "tab:orange", "tab:red"
ENDS = {"below": "lower", "above": "upper"}
Summary = Mapping[str, Any]


def sentences(summary: Summary) -> Iterator[str]:
    """Say what fits best, in what interval, and by which rule."""
    rows = summary["rows"]
    known = sum(row.get("misfit") is not None for row in rows)
    yield f"{known} of {len(rows)} runs have a misfit, {len(summary['failed'])} failed"
    if not summary["keys"]:
        yield f"no run has a value of {summary['to']}: nothing can be calibrated"
        return
    misfit, unit = summary["misfit"], summary["unit"]
    yield f"least misfit of {summary['to']}: {misfit:.4g} {unit}"
    for name, key in summary["keys"].items():
        yield f"{name} = {key['best']:.4g}, {_interval(key)}"
    yield (
        f"interval: where the misfit stays below {misfit + summary['rise']:.4g} {unit}, which is "
        f"{summary['rise']:.4g} {unit} ({summary['rise_from']}) above its least"
    )


def _interval(key: Mapping[str, Any]) -> str:
    """Write an interval, and at which end it is open."""
    text = f"between {key['low']:.4g} and {key['high']:.4g}"
    ends = [end for side, end in ENDS.items() if key[f"open_{side}"]]
    known = "the misfit of the last run there is still below the limit"
    return f"{text} ({' and '.join(ends)} end not known: {known})" if ends else text


def draw(summary: Summary, out: Path) -> Path | None:
    """Draw the misfit of all runs over each key.

    Returns
    -------
    Path or None
        `out`, or None where there is nothing to be drawn, or nothing can draw.
    """
    if not summary["keys"] or not can_draw():
        return None
    rows = [row for row in summary["rows"] if row.get("misfit") is not None]
    title = f"{summary['scene']}: misfit of {summary['to']}, {len(rows)} runs"
    figure, panels = curve_panels(len(summary["keys"]), title)
    for panel, (name, key) in zip(panels, summary["keys"].items(), strict=True):
        first = name.partition(",")[0]
        points = sorted((row["settings"][first], row["misfit"]) for row in rows)
        joined = "-" if len(summary["keys"]) == 1 else "none"
        style = {"marker": "o", "markersize": 4, "linewidth": 0.8, "linestyle": joined}
        panel.plot(*zip(*points, strict=True), color=RUN, label="runs", **style)
        level = summary["misfit"] + summary["rise"]
        label = shortened(f"least + {summary['rise']:.3g}, {summary['rise_from']}")
        panel.axhline(level, color=INTERVAL, linestyle="--", linewidth=1.2, label=label)
        panel.axvspan(key["low"], key["high"], color=INTERVAL, alpha=0.15, linewidth=0)
        best = f"best: {key['best']:.4g}"
        panel.plot(key["best"], summary["misfit"], "*", color=BEST, markersize=12, label=best)
        panel.set_title(shortened(_interval(key)), fontsize=9)
        panel.set(xlabel=shortened(name), ylabel=f"misfit [{summary['unit']}]", ylim=(0.0, None))
        panel.grid(alpha=0.3)
        below = {"loc": "upper center", "bbox_to_anchor": (0.5, -0.16), "ncols": 3}
        panel.legend(fontsize=8, frameon=False, **below)
    return save(figure, out)
