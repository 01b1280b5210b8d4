"""``[[scan]]``: a setting varied from safe to absurd, to see whether a wrong result is reported.

    [[scan]]
    parameter = "components.spring.step"
    values = [0.01, 0.1, 1.0]              # from safe to absurd
    expectation = ["end"]
    source = "cos(ω t)"

Every run is judged as if the scene had no expectations. Their values serve as a measure of the
error only: a run that is wrong must warn, refuse or fail.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import pydantic

from quintet.coupler.measures.expectation import DISTANCES, Expectation
from quintet.coupler.scene.varied_tables import (
    REDUCED,
    MakeVariant,
    Table,
    folder_name,
    read_tables,
)
from quintet.interfaces.params import Number, Positive, parameters, shown, unknown

AUTO = "auto"  # of a number: it may stand beside numbers


@parameters
class ScanTable:
    """A setting varied from safe to absurd, as given in the scene file.

    Parameters
    ----------
    name
        Of the scan, and of the folder of its runs; the parameter's path if not given.
    parameter
        Path of the setting, as in ``--set``.
    values
        Of the parameter, from safe to absurd. The scene must accept the first, and may refuse the
        others.
    settings
        Of all runs, by dotted path, on top of the scene.
    expectation
        Names of the expectations whose errors are judged; all whose error has a scale if not given.
    exact : `unit` of the expectation
        By expectation: the exact answer for each of the values; its reference if not given.
    scale : `unit` of the expectation
        By expectation: the size that its error is relative to; that of the exact answer if not
        given.
    energy
        Whether the energy that the run gains, over that turned over, is judged too: where energy
        is conserved or lost, all of it is an error.
    source
        Of the exact answers.
    """

    name: str = ""
    parameter: str
    values: tuple[Any, ...]
    settings: dict[str, Any] = pydantic.Field(default_factory=dict)
    expectation: tuple[str, ...] = ()
    exact: dict[str, tuple[Number, ...]] = pydantic.Field(default_factory=dict)
    scale: dict[str, Positive] = pydantic.Field(default_factory=dict)
    energy: bool = False
    source: str = ""

    def __post_init__(self) -> None:
        wrong = [sentence for is_wrong, sentence in self._rules() if is_wrong]
        if wrong:
            raise ValueError(" ".join(wrong))

    def _rules(self) -> list[tuple[bool, str]]:
        count, kinds = len(self.values), {_kind(value) for value in self.values if value != AUTO}
        return [
            (not self.parameter, "parameter must name a path; found none. Name one."),
            (count < 2, f"values must be two or more; found {count}. Add some."),
            (
                len(kinds) > 1,
                f"values must be of one type; found {shown(list(self.values))}. Correct them.",
            ),
            (
                self.parameter in self.settings,
                f"settings must not have the parameter {self.parameter}. Remove it from them.",
            ),
            (
                bool(self.exact) and not self.source,
                "exact needs a source. Add source to it.",
            ),
            *(
                (
                    len(answers) != count,
                    f"exact.{name} must have one number for each of values; found {len(answers)} "
                    f"for {count}. Correct it.",
                )
                for name, answers in self.exact.items()
            ),
        ]


def _kind(value: Any) -> type:
    """Type of a value; whole numbers are numbers."""
    return float if type(value) is int else type(value)


@dataclass(frozen=True, slots=True)
class Scan:
    """One scan, checked."""

    table: ScanTable
    name: str
    judged: tuple[str, ...]  # names of the expectations whose errors are judged
    scale: Mapping[str, float]  # what errors are relative to, where it is not the exact answer

    @property
    def folder(self) -> str:
        """Name of the folder of its runs."""
        return folder_name(self.name)

    def run_folder(self, number: int) -> str:
        """Name of the folder of the run with one of the values."""
        return folder_name(f"{number + 1}-{shown(self.table.values[number])}")

    def settings(self, number: int) -> Table:
        """Settings of the run with one of the values."""
        table = self.table
        return {
            **REDUCED,
            "output.record": True,
            **table.settings,
            table.parameter: table.values[number],
        }

    def exact(self, name: str, number: int) -> float | None:
        """Exact answer for one of the values; None if it is the expectation's reference."""
        answers = self.table.exact.get(name)
        return answers[number] if answers else None


def read_scans(
    tables: list[Table],
    make_variant: MakeVariant,
    expected: Mapping[str, Expectation] | None,
    is_inherited: bool = False,
) -> tuple[list[Scan], list[str]]:
    """Check the scans of a scene; without its expectations only their form.

    Scans that a preset inherits from its scene are left out where they do not suit what it sets.
    """
    scans: list[Scan] = []
    mistakes: list[str] = []
    for place, table in read_tables(ScanTable, "scan", "name", tables, mistakes):
        if expected is None:
            continue
        name = table.name or table.parameter
        wrong, judged, scale = _judged(table, expected)
        scan = Scan(table, name, judged, scale)
        if scan.folder in {other.folder for other in scans}:
            wrong.append(f"two scans have the name {name}. Give each its own.")
        wrong += make_variant(scan.settings(0))[1]
        if wrong and is_inherited:
            continue
        scans.append(scan)
        mistakes += [f"{place}: {mistake}" for mistake in dict.fromkeys(wrong)]
    return scans, mistakes


def _judged(
    table: ScanTable, expected: Mapping[str, Expectation]
) -> tuple[list[str], tuple[str, ...], dict[str, float]]:
    """Find the expectations that are judged, and the scales of their errors."""
    named = [("expectation", name) for name in table.expectation]
    named += [(f"{key}.{name}", name) for key in ("exact", "scale") for name in getattr(table, key)]
    wrong = [
        unknown(where if "." in where else f"{where} {name}", name, expected)
        for where, name in named
        if name not in expected
    ]
    scale: dict[str, float] = dict(table.scale)
    for name, expectation in expected.items():
        if expectation.measure == "relative_rms":
            scale.setdefault(name, 1.0)
    has_scale = [
        name
        for name, expectation in expected.items()
        if name in scale or _exact_is_a_scale(table, expectation)
    ]
    judged = table.expectation or tuple(has_scale)
    wrong += [
        f"scale.{name} is needed, as an exact answer is 0. Give the size that the error is "
        "relative to."
        for name in judged
        if name in expected and name not in has_scale
    ]
    if not judged:
        wrong.append(
            "it must have an expectation whose error has a scale; found none. Add scale, or an "
            "[[expect]]."
        )
    return wrong, judged, scale


def _exact_is_a_scale(table: ScanTable, expectation: Expectation) -> bool:
    """Whether errors can be relative to the exact answers: whether none of them is 0."""
    if answers := table.exact.get(expectation.name):
        return all(answers)
    return expectation.measure not in DISTANCES and expectation.value != 0.0
