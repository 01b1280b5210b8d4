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

from dataclasses import dataclass, field
from typing import Annotated, Any, Literal

import pydantic

from quintet.coupler.measures.expectation import Index
from quintet.coupler.scene.varied_tables import REDUCED, folder_name
from quintet.interfaces.params import NotNegative, Number, Positive, parameters

SAMPLES = 200  # rows of the ledger in a short run


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
    along
        Other paths that change with it: for each a list of values, one for each of `values`.
    """

    parameter: str
    values: tuple[Number, ...]
    along: dict[str, tuple[Any, ...]] = pydantic.Field(default_factory=dict)

    def settings(self, value: float) -> dict[str, Any]:
        """Settings at one of the values, by dotted path."""
        number = self.values.index(value)
        return {self.parameter: value, **{path: each[number] for path, each in self.along.items()}}


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
        along = self.against.along if self.against else {}
        wrong_along = [path for path, each in along.items() if len(each) != len(values)]
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
                bool(wrong_along),
                f"against.along must have as many values as against.values, {len(values)}, for "
                f"each path; {', '.join(wrong_along)} has other numbers of them.",
            ),
            (
                listed and count != len(values),
                "predicted must be one number, or one for each of against.values; found "
                f"{count} for {len(values)}.",
            ),
        ]


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
        table = self.table
        totals = self.end / SAMPLES if table.energy or table.momentum is not None else 0.0
        output = {**REDUCED, "output.totals": totals}
        output["output.record"] = bool(table.bounds or table.expectation)
        bounded = [f"{bounds.component}.{bounds.field}" for bounds in table.bounds]
        output["output.fields"] = list(dict.fromkeys(bounded))
        varied = {path: value * base for path, base in self.scaled.items()}
        if isinstance(table.parameter, str):
            varied = {table.parameter: value}
        if table.against and other is not None:
            varied |= table.against.settings(other)
        return {**output, "end": self.end, **table.settings, **varied}

    def others(self) -> tuple[float | None, ...]:
        """Values of the second parameter, or None alone."""
        return self.table.against.values if self.table.against else (None,)

    def predicted(self, number: int) -> float | None:
        """Prediction for one value of the second parameter."""
        predicted = self.table.predicted
        return predicted[number] if isinstance(predicted, tuple) else predicted
