"""What a study or a sweep keeps of one run: errors against references, and costs."""

from typing import Any

from quintet.coupler.scene.study_table import Refinement

Row = dict[str, Any]


def row_of(refinement: Refinement, run: Row) -> Row:
    """Summarize the run of a refinement; times in s, memory in bytes, energy in J.

    `met` is None of a run without expectations.
    """
    timing = run.get("timing", {})
    components = timing.get("components", {})
    wall = timing.get("wall", 0.0)
    expected = run.get("expect", [])
    required = [outcome for outcome in expected if outcome["required"]]
    energy = {"energy": timing["energy"]} if "energy" in timing else {}
    return {
        "label": refinement.label,
        "settings": refinement.settings,
        "kind": refinement.kind,
        "size": refinement.size,
        "sizes": dict(refinement.sizes),
        "ladders": list(refinement.ladders),
        "status": run["status"],
        "met": all(outcome["met"] for outcome in required) if expected else None,
        **_judged(expected),
        "required": [outcome["name"] for outcome in required],
        "wall": wall,
        "cpu": sum(times["cpu"] for times in components.values()),
        "memory": timing.get("memory"),
        **energy,
        "overhead": (timing["exchange"] + timing["mapping"]) / wall if wall else None,
        "exchange": timing.get("exchange"),
        "mapping": timing.get("mapping"),
        "items": sum(times["items"] for times in components.values()),
        "components": components,
    }


def _judged(outcomes: list[Row]) -> Row:
    """What expectations gave, by their names."""
    names = [outcome["name"] for outcome in outcomes]
    columns = {
        "errors": map(error_of, outcomes),
        "relative": map(relative_error, outcomes),
        "scales": (outcome.get("scale") for outcome in outcomes),
        "values": (outcome["value"] for outcome in outcomes),
        "references": (outcome["reference"] for outcome in outcomes),
        "within": (outcome["within"] for outcome in outcomes),
        "units": (outcome["unit"] for outcome in outcomes),
    }
    return {key: dict(zip(names, column, strict=True)) for key, column in columns.items()}


def error_of(outcome: Row) -> float | None:
    """Distance of a value from its reference; None where the run has no value."""
    return None if outcome["value"] is None else abs(outcome["value"] - outcome["reference"])


def relative_error(outcome: Row) -> float | None:
    """The same over its scale; None where it has none."""
    error, scale = error_of(outcome), outcome.get("scale")
    return None if error is None or not scale else error / scale


def worst(row: Row, names: list[str]) -> float | None:
    """Largest relative error of some expectations; None where one of them has none."""
    errors = [row["relative"].get(name) for name in names]
    known = [error for error in errors if error is not None]
    return max(known) if known and len(known) == len(errors) else None
