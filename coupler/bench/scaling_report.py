"""Cost models on the screen: what was measured, the fit, the network, what is extrapolated."""

import argparse
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from rich.table import Table

from quintet.coupler.bench.cost_model import Terms
from quintet.coupler.bench.predictions import (
    RANKS,
    efficiency,
    entry_of,
    measured_efficiencies,
    predict_run,
)
from quintet.coupler.bench.published import PUBLISHED
from quintet.coupler.bench.scaling import Scaling
from quintet.coupler.bench.scaling_plot import draw
from quintet.coupler.report.show import console
from quintet.interfaces.errors import SceneError

KEYS = ("name", "case", "rate")  # of an entry
ENDINGS = (".png", ".svg", ".pdf")
FEW = 1000.0  # items of a rank, below which its halo is larger than all that it has
Run = tuple[float, int, int, int]


def report(scalings: Sequence[Scaling], options: argparse.Namespace) -> list[dict[str, Any]]:
    """Print models and predictions, draw them where asked; return them as entries of JSON."""
    refuse(options)
    run, screen, entries = run_of(options), console(), []
    for scaling in scalings:
        entries.append(entry_of(scaling))
        screen.print(f"\n{scaling.kind}, {scaling.series}: measured", style="bold")
        screen.print(measured_table(scaling))
        for line in sentences(scaling):
            screen.print(line)
        screen.print(f"\n{scaling.kind}, {scaling.series}: extrapolated", style="bold")
        screen.print(predicted_table(scaling))
        if run:
            entries[-1]["run"] = predict_run(scaling, run)
            screen.print(run_sentence(entries[-1]["run"]))
    for published in PUBLISHED:
        line = f"{published.code}, {published.scaling} scaling: {published.text}"
        screen.print(f"published: {line} ({published.source})")
    if options.plot and draw(scalings, options.plot):
        screen.print(f"drawn: {options.plot}")
    return entries


def refuse(options: argparse.Namespace) -> None:
    """Raise where options cannot be, before anything is measured for them."""
    run_of(options)
    plot: Path | None = options.plot
    if plot and plot.suffix not in ENDINGS:
        raise SceneError(
            f"--plot {plot}: it must end in {', '.join(ENDINGS)}; found {plot.suffix or 'nothing'}."
        )
    if plot and (plot.is_dir() or not plot.parent.is_dir()):
        raise SceneError(f"--plot {plot}: it must be a file in a folder that exists.")


def run_of(options: argparse.Namespace) -> Run | None:
    """Seconds of a step, ranks that took it, ranks that are asked for, and steps; None: no run."""
    asked = {
        "--step": options.step,
        "--measured-on": options.measured_on,
        "--on": options.on,
        "--steps": options.steps,
    }
    if all(value is None for value in asked.values()):
        return None
    if missing := [name for name, value in asked.items() if value is None]:
        raise SceneError(
            f"the time of a run needs --step, --measured-on, --steps and --on; {missing[0]} is "
            "missing. Give it."
        )
    if not options.items:
        raise SceneError("the time of a run needs its number of items. Give --items.")
    return options.step, options.measured_on, options.on, options.steps


def measured_table(scaling: Scaling) -> Table:
    """One row for each measurement, the model's time beside it."""
    columns = (
        "items",
        "ranks",
        "compute [ms]",
        "imbalance",
        "messages",
        "halo [kB]",
        "collectives",
        "gathered [kB]",
        "step [ms]",
        "model [ms]",
        "off",
        "by the clock [ms]",
    )
    table = _empty(columns)
    for m in scaling.measurements:
        step, model = scaling.measured(m).total, scaling.fitted(m).total
        shared = "*" if m.ranks > scaling.cores else ""
        table.add_row(
            str(m.items),
            f"{m.ranks}{shared}",
            f"{1e3 * m.compute:.4g}",
            f"{m.imbalance:.3f}",
            f"{m.messages:.1f}",
            f"{1e-3 * m.halo:.4g}",
            f"{m.collectives:.1f}",
            f"{1e-3 * m.gathered:.4g}",
            f"{1e3 * step:.4g}",
            f"{1e3 * model:.4g}",
            f"{model / step - 1.0:+.1%}",
            f"{1e3 * m.clock:.4g}{shared}",
        )
    return table


