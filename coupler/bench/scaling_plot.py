"""Efficiency over ranks: measured filled, extrapolated hollow, published figures beside."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from quintet.coupler.bench.predictions import (
    RANKS,
    efficiency,
    measured_efficiencies,
    measured_sizes,
)
from quintet.coupler.bench.published import PUBLISHED
from quintet.coupler.bench.scaling import Scaling
from quintet.coupler.report.panels import can_draw, curve_panels, save

COLOURS = {"LOGOS": "tab:red", "SWIFT": "tab:green"}


def draw(scalings: Sequence[Scaling], out: Path) -> Path | None:
    """Draw a panel of strong and one of weak scaling for each; None where nothing can draw."""
    if not can_draw():
        return None
    figure, panels = curve_panels(2 * len(scalings), "parallel efficiency")
    pairs = [(scaling, kind) for scaling in scalings for kind in ("strong", "weak")]
    for panel, (scaling, kind) in zip(panels, pairs, strict=True):
        _draw(panel, scaling, kind)
    return save(figure, out)


def _draw(panel: Any, scaling: Scaling, kind: str) -> None:
    last = scaling.model.measured_ranks
    blue: dict[str, Any] = {"color": "tab:blue", "markersize": 6, "linestyle": "none"}
    for items in measured_sizes(scaling, kind)[-1:]:
        measured = measured_efficiencies(scaling, kind, items)
        efficiencies = [value for _, value in measured]
        panel.semilogx(
            [ranks for ranks, _ in measured],
            _percent(efficiencies),
            "o",
            label=f"measured, {items} items" + (" a rank" if kind == "weak" else ""),
            **blue,
        )
    for ranks, style, label in (
        (np.unique(np.geomspace(1, last, 8).round().astype(int)), "-", "model"),
        (np.unique(np.geomspace(last, max(RANKS), 40).round().astype(int)), "--", ""),
    ):
        curve = [efficiency(scaling, kind, int(p)) for p in ranks]
        panel.semilogx(ranks, _percent(curve), style, color="tab:blue", label=label or None)
    hollow = [efficiency(scaling, kind, p) for p in RANKS]
    panel.semilogx(
        RANKS, _percent(hollow), "o", fillstyle="none", label="extrapolated by the model", **blue
    )
    panel.axvline(last, color="grey", linewidth=0.8, linestyle=":")
    panel.annotate(
        "measured | extrapolated",
        (last, 0.97),
        xycoords=("data", "axes fraction"),
        ha="center",
        va="top",
        fontsize=7,
        color="grey",
    )
    for published in PUBLISHED:
        if published.scaling == kind:
            look: dict[str, Any] = {"color": COLOURS[published.code], "alpha": 0.6}
            label = f"{published.code}: {published.text}"
            if published.within:
                low, high = _percent(published.efficiency)
                panel.fill_between(published.cores, low, high, label=label, **look)
            else:
                panel.semilogx(
                    published.cores, _percent(published.efficiency), "s:", label=label, **look
                )
    size = f"{scaling.items:.3g} items" if kind == "strong" else f"{scaling.each:.3g} items a rank"
    panel.set_title(f"{scaling.kind}, {scaling.series}: {kind} scaling, {size}", fontsize=9)
    panel.set(xlabel="ranks", ylabel="efficiency [%]", ylim=(0, 120))
    panel.grid(which="both", alpha=0.3)
    panel.legend(fontsize=7, loc="lower left")


def _percent(values: Sequence[float]) -> list[float]:
    return [100.0 * value for value in values]
