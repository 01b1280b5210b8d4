"""Results of an ensemble: a table for the screen, one for programs, a picture."""

import csv
import io
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from rich.table import Table

from quintet.coupler.files.disk import write_whole
from quintet.coupler.measures.ensemble_statistics import Band
from quintet.coupler.measures.expectation import DISTANCES
from quintet.coupler.measures.time_series import Curve
from quintet.coupler.report.comparison import shortened
from quintet.coupler.report.panels import can_draw, curve_panels, save

RUN, MEDIAN, REFERENCE = "tab:blue", "navy", "tab:orange"
FAINT = 0.25  # opacity of the curve of a run
BINS = (5, 20)  # fewest and most bars of a histogram
Row = Mapping[str, Any]


def table(rows: Sequence[Row]) -> Table:
    """One row for each expectation: statistics, reference, and whether it lies inside."""
    screen_table = Table(box=None, pad_edge=False)
    heads = ("quantity", "runs", "mean", "95 % of mean", "deviation", "5 % to 95 %", "reference")
    for head in (*heads, "inside"):
        screen_table.add_column(head, justify="left" if head == "quantity" else "right")
    for row in rows:
        quantiles = row.get("quantiles") or {}
        band = [quantiles[key] for key in ("0.05", "0.95")] if quantiles else None
        reference = f"{row['reference']:.4g}"
        if row["reference_deviation"] is not None:
            reference += f" ± {row['reference_deviation']:.3g}"
        screen_table.add_row(
            f"{row['name']} [{row['unit']}]", str(row["count"]), _number(row["mean"]),
            _span(row.get("interval")), _number(row["deviation"]), _span(band),
            "curve" if row["measure"] in DISTANCES else reference, _inside(row),
        )  # fmt: skip
    return screen_table


def origins_table(rows: Sequence[Row]) -> Table:
    """What the spread of each quantity comes from: a row for each input, and one for the rest."""
    screen_table = Table(box=None, pad_edge=False)
    heads = ("spread of", "from", "slope", "95 %", "of variance", "reference met at", "within")
    for head in heads:
        screen_table.add_column(head, justify="left" if head in heads[:2] else "right")
    for row in rows:
        explained = row.get("origins")
        if explained is None:
            continue
        for number, effect in enumerate(explained["effects"]):
            screen_table.add_row(
                f"{row['name']} [{row['unit']}]" if number == 0 else "",
                effect["name"] + (f" [{effect['unit']}]" if effect["unit"] != "1" else ""),
                _number(effect["slope"]), _span(effect["interval"]), f"{effect['share']:.0%}",
                _number(effect["met_at"]), _span(effect["met_between"]),
            )  # fmt: skip
        rest = f"{explained['remainder_share']:.0%}"
        screen_table.add_row("", "what they do not explain", "", "", rest, "", "")
    return screen_table


def _number(value: float | None) -> str:
    return "-" if value is None else f"{value:.4g}"


def _span(ends: Sequence[float] | None) -> str:
    return "-" if ends is None else f"{ends[0]:.4g} to {ends[1]:.4g}"


def _inside(row: Row) -> str:
    """Whether the reference lies between the quantiles; of a curve how much of it."""
    if row["inside"] is None:
        return "-"
    if row["measure"] in DISTANCES or row["inside"] not in (0.0, 1.0):
        return f"{row['inside']:.0%} of its points"
    return "yes" if row["inside"] else "no"