def sentences(scaling: Scaling) -> Iterator[str]:
    """What the figures of the two tables are, and are not."""
    model, here, network = scaling.model, scaling.here, scaling.network
    yield (
        "step: compute by processor time of a rank without waiting, times imbalance, and counted "
        "messages on the assumed network; counts are a step's, of the rank with most"
    )
    if any(m.ranks > scaling.cores for m in scaling.measurements):
        yield (
            f"*: more ranks than the {scaling.cores} cores of this host, which they share: compute "
            "is by processor time, and the clock does not count"
        )
    yield (
        f"fit: {1e6 * model.per_item:.3g} µs an item, {1e9 * model.per_halo_byte:.3g} ns a byte of "
        f"halo, {1e6 * model.per_step:.3g} µs a step; {len(scaling.measurements)} measurements, "
        f"{len(scaling.measurements) - model.free} numbers"
    )
    left = ", ".join(f"{name} {value:.1%}" for name, value in model.residuals.items())
    yield f"residual (rms of model over measurement, less 1): {left}"
    if len({m.items for m in scaling.measurements}) == 1:
        yield (
            "one number of items: what a step takes whatever its items is not fitted, and taken as "
            "0. Measure a series of several"
        )
    if not measured_efficiencies(scaling, "weak", scaling.each):
        yield (
            f"weak scaling: no case has about {scaling.each:.4g} items on each of several ranks; "
            "all of it is the model's"
        )
    yield (
        f"imbalance beyond {model.measured_ranks} ranks: {model.imbalance:.3f}, as measured on "
        f"{model.measured_ranks}"
    )
    for name, unit, scale in (("latency", "µs", 1e6), ("bandwidth", "GB/s", 1e-9)):
        value, measured = getattr(network, name), getattr(here, name)
        how = "as measured between two ranks of this host, no network"
        if name in scaling.assumed:
            how = f"as given by --{name}; measured on this host: {scale * measured:.3g} {unit}"
        yield f"network, {name}: {scale * value:.3g} {unit} ({how})"


def predicted_table(scaling: Scaling) -> Table:
    """One row for each number of ranks: measured efficiency, or what the model predicts."""
    columns = (
        "ranks",
        "",
        f"strong, {scaling.items:.4g} items: each",
        "step [ms]",
        "efficiency",
        *Terms._fields,
        f"weak, {scaling.each:.4g} items each: step [ms]",
        "efficiency",
    )
    table = _empty(columns)
    strongly = dict(measured_efficiencies(scaling, "strong", scaling.items))
    weakly = dict(measured_efficiencies(scaling, "weak", scaling.each))
    for ranks in sorted({m.ranks for m in scaling.measurements} | set(RANKS)):
        strong = scaling.terms(scaling.items, ranks)
        weak = scaling.terms(scaling.each * ranks, ranks)
        few = "!" if scaling.items / ranks < FEW else ""
        table.add_row(
            str(ranks),
            "extrapolated" if ranks > scaling.model.measured_ranks else "model",
            f"{scaling.items / ranks:.4g}{few}",
            f"{1e3 * strong.total:.4g}",
            _percent(efficiency(scaling, "strong", ranks), strongly.get(ranks)),
            *(f"{part / strong.total:.1%}" for part in strong),
            f"{1e3 * weak.total:.4g}",
            _percent(efficiency(scaling, "weak", ranks), weakly.get(ranks)),
        )
    return table


def _percent(predicted: float, measured: float | None) -> str:
    text = f"{predicted:.1%}"
    return f"{text} (measured {measured:.1%})" if measured is not None else text


def run_sentence(run: dict[str, Any]) -> str:
    """Time of a run, as `predict_run` gives it."""
    seconds, ranks = run["seconds"], run["measured_ranks"]
    hours, measured = seconds / 3600.0, f"{ranks} rank{'s' if ranks > 1 else ''}"
    return (
        f"a run of {run['items']:.4g} items that took {run['measured_step']:.3g} s a step on "
        f"{measured} (measured): {1e3 * run['step']:.3g} ms a step on "
        f"{run['ranks']} ranks, {run['steps']} steps in {seconds:.4g} s ({hours:.3g} h); "
        f"{run['efficiency']:.1%} efficiency against {measured} (extrapolated)"
    )


def _empty(columns: Sequence[str]) -> Table:
    table = Table(box=None, pad_edge=False)
    for column in columns:
        table.add_column(column, justify="right", overflow="fold")
    return table
