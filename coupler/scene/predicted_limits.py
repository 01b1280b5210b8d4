"""Predicted stability limits of a scene, held against the settings with which it runs."""

from typing import Any

from quintet.coupler.scene.read import parse
from quintet.coupler.scene.scene import Scene
from quintet.coupler.scene.stability_table import LimitTable
from quintet.coupler.scene.study_table import value_at
from quintet.interfaces.params import read, shown

FREE = ("end", "transport", "expect", "output")  # settings that decide no stability


def beyond_limits(scene: Scene) -> dict[str, str]:
    """Say by name which limits of a scene it runs beyond: those whose settings are the scene's."""
    found = {}
    tables = parse(scene.path).get("stability")
    for table in tables if isinstance(tables, list) else ():
        one, _ = read(LimitTable, table, "stability") if isinstance(table, dict) else (None, [])
        if one is None or not isinstance(one.parameter, str) or not _same(scene.resolved, one):
            continue
        value, wrong = value_at(scene.resolved, one.parameter)
        predicted = _predicted(scene.resolved, one)
        if wrong or predicted is None or not isinstance(value, (int, float)):
            continue
        margin = one.accuracy * abs(predicted)
        past = value - predicted if one.to > one.from_ else predicted - value
        if past > margin:
            side = "at most" if one.to > one.from_ else "at least"
            found[one.name or one.parameter] = (
                f"{one.parameter} must be {side} {predicted:.4g} for a stable run ({one.source}); "
                f"found {shown(value)}. Set it there."
            )
    return found


def _same(resolved: dict[str, Any], limit: LimitTable) -> bool:
    """Whether a scene has the settings for which a limit is predicted."""
    parts = {path: path.partition(".")[0] for path in limit.settings}
    return all(
        value_at(resolved, path)[0] == value
        for path, value in limit.settings.items()
        if parts[path] not in FREE
    )


def _predicted(resolved: dict[str, Any], limit: LimitTable) -> float | None:
    """Prediction for the scene's value of the second parameter, if there is one."""
    if not isinstance(limit.predicted, tuple):
        return limit.predicted
    if limit.against is None:
        return None
    value, _ = value_at(resolved, limit.against.parameter)
    pairs = zip(limit.against.values, limit.predicted, strict=True)
    return next((predicted for other, predicted in pairs if other == value), None)