def write_statistics(rows: Sequence[Row], path: Path) -> None:
    """Write the statistics of all expectations, a row each."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    quantiles = list(next((row["quantiles"] for row in rows if row.get("quantiles")), {}))
    writer.writerow(
        ["name", "unit", "runs", "mean", "deviation", "mean from", "mean to"]
        + [f"quantile {quantile}" for quantile in quantiles]
        + ["reference", "deviation of the reference", "within", "inside"]
    )
    for row in rows:
        cells = [row[key] for key in ("name", "unit", "count", "mean", "deviation")]
        cells += row.get("interval") or [None, None]
        cells += [(row.get("quantiles") or {}).get(quantile) for quantile in quantiles]
        keys = ("reference", "reference_deviation", "within", "inside")
        writer.writerow([*cells, *(row[key] for key in keys)])
    write_whole(path, text.getvalue())


def draw(
    rows: Sequence[Row],
    values: Sequence[Row],
    curves: Mapping[str, Sequence[Curve]],
    bands: Mapping[str, Band | None],
    references: Mapping[str, Curve],
    out: Path,
    title: str = "",
) -> Path | None:
    """Draw a panel for each expectation: curves beside that of a file, else a histogram.

    Parameters
    ----------
    rows : sequence of dict
        Statistics, one of each expectation.
    values : sequence of dict
        Values of the expectations by name, of each run that is done.
    curves, bands, references
        By the name of the expectation.
    out : Path
    title : str

    Returns
    -------
    Path or None
        `out`, or None where there is nothing to be drawn, or nothing can draw.
    """
    rows = [row for row in rows if row["count"]]
    if not rows or not can_draw():
        return None
    figure, panels = curve_panels(len(rows), title)
    for panel, row in zip(panels, rows, strict=True):
        name = row["name"]
        computed = bands.get(name)
        if computed is not None:
            _draw_curves(panel, row, curves[name], computed, references[name])
        else:
            _draw_histogram(panel, row, [v[name] for v in values if v.get(name) is not None])
        panel.set_title(_headline(row), fontsize=9)
        panel.grid(alpha=0.3)
        below = {"loc": "upper center", "bbox_to_anchor": (0.5, -0.14), "ncols": 2}
        panel.legend(fontsize=8, frameon=False, **below)
    return save(figure, out)


def _headline(row: Row) -> str:
    text = f"{row['name']}: mean {row['mean']:.4g}"
    if row["deviation"] is not None:
        text += f", standard deviation {row['deviation']:.3g}"
    return f"{text} {row['unit']}" if row["unit"] != "1" else text


def _draw_curves(
    panel: Any, row: Row, curves: Sequence[Curve], computed: Band, reference: Curve
) -> None:
    for number, curve in enumerate(curves):
        label = f"{len(curves)} runs" if number == 0 else None
        panel.plot(*curve, color=RUN, linewidth=0.6, alpha=FAINT, label=label)
    span = (computed.times, computed.low, computed.high)
    panel.fill_between(*span, color=RUN, alpha=0.25, linewidth=0, label="5 % to 95 % of the runs")
    panel.plot(computed.times, computed.median, color=MEDIAN, linewidth=1.5, label="their median")
    seen = reference.times <= 1.05 * computed.times[-1]
    panel.plot(
        reference.times[seen], reference.values[seen], "o", color="black", markersize=3.5,
        fillstyle="none", label=shortened(row["source"]),
    )  # fmt: skip
    unit = f" [{row['unit']}]" if row["measure"] == "rms" else ""
    panel.set(xlabel="t [s]", ylabel=shortened(f"{row['quantity'] or row['name']}{unit}"))


def _draw_histogram(panel: Any, row: Row, values: Sequence[float]) -> None:
    bars = min(max(round(len(values) ** 0.5) + 1, BINS[0]), BINS[1])
    panel.hist(values, bins=bars, color=RUN, alpha=0.45, label=f"{len(values)} runs")
    panel.plot(values, [0.0] * len(values), "|", color=MEDIAN, markersize=14)
    panel.axvline(row["mean"], color=MEDIAN, linewidth=1.5, label="mean, and its 95 % interval")
    if row["interval"]:
        panel.axvspan(*row["interval"], color=MEDIAN, alpha=0.15, linewidth=0)
    if row["measure"] in DISTANCES:
        panel.axvline(row["within"], color=REFERENCE, linestyle="--", label="tolerance")
    else:
        reference, spread = row["reference"], row["reference_deviation"]
        half = row["within"] if spread is None else spread
        band = "tolerance" if spread is None else "standard deviation"
        label = shortened(f"{row['source']}, ± {band}")
        panel.axvline(reference, color=REFERENCE, linewidth=1.5, label=label)
        panel.axvspan(reference - half, reference + half, color=REFERENCE, alpha=0.2, linewidth=0)
    panel.set(xlabel=f"{row['name']} [{row['unit']}]", ylabel="runs")
    panel.yaxis.get_major_locator().set_params(integer=True)
