"""``[[study]]``: the refinements of a convergence study, from coarse to fine.

    [[study]]
    label = "coarse"
    settings = { "components.water.spacing" = 0.03, "window" = 6e-4 }
    size = "components.water.spacing"

A refinement that names a `size` takes part in the observed order of the error against it.
"""

import re
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from quintet.coupler.scene.overrides import is_index
from quintet.interfaces.params import parameters, read, shown, unknown

Table = dict[str, Any]
MakeVariant = Callable[[Table], tuple[Table, list[str]]]  # settings -> scene with them, mistakes


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


def folder_name(text: str) -> str:
    """Turn a text into the name of a folder."""
    return re.sub(r"[^A-Za-z0-9_.+-]+", "_", text).strip("._") or "_"


def read_refinements(
    given: list[Table], make_variant: MakeVariant
) -> tuple[list[Refinement], list[str]]:
    """Check the refinements of a scene; return them, and every mistake."""
    found, mistakes, sizes = [], [], set()
    for number, table in enumerate(given):
        where = f"study.{table.get('label', number)}"
        one, wrong = read(RefinementTable, table, where)
        mistakes += wrong
        if one is None:
            continue
        variant, wrong = make_variant(one.settings)
        mistakes += [f"{where}: {mistake}" for mistake in wrong]
        if one.size and not wrong:
            size, wrong = _size(where, one.size, variant)
            mistakes += wrong
            sizes.add(one.size)
            found.append(Refinement(one.label, one.settings, size))
        else:
            found.append(Refinement(one.label, one.settings))
    return found, [*mistakes, *_clashes(found, sizes)]


def _clashes(found: list[Refinement], sizes: set[str]) -> list[str]:
    mistakes = [
        f"study: {count} refinements have the label {label}. Give each its own, in letters "
        "and digits."
        for label, count in Counter(one.folder for one in found).items()
        if count > 1
    ]
    if len(sizes) > 1:
        mistakes.append(
            "study: one size must serve all refinements that name one; found "
            f"{', '.join(sorted(sizes))}. Name the same, or none."
        )
    return mistakes


def _size(where: str, path: str, table: Table) -> tuple[float | None, list[str]]:
    value, wrong = value_at(table, path)
    if wrong:
        return None, [f"{where}.size {wrong}"]
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not value > 0:
        return None, [
            f"{where}.size {path} must be a positive number; found {shown(value)}. Name what "
            "is refined."
        ]
    return (1.0 / value if isinstance(value, int) else value), []


def value_at(table: Table, path: str) -> tuple[Any, str]:
    """Find the value at a dotted path of a scene's tables; return it, or why there is none."""
    at: Any = table
    for part in path.split("."):
        if isinstance(at, list) and is_index(part, at):
            at = at[int(part)]
        elif isinstance(at, dict) and part in at:
            at = at[part]
        else:
            known = at if isinstance(at, dict) else map(str, range(len(at or ())))
            reason = unknown(path, part, known if isinstance(at, (dict, list)) else ())
            return None, reason.replace("is not known", "has no value in the scene", 1)
    return at, ""
