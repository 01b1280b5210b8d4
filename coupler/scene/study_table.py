"""``[[study]]``: the refinements of a convergence study, from coarse to fine.

    [[study]]
    label = "coarse"
    settings = { "components.water.spacing" = 0.03, "window" = 6e-4 }
    size = "components.water.spacing"

A refinement that names a `size` takes part in the observed order of the error against it. The kind
of that size is given by `refines`, or follows from its path.
"""

from collections import Counter
from collections.abc import Callable, Mapping
from copy import deepcopy
from dataclasses import dataclass, field, replace
from typing import Any, Literal, get_args

from quintet.coupler.scene.varied_tables import (
    MakeVariant,
    Table,
    folder_name,
    read_tables,
    value_at,
)
from quintet.interfaces.params import parameters, shown

InSi = Callable[[str, Any], Any]  # path of a key, its value in the scene -> a number in SI
Kind = Literal["coupling", "time step", "spacing", "model"]
KINDS: tuple[Kind, ...] = get_args(Kind)
COUPLED = ("window", "scheme", "iteration", "groups", "links")  # first parts of paths
STEPS = ("step", "dt", "courant", "substeps")  # last parts of paths, also after an underscore
SPACINGS = ("spacing", "elements", "cells", "layers")  # any parts of paths


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
    refines
        What is refined; if not given it follows from the path of `size`: window, scheme, iteration,
        groups and links are the coupling (without links the window is the time step); a step, dt,
        courant or substeps is the time step; a spacing, elements, cells or layers is the spacing;
        all else is the model.
    """

    label: str
    settings: dict[str, Any]
    size: str = ""
    refines: Literal["", "coupling", "time step", "spacing", "model"] = ""


@dataclass(frozen=True, slots=True)
class Refinement:
    """One refinement, checked.

    Attributes
    ----------
    size : float or None
        Of its own kind; smaller is finer; of a whole number, a count, its inverse.
    sizes : mapping
        By kind: the sizes of all kinds that the study refines, as they are in this refinement.
    ladders : tuple
        Kinds to whose observed order it contributes: its own, and those whose refinements it
        equals in all but their size.
    varied : mapping
        By path: the values of all that any refinement of the study sets.
    """

    label: str
    settings: dict[str, Any]
    size: float | None = None
    kind: Kind = "model"
    sizes: Mapping[str, float] = field(default_factory=dict)
    ladders: tuple[Kind, ...] = ()
    varied: Mapping[str, Any] = field(default_factory=dict)

    @property
    def folder(self) -> str:
        """Name of the folder of its run."""
        return folder_name(self.label)


def kind_of(path: str, has_links: bool) -> Kind:
    """Kind of error that a size at a path of the scene controls."""
    parts = path.split(".")
    if path == "window" and not has_links:
        return "time step"
    if parts[0] in COUPLED:
        return "coupling"
    if parts[-1].rpartition("_")[2] in STEPS:
        return "time step"
    if any(part.rpartition("_")[2] in SPACINGS for part in parts):
        return "spacing"
    return "model"


def read_refinements(
    tables: list[Table],
    make_variant: MakeVariant,
    si: InSi = lambda _, value: value,
) -> tuple[list[Refinement], list[str]]:
    """Check the refinements of a scene; return them, and every mistake.

    `si` gets the path of a key and its value, and returns the number that the scene runs with:
    ``window = 2`` is a size of 2 s, and no count, as is ``window = "2 s"``.
    """
    refinements: list[Refinement] = []
    variants: list[Table] = []
    mistakes: list[str] = []
    paths: dict[Kind, dict[str, None]] = {}
    for place, table in read_tables(RefinementTable, "study", "label", tables, mistakes):
        variant, wrong = make_variant(table.settings)
        mistakes += [f"{place}: {mistake}" for mistake in wrong]
        kind = table.refines or kind_of(table.size, bool(variant.get("links")))
        size = None
        if table.size and not wrong:
            size, wrong = _size(place, table.size, variant, si)
            mistakes += wrong
            paths.setdefault(kind, {})[table.size] = None
        refinements.append(Refinement(table.label, table.settings, size, kind))
        variants.append(variant)
    mistakes += _clashes(refinements, paths)
    if not mistakes:
        chosen = {kind: next(iter(names)) for kind, names in paths.items()}
        refinements = _compared(refinements, variants, chosen, si)
    return refinements, mistakes


def _clashes(refinements: list[Refinement], paths: dict[Kind, dict[str, None]]) -> list[str]:
    mistakes = [
        f"study: {count} refinements have the label {label}. Give each its own, in letters "
        "and digits."
        for label, count in Counter(refinement.folder for refinement in refinements).items()
        if count > 1
    ]
    mistakes += [
        f"study: one size must serve all refinements of the {kind}; found "
        f"{', '.join(sorted(names))}. Name the same, or say what each refines with refines."
        for kind, names in paths.items()
        if len(names) > 1
    ]
    return mistakes


def _value(table: Table, path: str, si: InSi) -> tuple[Any, str]:
    """Value at a path as the scene runs with it, or why there is none."""
    value, wrong = value_at(table, path)
    return value if wrong else si(path, value), wrong


def _size(place: str, path: str, table: Table, si: InSi) -> tuple[float | None, list[str]]:
    value, wrong = _value(table, path, si)
    if wrong:
        return None, [f"{place}.size {wrong}"]
    size = _number(value)
    if size is None:
        return None, [
            f"{place}.size {path} must be a positive number; found {shown(value)}. Name what "
            "is refined."
        ]
    return size, []


def _number(value: Any) -> float | None:
    """Size that a value is: smaller is finer; of a count, which is whole, its inverse."""
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not value > 0:
        return None
    return 1.0 / value if isinstance(value, int) else value


def _compared(
    refinements: list[Refinement],
    variants: list[Table],
    paths: Mapping[Kind, str],
    si: InSi,
) -> list[Refinement]:
    """Add to each refinement the sizes of all kinds, and the kinds to whose order it contributes.

    A point at which two kinds meet, as the finest of both, then needs to be run once.
    """
    ladders: list[list[Kind]] = [[] for _ in refinements]
    for kind, path in paths.items():
        others = [_without(variant, path) for variant in variants]
        members = [k for k, r in enumerate(refinements) if r.kind == kind and r.size is not None]
        taken = {refinements[k].size for k in members}
        for number, variant in enumerate(variants):
            size = _number(_value(variant, path, si)[0])
            joins = size not in taken and any(others[number] == others[k] for k in members)
            if number in members or (size is not None and joins):
                ladders[number].append(kind)
                taken.add(size)
    every_path = list(dict.fromkeys(path for r in refinements for path in r.settings))
    return [
        replace(
            refinement,
            sizes={
                kind: size
                for kind, path in paths.items()
                if (size := _number(_value(variant, path, si)[0])) is not None
            },
            ladders=tuple(kinds),
            varied={
                path: value
                for path in every_path
                for value, wrong in [_value(variant, path, si)]
                if not wrong
            },
        )
        for refinement, variant, kinds in zip(refinements, variants, ladders, strict=True)
    ]


def _without(table: Table, path: str) -> Table:
    """Copy a scene's tables without the value at a path."""
    copy: Any = deepcopy(table)
    *heads, last = path.split(".")
    at = copy
    for part in heads:
        at = at[int(part)] if isinstance(at, list) else at.get(part, {})
    if isinstance(at, list):
        at[int(last)] = None
    else:
        at.pop(last, None)
    return copy
