"""Figures of a report, as SVG: energies and work over time, and where the time went.

Matplotlib is loaded by the functions that draw: a run without a report does not need it.
"""

import io
from collections.abc import Mapping
from typing import Any

import numpy as np

from quintet.coupler.report.panels import CURVES, curve_panels, take_literally
from quintet.coupler.report.recorded import Series

ENERGIES = {"kinetic": "tab:blue", "potential": "tab:green", "internal": "tab:red"}
WORKS = {"work_given": "tab:blue", "work_taken": "tab:orange"}
RESIDUALS = {"momentum_residual": "momentum", "angular_residual": "angular momentum"}
PARTS = {"build": "#9aa5ad", "compute": "#4c78a8", "wait": "#f0c987"}  # of a run's wall time
ROW = 0.35  # inches, of a bar
MOST = 24  # panels of one figure
Ledger = Mapping[str, Mapping[str, Series]]


def energies(ledger: Ledger) -> str:
    """How the energies of the components have changed since the start, over time."""
    with_energy = {
        name: columns
        for name, columns in ledger.items()
        if any(np.any(columns[key].values) for key in ENERGIES if key in columns)
    }
    if not with_energy:
        return ""
    figure, panels = curve_panels(len(list(with_energy)[:MOST]))
    for panel, (name, columns) in zip(panels, with_energy.items(), strict=False):
        for key, colour in ENERGIES.items():
            if key in columns and np.any(columns[key].values):
                times, values = columns[key].times, columns[key].values
                panel.plot(times, values - values[0], color=colour, label=key)
        times, total = _sum(columns)
        label = "all, less the work from outside"
        panel.plot(times, total - total[0], color="black", linestyle="--", label=label)
        _finish(panel, name, "change of energy [J]")
    return _svg(figure)


def _sum(columns: Mapping[str, Series]) -> tuple[Any, Any]:
    """All energy of a component less the work that was done on it from outside of the run [J]."""
    parts = [columns[key] for key in ENERGIES if key in columns]
    total = np.sum([part.values for part in parts], axis=0)
    if "work" in columns and len(columns["work"]) == len(total):
        total = total - columns["work"].values
    return parts[0].times, total


def links(ledger: Ledger) -> str:
    """Work of each link as both sides count it, and what its residuals are, over time."""
    with_work = {name: columns for name, columns in ledger.items() if "work_given" in columns}
    if not with_work:
        return ""
    shown = list(with_work.items())[: MOST // 2]
    figure, panels = curve_panels(2 * len(shown))
    for place, (name, columns) in enumerate(shown):
        work, residual = panels[2 * place], panels[2 * place + 1]
        for key, colour in WORKS.items():
            if key in columns:
                label = key.replace("_", " ")
                work.plot(columns[key].times, columns[key].values, color=colour, label=label)
        _finish(work, name, "work [J]")
        for key, label in RESIDUALS.items():
            if key in columns and np.any(columns[key].values > 0.0):
                values = np.where(columns[key].values > 0.0, columns[key].values, np.nan)
                residual.semilogy(columns[key].times, values, label=label)
        _finish(residual, f"{name}: residuals of the sums", "relative")
    return _svg(figure)


def times_of(components: Mapping[str, Mapping[str, Any]]) -> str:
    """Bars of the wall time of each component: build, compute, wait."""
    if not components:
        return ""
    # A run without pictures does not load matplotlib.
    from matplotlib.figure import Figure

    figure = Figure(figsize=(2 * CURVES, 1.2 + ROW * len(components)), layout="constrained")
    panel, places = figure.subplots(), np.arange(len(components))
    begin = np.zeros(len(components))
    for part, colour in PARTS.items():
        seconds = np.array([float(times.get(part) or 0.0) for times in components.values()])
        panel.barh(places, seconds, left=begin, color=colour, label=part)
        begin += seconds
    panel.set_yticks(places, list(components))
    panel.invert_yaxis()
    panel.set_xlabel("wall time [s]")
    figure.legend(loc="outside upper right", ncols=len(PARTS), frameon=False, fontsize=8)
    return _svg(figure)


def _finish(panel: Any, title: str, label: str) -> None:
    panel.set_title(title, fontsize=9)
    panel.set(xlabel="t [s]", ylabel=label)
    panel.locator_params(axis="x", nbins=6)
    if panel.get_legend_handles_labels()[0]:
        panel.legend(fontsize=7, frameon=False)


def _svg(figure: Any) -> str:
    """A figure as SVG, of which equal figures have equal bytes."""
    # A run without pictures does not load matplotlib.
    from matplotlib import rc_context

    take_literally(figure)
    file = io.StringIO()
    with rc_context({"svg.hashsalt": "quintet", "path.simplify": True}):
        figure.savefig(file, format="svg", metadata={"Date": None})
    return file.getvalue()
