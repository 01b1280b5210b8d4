"""The setting for a wanted error: the cheapest that was measured, else an extrapolated one.

An error is relative: over the scale of its expectation (its reference, or the size of the curve).
The largest one of all required expectations with a scale must not exceed what is wanted.
"""

import math
from collections.abc import Mapping, Sequence
from typing import Any

from quintet.coupler.scene.study_table import Refinement
from quintet.coupler.study.conclusion import stored
from quintet.coupler.study.row import worst

Row = dict[str, Any]
STEPS = 24  # sizes that are tried below the finest, four for each halving
DIGITS = 3  # significant, of extrapolated sizes and settings
CLOCK = 1e-6  # s
FIXED = ("expect.",)  # settings that are answers, and cannot be extrapolated


def choose(wanted: float, summary: Row, refinements: Sequence[Refinement]) -> Row:
    """Choose the setting for a wanted relative error.

    Returns
    -------
    dict
        `error` (the wanted one), `judged` and `left_out` (names of expectations), and either
        `measured` (label, settings, cpu [s], relative error), or `extrapolated` (settings, from
        which refinement and kind, predicted relative error and cpu [s]), or `reason`.
    """
    done = [row for row in summary["rows"] if row["status"] == "done" and row["errors"]]
    judged, left_out = judged_names(done)
    choice: Row = {"error": wanted, "judged": judged, "left_out": left_out}
    if not done:
        return choice | {"reason": "no refinement is done and has an error"}
    if not judged:
        return choice | {"reason": "no required expectation has a relative error"}
    good = [row for row in done if (worst(row, judged) or 0.0) <= wanted and _known(row, judged)]
    if good:
        row = min(good, key=lambda row: float(row["cpu"]))
        keys = ("label", "settings", "cpu", "wall")
        measured = {key: row[key] for key in keys} | {"relative": worst(row, judged)}
        return choice | {"measured": measured}
    by_label = {refinement.label: refinement for refinement in refinements}
    offers, reasons = [], []
    for kind in summary["kinds"]:
        offer = _extrapolate(wanted, kind, summary, by_label, judged)
        if isinstance(offer, str):
            reasons.append(f"{kind}: {offer}")
        else:
            offers.append(offer)
    if offers:
        return choice | {"extrapolated": min(offers, key=lambda offer: float(offer["cpu"]))}
    reasons = reasons or ["no refinement has a size"]
    return choice | {"reason": "; ".join(reasons)}


def judged_names(rows: Sequence[Row]) -> tuple[list[str], list[str]]:
    """Names of the required expectations that have a scale, and of those that have none."""
    names = list(dict.fromkeys(name for row in rows for name in row["required"]))
    has_scale = {n for row in rows for n, scale in row["scales"].items() if scale}
    return [n for n in names if n in has_scale], [n for n in names if n not in has_scale]


def _known(row: Row, names: list[str]) -> bool:
    return worst(row, names) is not None


def _extrapolate(
    wanted: float,
    kind: str,
    summary: Row,
    refinements: Mapping[str, Refinement],
    names: list[str],
) -> Row | str:
    """Extrapolate one kind beyond its finest refinement; return the offer, or why there is none."""
    rows = {row["label"]: row for row in summary["rows"]}
    ladder = [rows[label] for label in summary["kinds"][kind]["refinements"]]
    ladder = [row for row in ladder if _known(row, names)]
    coarser = [row for row in ladder if row["sizes"][kind] > ladder[-1]["sizes"][kind]]
    if not coarser:
        return "fewer than two sizes have an error"
    second, finest = coarser[-1], ladder[-1]
    h2, h1 = second["sizes"][kind], finest["sizes"][kind]
    trends = summary["kinds"][kind]
    for step in range(1, STEPS + 1):
        size = _rounded(h1 * 2.0 ** (-step / 4.0))
        errors = {name: predicted(name, size, finest, trends) for name in names}
        if max(errors.values()) <= wanted:
            break
    else:
        name = max(errors, key=lambda name: errors[name])
        return f"{name} would still be {100.0 * errors[name]:.2g} % off at a size of {size:g}"
    growth = math.log(_cpu(finest) / _cpu(second)) / math.log(h2 / h1)
    pair = refinements[second["label"]].varied, refinements[finest["label"]].varied
    settings = extrapolated_settings(*pair, math.log(size / h1) / math.log(h1 / h2))
    if isinstance(settings, str):
        return settings
    return {
        "kind": kind,
        "from": finest["label"],
        "size": size,
        "settings": settings,
        "relative": max(errors.values()),
        "cpu": _cpu(finest) * (h1 / size) ** max(growth, 0.0),
    }


def _cpu(row: Row) -> float:
    """Processor time, s; of a run too short to be measured the clock's resolution."""
    return max(float(row["cpu"]), CLOCK)


def predicted(name: str, size: float, finest: Row, kind: Row) -> float:
    """Relative error that is expected at a size: by the limit, the order, or as at the finest."""
    trend, scale = stored(kind, name), finest["scales"][name]
    if trend.limit is not None:
        error = abs(trend.limit.value + trend.limit.at(size) - finest["references"][name])
        return float(error / scale)
    if trend.order is not None and trend.order.order > 0.0:
        return float(trend.order.at(size) / scale)
    return float(finest["relative"][name])


def extrapolated_settings(
    second: Mapping[str, Any], finest: Mapping[str, Any], steps: float
) -> dict[str, Any] | str:
    """Continue settings as powers of the size, by so many steps from the second to the finest.

    Returns the settings, or why they cannot be continued.
    """
    settings = {}
    for path, last in finest.items():
        value = _continued(second.get(path), last, steps)
        if value is None or (path.startswith(FIXED) and value != last):
            return f"{path} cannot be continued from its last two values"
        settings[path] = value
    return settings


def _continued(before: Any, last: Any, steps: float) -> Any:
    """One value; None where there is no rule for it."""
    if before == last:
        return last
    if isinstance(last, list) and isinstance(before, list) and len(last) == len(before):
        parts = [_continued(*pair, steps) for pair in zip(before, last, strict=True)]
        return None if None in parts else parts
    if isinstance(last, dict) and isinstance(before, dict) and last.keys() == before.keys():
        table = {key: _continued(before[key], value, steps) for key, value in last.items()}
        return None if None in table.values() else table
    numbers = all(isinstance(v, (int, float)) and not isinstance(v, bool) for v in (before, last))
    if not numbers or not before * last > 0:
        return None
    value = last * (last / before) ** steps
    if isinstance(last, int) and isinstance(before, int):
        return math.ceil(value) if abs(last) > abs(before) else math.floor(value) or last
    return _rounded(value)


def _rounded(value: float) -> float:
    return float(f"{value:.{DIGITS}g}")
