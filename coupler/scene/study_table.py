"""``[[study]]``: the refinements of a convergence study, from coarse to fine.

    [[study]]
    label = "coarse"
    settings = { "components.water.spacing" = 0.03, "window" = 6e-4 }
    size = "components.water.spacing"

A refinement that names a `size` takes part in the observed order of the error against it.
"""

from collections import Counter
from dataclasses import dataclass
from typing import Any

from quintet.coupler.scene.varied_tables import (
    MakeVariant,
    Table,
    folder_name,
    read_tables,
    value_at,
)
from quintet.interfaces.params import parameters, shown


@parameters
class RefinementTable:
    """One refinement as given in the scene file.

    Parameters
    ----------
    label
        Name of the refinement, and of the folder of its run.
    settings
        By dotted path, on top of the scene.
    size
        Path of the size against which the order is observed.
    """

    label: str
    settings: dict[str, Any]
    size: str = ""


@dataclass(frozen=True, slots=True)
class Refinement:
    """One refinement, checked."""

    label: str
    settings: dict[str, Any]
    size: float | None = None  # smaller is finer; of a whole number, a count, its inverse

    @property
    def folder(self) -> str:
        """Name of the folder of its run."""
        return folder_name(self.label)


def read_refinements(
    tables: list[Table], make_variant: MakeVariant
) -> tuple[list[Refinement], list[str]]:
    """Check the refinements of a scene; return them, and every mistake."""
    refinements: list[Refinement] = []
    mistakes: list[str] = []
    paths: set[str] = set()
    for place, table in read_tables(RefinementTable, "study", "label", tables, mistakes):
        variant, wrong = make_variant(table.settings)
        mistakes += [f"{place}: {mistake}" for mistake in wrong]
        size = None
        if table.size and not wrong:
            size, wrong = _size(place, table.size, variant)
            mistakes += wrong
            paths.add(table.size)
        refinements.append(Refinement(table.label, table.settings, size))
    return refinements, [*mistakes, *_clashes(refinements, paths)]


def _clashes(refinements: list[Refinement], paths: set[str]) -> list[str]:
    mistakes = [
        f"study: {count} refinements have the label {label}. Give each its own, in letters "
        "and digits."
        for label, count in Counter(refinement.folder for refinement in refinements).items()
        if count > 1
    ]
    if len(paths) > 1:
        mistakes.append(
            "study: one size must serve all refinements that name one; found "
            f"{', '.join(sorted(paths))}. Name the same, or none."
        )
    return mistakes


def _size(place: str, path: str, table: Table) -> tuple[float | None, list[str]]:
    value, wrong = value_at(table, path)
    if wrong:
        return None, [f"{place}.size {wrong}"]
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not value > 0:
        return None, [
            f"{place}.size {path} must be a positive number; found {shown(value)}. Name what "
            "is refined."
        ]
    return (1.0 / value if isinstance(value, int) else value), []
