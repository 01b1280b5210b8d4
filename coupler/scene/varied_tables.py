"""What tables of studies, stability limits and scans share: they vary parameters of a scene."""

import re
from collections.abc import Callable, Iterator
from typing import Any, TypeVar

from quintet.coupler.scene.overrides import is_index
from quintet.interfaces.params import read, unknown

T = TypeVar("T")
Table = dict[str, Any]
MakeVariant = Callable[[Table], tuple[Table, list[str]]]  # settings -> scene with them, mistakes

REDUCED = {"output.pictures": [], "output.interval": 0.0}  # output of runs that are not looked at


def read_tables(
    kind: type[T], name: str, key: str, tables: list[Table], mistakes: list[str]
) -> Iterator[tuple[str, T]]:
    """Yield tables that can be read, each with its place; add the mistakes of the others."""
    for number, table in enumerate(tables):
        place = f"{name}.{table.get(key, number)}"
        checked, wrong = read(kind, table, place)
        mistakes += wrong
        if checked is not None:
            yield place, checked


def folder_name(text: str) -> str:
    """Turn a text into the name of a folder."""
    return re.sub(r"[^A-Za-z0-9_.+-]+", "_", text).strip("._") or "_"


def value_at(table: Table, path: str) -> tuple[Any, str]:
    """Find the value at a dotted path of a scene's tables; return it, or why there is none."""
    at: Any = table
    for part in path.split("."):
        if isinstance(at, list) and is_index(part, at):
            at = at[int(part)]
        elif isinstance(at, dict) and part in at:
            at = at[part]
        else:
            numbers = range(len(at)) if isinstance(at, list) else ()
            reason = unknown(path, part, at if isinstance(at, dict) else map(str, numbers))
            return None, reason.replace("is not known", "has no value in the scene", 1)
    return at, ""
