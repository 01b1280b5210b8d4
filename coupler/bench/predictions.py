"""What cost models predict beyond what was measured, kept apart from that; entries of JSON."""

import math
from dataclasses import asdict
from typing import Any

from quintet.coupler.bench.cost_model import (
    Measurement,
    of_run,
    strong_efficiency,
    weak_efficiency,
)
from quintet.coupler.bench.scaling import Scaling
from quintet.interfaces.errors import SceneError

RANKS = (24, 48, 96, 192, 512, 1024, 2048, 4096)  # that are predicted
NEAR = 0.1  # relative: numbers of items on a rank that count as the same


def entry_of(scaling: Scaling) -> dict[str, Any]:
    """Model and predictions as an entry of ``quintet bench --json``."""
    model = scaling.model
    return {
        "name": scaling.kind,
        "case": scaling.series,
        "rate": 1.0 / model.per_item if model.per_item else math.inf,
        "unit": scaling.unit,
        "model": asdict(model),
        "network": {
            "measured": scaling.here._asdict(),
            "assumed": scaling.network._asdict(),
            "as_given": list(scaling.assumed),
        },
        "cores": scaling.cores,
        "measured": [_measured_row(scaling, m) for m in scaling.measurements],
        "extrapolated": {
            "strong": {
                "items": scaling.items,
                "rows": [_row(scaling, "strong", p) for p in RANKS],
            },
            "weak": {
                "items_per_rank": scaling.each,
                "rows": [_row(scaling, "weak", p) for p in RANKS],
            },
        },
    }


def _measured_row(scaling: Scaling, m: Measurement) -> dict[str, Any]:
    terms, by_model = scaling.measured(m), scaling.fitted(m)
    return {
        **asdict(m),
        "step": terms.total,
        "model": by_model.total,
        "residual": by_model.total / terms.total - 1.0,
        "ranks_share_cores": m.ranks > scaling.cores,
    }


def _row(scaling: Scaling, kind: str, ranks: int) -> dict[str, Any]:
    items = scaling.items if kind == "strong" else scaling.each * ranks
    terms = scaling.terms(items, ranks)
    return {
        "ranks": ranks,
        "items": items,
        "step": terms.total,
        "terms": terms._asdict(),
        "efficiency": efficiency(scaling, kind, ranks),
    }


def efficiency(scaling: Scaling, kind: str, ranks: int) -> float:
    """Parallel efficiency by the model, of strong or weak scaling."""
    if kind == "strong":
        return strong_efficiency(scaling.model, scaling.network, scaling.items, ranks)
    return weak_efficiency(scaling.model, scaling.network, scaling.each, ranks)


def measured_efficiencies(scaling: Scaling, kind: str, items: float) -> list[tuple[int, float]]:
    """Ranks and efficiency, by measurements alone; none if there is none on several ranks.

    Of strong scaling `items` is that of all ranks, of weak scaling that of each: there it counts
    within a tenth, by time over items.
    """
    alone = [m for m in scaling.measurements if m.ranks == 1 and m.items == items]
    if not alone:
        return []
    first, result = scaling.measured(alone[0]).total, []
    for m in scaling.measurements:
        step, each = scaling.measured(m).total, m.items / m.ranks
        if kind == "strong" and m.items == items:
            result.append((m.ranks, first / (m.ranks * step)))
        if kind == "weak" and abs(each / items - 1.0) < NEAR:
            result.append((m.ranks, first / step * each / items))
    return result if len(result) > 1 else []


def measured_sizes(scaling: Scaling, kind: str) -> list[int]:
    """Numbers of items, rising, of which an efficiency on several ranks was measured."""
    sizes = {m.items for m in scaling.measurements}
    return sorted(items for items in sizes if measured_efficiencies(scaling, kind, items))


def predict_run(scaling: Scaling, run: tuple[float, int, int, int]) -> dict[str, Any]:
    """Time of a run, from a measured step of its component."""
    step, measured, ranks, steps = run
    try:
        terms = of_run(scaling.model, scaling.network, scaling.items, step, measured, ranks)
    except ValueError as error:
        raise SceneError(f"--step {step:g}: {error}. Give the time [s] of a whole step.") from error
    return {
        "items": scaling.items,
        "measured_step": step,
        "measured_ranks": measured,
        "ranks": ranks,
        "steps": steps,
        "step": terms.total,
        "terms": terms._asdict(),
        "seconds": steps * terms.total,
        "efficiency": step * measured / (ranks * terms.total),  # against the measured ranks
    }
