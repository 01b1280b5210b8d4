"""``[[stability]]``: a parameter varied to its stability limit, and the invariants that define it.

    [[stability]]
    parameter = "components.spring.step"
    from = 0.01                # stable
    to = 1.0                   # unstable
    log = true
    predicted = 0.2
    source = "explicit: 2/ω"
    energy = { factor = 2.0 }

`from` need not be the smaller one. Several paths are scaled together: each is its value in the
scene times the parameter, which is then a factor. A run that fails is always unstable.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Annotated, Any, Literal

import pydantic

from quintet.coupler.measures.expectation import Expectation, Index
from quintet.coupler.scene.study_table import MakeVariant, Table, folder_name, value_at
from quintet.interfaces.component import Port
from quintet.interfaces.params import (
    NotNegative,
    Number,
    Positive,
    parameters,
    read,
    shown,
    unknown,
)

SAMPLES = 200  # rows of the ledger in a short run
FEWEST_WINDOWS = 20  # in a run whose window is varied: windows are whole, so the last is rounded


@parameters
class Energy:
    """Largest growth of the total energy since the start.

    Parameters
    ----------
    factor : 1
        Times the energy at the start, above 1; this or the amount.
    amount : J
        Above the energy at the start; this or the factor.
    """

    factor: Positive | None = None
    amount: Positive | None = None

    def __post_init__(self) -> None:
        if (self.factor is None) == (self.amount is None):
            raise ValueError("energy must have either factor or amount. Give one of them.")
        if self.factor is not None and self.factor <= 1.0:
            raise ValueError(f"energy.factor must be above 1; found {self.factor}. Raise it.")


@parameters
class Bounds:
    """Bounds of a recorded field: of all its items, at the end of every window.

    Parameters
    ----------
    component
        That gives the field.
    field
        ``"port.field"``.
    axis : 1
        Number of a vector's component, from 0; all of them if not given.
    low : of the field
        Least value that is stable.
    high : of the field
        Largest value that is stable.
    """

    component: str
    field: str
    axis: Index | None = None
    low: Number | None = None
    high: Number | None = None


@parameters
class Against:
    """A second parameter; the limit is found for each of its values.

    Parameters
    ----------
    parameter
        Its path.
    values : of the parameter
        For each of which the limit is found.
    """

    parameter: str
    values: tuple[Number, ...]


@parameters
class LimitTable:
    """One stability limit as given in the scene file.

    Parameters
    ----------
    name
        Of the limit, and of the folder of its runs; the parameter's path if not given.
    parameter
        Path of what is varied; a list of paths is scaled together by a factor.
    from_ : of the parameter
        Stable end of the range, the smaller or the larger one.
    to : of the parameter
        Unstable end of the range.
    log
        Whether the middle of a range is the geometric one.
    accuracy : 1
        Relative width of the range that is left at the end.
    predicted : of the parameter
        The limit by theory: one, or one for each value of `against`.
    source
        Of the prediction.
    end : s
        Of the short runs; that of the scene if not given.
    transport
        Of the short runs.
    settings
        Of the short runs, by dotted path, on top of the scene.
    against
        A second parameter.
    energy
        How far the total energy may rise.
    momentum : 1
        Largest residual of any link.
    bounds
        Bounds of recorded fields.
    expectation
        Names of expectations; a run that does not meet them is degraded.
    """

    name: str = ""
    parameter: str | tuple[str, ...]
    from_: Annotated[Number, pydantic.Field(alias="from")]
    to: Number
    log: bool = False
    accuracy: Annotated[float, pydantic.Field(gt=0.0, le=0.5)] = 0.05
    predicted: Number | tuple[Number, ...] | None = None
    source: str = ""
    end: Positive | None = None
    transport: Literal["memory", "zenoh", "mpi"] = "memory"
    settings: dict[str, Any] = pydantic.Field(default_factory=dict)
    against: Against | None = None
    energy: Energy | None = None
    momentum: NotNegative | None = None
    bounds: tuple[Bounds, ...] = ()
    expectation: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        wrong = [sentence for is_wrong, sentence in self._rules() if is_wrong]
        if wrong:
            raise ValueError(" ".join(wrong))

    def _rules(self) -> list[tuple[bool, str]]:
        listed = isinstance(self.predicted, tuple)
        values = self.against.values if self.against else ()
        count = len(self.predicted) if isinstance(self.predicted, tuple) else 0
        return [
            (self.from_ == self.to, f"from and to must differ; both are {self.to}."),
            (
                self.log and min(self.from_, self.to) <= 0.0,
                f"log needs positive ends; found {self.from_} and {self.to}. Remove log.",
            ),
            (not self.parameter, "parameter must name a path or more; found none."),
            (self.predicted is not None and not self.source, "predicted needs a source."),
            (self.against is not None and not values, "against.values must not be empty."),
            (
                listed and count != len(values),
                "predicted must be one number, or one for each of against.values; found "
                f"{count} for {len(values)}.",
            ),
        ]


@dataclass(frozen=True, slots=True)
class Scope:
    """Parts of the scene that a stability limit may refer to."""

    end: float  # s
    gives: Mapping[str, tuple[Port, ...]]  # ports that each component gives
    links: int
    expected: Mapping[str, Expectation]  # by name
    unread: frozenset[str] = frozenset()  # components whose ports are not known


@dataclass(frozen=True, slots=True)
class Limit:
    """One stability limit, checked."""

    table: LimitTable
    name: str
    end: float  # s, of its runs
    scaled: dict[str, float] = field(default_factory=dict)  # paths scaled together, their values

    @property
    def folder(self) -> str:
        """Name of the folder of its runs."""
        return folder_name(self.name)

    def settings(self, value: float, other: float | None) -> dict[str, Any]:
        """Settings of a run: reduced output, those of the short runs, and the parameters."""
        one = self.table
        totals = self.end / SAMPLES if one.energy or one.momentum is not None else 0.0
        output = {"output.pictures": [], "output.interval": 0.0, "output.totals": totals}
        output["output.record"] = bool(one.bounds or one.expectation)
        bounded = [f"{bounds.component}.{bounds.field}" for bounds in one.bounds]
        output["output.fields"] = list(dict.fromkeys(bounded))
        varied = {path: value * base for path, base in self.scaled.items()}
        if isinstance(one.parameter, str):
            varied = {one.parameter: value}
        if one.against and other is not None:
            varied[one.against.parameter] = other
        return {**output, "end": self.end, **one.settings, **varied}

    def others(self) -> tuple[float | None, ...]:
        """Values of the second parameter, or one None."""
        return self.table.against.values if self.table.against else (None,)

    def predicted(self, number: int) -> float | None:
        """Prediction for one value of the second parameter."""
        predicted = self.table.predicted
        return predicted[number] if isinstance(predicted, tuple) else predicted


def read_limits(
    given: list[Table], make_variant: MakeVariant, scope: Scope | None
) -> tuple[list[Limit], list[str]]:
    """Check the limits of a scene; without a scope only their form."""
    found, mistakes, names = [], [], set()
    for number, table in enumerate(given):
        where = f"stability.{table.get('name', number)}"
        one, wrong = read(LimitTable, table, where)
        mistakes += wrong
        if one is None or scope is None:
            continue
        paths = [one.parameter] if isinstance(one.parameter, str) else list(one.parameter)
        name = one.name or " ".join(paths)
        if name in names:
            mistakes.append(f"{where}: two limits have the name {name}. Give each its own.")
        names.add(name)
        limit, wrong = _limit(one, name, scope, make_variant)
        wrong += _check_references(one, scope) or _check_ends(limit, make_variant)
        mistakes += [f"{where}: {mistake}" for mistake in dict.fromkeys(wrong)]
        found.append(limit)
    return found, mistakes


def _limit(
    one: LimitTable, name: str, scope: Scope, make_variant: MakeVariant
) -> tuple[Limit, list[str]]:
    if isinstance(one.parameter, str):
        return Limit(one, name, one.end or scope.end), []
    variant, mistakes = make_variant(one.settings)
    scaled = {}
    for path in one.parameter:
        value, wrong = value_at(variant, path)
        if not wrong and (isinstance(value, bool) or not isinstance(value, (int, float))):
            wrong = f"{path} must be a number to be scaled; found {shown(value)}. Name another."
        mistakes += [wrong] if wrong else []
        scaled[path] = 1.0 if wrong else float(value)
    return Limit(one, name, one.end or scope.end, scaled), mistakes


def _check_ends(limit: Limit, make_variant: MakeVariant) -> list[str]:
    """Check the scene at both ends of the range."""
    one, mistakes = limit.table, []
    for other in limit.others():
        for value in (one.from_, one.to):
            mistakes += make_variant(limit.settings(value, other))[1]
    if one.parameter == "window" and limit.end < FEWEST_WINDOWS * max(one.from_, one.to):
        mistakes.append(
            f"end must be {FEWEST_WINDOWS} windows or more, as windows are whole; found "
            f"{limit.end:g} s for windows up to {max(one.from_, one.to):g} s. Raise end."
        )
    return mistakes


def _check_references(one: LimitTable, scope: Scope) -> list[str]:
    """Check that the links, expectations and fields that an invariant names exist."""
    mistakes = []
    if one.momentum is not None and not (scope.links or scope.unread):
        mistakes.append("momentum is that of links; the scene has none. Remove it.")
    for name in one.expectation:
        if name not in scope.expected:
            mistakes.append(unknown(f"expectation {name}", name, scope.expected))
    for bounds in one.bounds:
        mistakes += _bounds(bounds, scope)
    return mistakes


def _bounds(bounds: Bounds, scope: Scope) -> list[str]:
    if bounds.component not in scope.gives:
        return [unknown(f"bounds.component {bounds.component}", bounds.component, scope.gives)]
    if bounds.component in scope.unread:
        return []
    ports = scope.gives[bounds.component]
    fields = {f"{port.name}.{f.name}": f for port in ports for f in port.fields}
    if bounds.field not in fields:
        return [unknown(f"bounds.field {bounds.field}", bounds.field, fields)]
    one, wrong = fields[bounds.field], []
    if one.centring == "impulse":
        wrong.append(f"bounds.field {bounds.field} must be an instant; it is an impulse.")
    if bounds.axis is not None and bounds.axis >= sum(one.shape):
        wrong.append(f"bounds.axis must be below {sum(one.shape)}; found {bounds.axis}.")
    if bounds.low is None and bounds.high is None:
        wrong.append("bounds must have low or high; found neither. Give one.")
    return wrong
