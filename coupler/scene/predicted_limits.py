"""Predicted stability limits of a scene, held against the settings with which it runs."""

from typing import Any

from quintet.coupler.scene.quantity_texts import scene_in_si
from quintet.coupler.scene.read import parse
from quintet.coupler.scene.scene import Scene
from quintet.coupler.scene.stability_table import LimitTable
from quintet.coupler.scene.varied_tables import value_at
from quintet.interfaces.params import read, shown

# Parts of a scene that decide its stability.
DECISIVE = ("components", "links", "groups", "window", "scheme", "iteration")


def beyond_limits(scene: Scene) -> dict[str, str]:
    """Say by name which limits of a scene it runs beyond: those whose settings are the scene's."""
    beyond = {}
    is_read = not any(plan.unread for plan in scene.components.values())
    plain, _ = scene_in_si(parse(scene.path), scene.folder, imports=is_read)
    tables = plain.get("stability")
    for table in tables if isinstance(tables, list) else ():
        limit, _ = read(LimitTable, table, "stability") if isinstance(table, dict) else (None, [])
        if (
            limit is None
            or not isinstance(limit.parameter, str)
            or not _same(scene.resolved, plain, limit)
        ):
            continue
        value, wrong = value_at(scene.resolved, limit.parameter)
        predicted = _predicted(scene.resolved, limit)
        if wrong or predicted is None or not isinstance(value, (int, float)):
            continue
        margin = limit.accuracy * abs(predicted)
        past = value - predicted if limit.to > limit.from_ else predicted - value
        if past > margin:
            side = "at most" if limit.to > limit.from_ else "at least"
            beyond[limit.name or limit.parameter] = (
                f"{limit.parameter} must be {side} {predicted:.4g} for a stable run "
                f"({limit.source}); found {shown(value)}. Set it there."
            )
    return beyond


def _same(resolved: dict[str, Any], plain: dict[str, Any], limit: LimitTable) -> bool:
    """Whether a scene is the one for which a limit is predicted, but for the limit's parameters.

    That is the scene as its file has it, with the limit's settings.
    """
    varied = {limit.parameter, *([limit.against.parameter] if limit.against else [])}
    expected, actual = leaves(plain) | limit.settings, leaves(resolved)
    return all(
        actual.get(path) == expected.get(path)
        for path in actual.keys() | expected.keys()
        if path.partition(".")[0] in DECISIVE and path not in varied
    )


def leaves(tables: Any, path: str = "") -> dict[str, Any]:
    """Values of nested tables by their dotted paths; a list is a value if it has no tables."""
    if isinstance(tables, list) and any(isinstance(item, dict) for item in tables):
        tables = {str(number): item for number, item in enumerate(tables)}
    if not isinstance(tables, dict):
        return {path: tables}
    inner = [leaves(value, f"{path}.{key}" if path else key) for key, value in tables.items()]
    return {place: value for part in inner for place, value in part.items()}


def _predicted(resolved: dict[str, Any], limit: LimitTable) -> float | None:
    """Prediction for the scene's value of the second parameter, if there is one."""
    if not isinstance(limit.predicted, tuple):
        return limit.predicted
    if limit.against is None:
        return None
    value, _ = value_at(resolved, limit.against.parameter)
    pairs = zip(limit.against.values, limit.predicted, strict=True)
    return next((predicted for other, predicted in pairs if other == value), None)
