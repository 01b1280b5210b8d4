"""Whether a control is rejected: its distance from the reference, over the tolerance."""

import math
from collections.abc import Iterable, Mapping
from typing import Any

from quintet.coupler.run import results

REJECTED, PASSES = "rejected", "PASSES"
BASE_REJECTED, FAILED, NONE = "BASE REJECTED", "FAILED", "NO CONTROL"
INTERRUPTED = "interrupted"
STATUS = {  # exit status of each verdict
    REJECTED: results.DONE,
    PASSES: results.UNMET,
    BASE_REJECTED: results.UNMET,
    NONE: results.UNMET,
    FAILED: results.FAILED,
    INTERRUPTED: results.INTERRUPTED,
}
Row = dict[str, Any]


def margin(outcome: Mapping[str, Any]) -> float | None:
    """Return |value - reference| over the tolerance; None where the run has no value.

    Above 1 the expectation rejects the run. With a tolerance of 0 it is infinite or 0.
    """
    if outcome["value"] is None:
        return None
    distance = abs(outcome["value"] - outcome["reference"])
    if outcome["within"] == 0.0:
        return math.inf if distance else 0.0
    return float(distance / outcome["within"])


def judge(control: str, name: str, run: Row, base: Row | None) -> Row:
    """Judge one expectation by the run of a control.

    Parameters
    ----------
    control : str
        Name of the control.
    name : str
        Of the expectation.
    run, base : dict
        Results of its run, and of that of its preset alone.
    """
    outcome, base_outcome = _outcome(run, name), _outcome(base, name) if base else None
    distance = margin(outcome) if outcome else None
    base_distance = margin(base_outcome) if base_outcome else None
    keys = ("value", "reference", "within", "unit")
    return {
        "expectation": name,
        "control": control,
        **{key: outcome[key] if outcome else None for key in keys},
        "margin": _finite(distance),
        "base_margin": _finite(base_distance),
        **_verdict(run, base, distance, base_distance),
    }


def _finite(number: float | None) -> float | None:
    """Return a number that JSON has: it has no infinity."""
    return None if number is None or math.isinf(number) else number


def without_control(name: str) -> Row:
    """Row of an expectation that no control names."""
    keys = ("value", "reference", "within", "unit", "margin", "base_margin")
    unknown = dict.fromkeys(keys)
    cause = "no control names it. Add a [[control]] that it must reject."
    return {"expectation": name, "control": "", **unknown, "verdict": NONE, "cause": cause}


def _outcome(run: Row, name: str) -> Row | None:
    outcomes = [outcome for outcome in run.get("expect") or [] if outcome["name"] == name]
    return outcomes[0] if run["status"] == "done" and outcomes else None


def _verdict(
    run: Row, base: Row | None, distance: float | None, base_distance: float | None
) -> Row:
    for subject, result in (("its run", run), ("the run of its preset alone", base)):
        if result is not None and result["status"] != "done":
            interrupted = result["status"] in ("interrupted", "not run")
            verdict = INTERRUPTED if interrupted else FAILED
            cause = (result.get("fault") or {}).get("cause") or result["status"]
            return {"verdict": verdict, "cause": f"{subject} is not done: {cause}"}
    if distance is None:
        cause = "the run has no value of it, so nothing is rejected. Find another control."
        return {"verdict": PASSES, "cause": cause}
    if distance <= 1.0:
        cause = (
            "a tolerance that its control passes is too wide. Tighten it to what the scene "
            "reaches, or find a control that it rejects."
        )
        return {"verdict": PASSES, "cause": cause}
    if base is not None and (base_distance is None or base_distance > 1.0):
        cause = (
            "the preset does not meet it without the settings of the control either, so they show "
            "nothing. Choose another preset, or none."
        )
        return {"verdict": BASE_REJECTED, "cause": cause}
    return {"verdict": REJECTED, "cause": ""}


def status_of(rows: Iterable[Row]) -> int:
    """Exit status: 130 if interrupted, 3 if a run failed, 1 if a control is not rejected."""
    statuses = {STATUS[row["verdict"]] for row in rows}
    for status in (results.INTERRUPTED, results.FAILED, results.UNMET):
        if status in statuses:
            return status
    return results.DONE
