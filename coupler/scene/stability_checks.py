"""Checks of stability limits against the scene whose parameters they vary."""

from collections.abc import Mapping
from dataclasses import dataclass

from quintet.coupler.measures.expectation import Expectation
from quintet.coupler.scene.stability_table import Bounds, Limit, LimitTable
from quintet.coupler.scene.varied_tables import MakeVariant, Table, read_tables, value_at
from quintet.interfaces.component import Port, fields_of
from quintet.interfaces.params import shown, unknown

FEWEST_WINDOWS = 20  # in a run whose window is varied: windows are whole, so the last is rounded


@dataclass(frozen=True, slots=True)
class Scope:
    """Parts of the scene that a stability limit may refer to."""

    end: float  # s
    gives: Mapping[str, tuple[Port, ...]]  # ports that each component gives
    links: int
    expected: Mapping[str, Expectation]  # by name
    unread: frozenset[str] = frozenset()  # components whose ports are not known


def read_limits(
    tables: list[Table], make_variant: MakeVariant, scope: Scope | None
) -> tuple[list[Limit], list[str]]:
    """Check the limits of a scene; without a scope only their form."""
    limits: list[Limit] = []
    mistakes: list[str] = []
    for place, table in read_tables(LimitTable, "stability", "name", tables, mistakes):
        if scope is None:
            continue
        paths = [table.parameter] if isinstance(table.parameter, str) else list(table.parameter)
        name = table.name or " ".join(paths)
        if name in {limit.name for limit in limits}:
            mistakes.append(f"{place}: two limits have the name {name}. Give each its own.")
        limit, wrong = _limit(table, name, scope, make_variant)
        wrong += _check_references(table, scope) or _check_ends(limit, make_variant)
        mistakes += [f"{place}: {mistake}" for mistake in dict.fromkeys(wrong)]
        limits.append(limit)
    return limits, mistakes


def _limit(
    table: LimitTable, name: str, scope: Scope, make_variant: MakeVariant
) -> tuple[Limit, list[str]]:
    if isinstance(table.parameter, str):
        return Limit(table, name, table.end or scope.end), []
    variant, mistakes = make_variant(table.settings)
    scaled = {}
    for path in table.parameter:
        value, wrong = value_at(variant, path)
        if not wrong and (isinstance(value, bool) or not isinstance(value, (int, float))):
            wrong = f"{path} must be a number to be scaled; found {shown(value)}. Name another."
        mistakes += [wrong] if wrong else []
        scaled[path] = 1.0 if wrong else float(value)
    return Limit(table, name, table.end or scope.end, scaled), mistakes


def _check_ends(limit: Limit, make_variant: MakeVariant) -> list[str]:
    """Check the scene at both ends of the range."""
    table, mistakes = limit.table, []
    for other in limit.others():
        for value in (table.from_, table.to):
            mistakes += make_variant(limit.settings(value, other))[1]
    if table.parameter == "window" and limit.end < FEWEST_WINDOWS * max(table.from_, table.to):
        mistakes.append(
            f"end must be {FEWEST_WINDOWS} windows or more, as windows are whole; found "
            f"{limit.end:g} s for windows up to {max(table.from_, table.to):g} s. Raise end."
        )
    return mistakes


def _check_references(table: LimitTable, scope: Scope) -> list[str]:
    """Check that the links, expectations and fields that an invariant names exist."""
    mistakes = []
    if table.momentum is not None and not (scope.links or scope.unread):
        mistakes.append("momentum is that of links; the scene has none. Remove it.")
    for name in table.expectation:
        if name not in scope.expected:
            mistakes.append(unknown(f"expectation {name}", name, scope.expected))
    for bounds in table.bounds:
        mistakes += _bounds(bounds, scope)
    return mistakes


def _bounds(bounds: Bounds, scope: Scope) -> list[str]:
    if bounds.component not in scope.gives:
        return [unknown(f"bounds.component {bounds.component}", bounds.component, scope.gives)]
    if bounds.component in scope.unread:
        return []
    fields = fields_of(scope.gives[bounds.component])
    if bounds.field not in fields:
        return [unknown(f"bounds.field {bounds.field}", bounds.field, fields)]
    field, wrong = fields[bounds.field], []
    if field.centring == "impulse":
        wrong.append(f"bounds.field {bounds.field} must be an instant; it is an impulse.")
    if bounds.axis is not None and bounds.axis >= sum(field.shape):
        wrong.append(f"bounds.axis must be below {sum(field.shape)}; found {bounds.axis}.")
    if bounds.low is None and bounds.high is None:
        wrong.append("bounds must have low or high; found neither. Give one.")
    return wrong
