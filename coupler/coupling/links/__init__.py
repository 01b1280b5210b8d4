"""Links: one file, one kind of exchange between two components.

A kind is a function ``make(number, table, ports) -> Link``, found by its name under the
entry-point group ``quintet.links``; only kinds that a scene names are imported.
"""

from collections.abc import Callable, Mapping
from importlib.metadata import entry_points
from typing import Any

from quintet.coupler.coupling.exchange import Link, Ports

Maker = Callable[[int, dict[str, Any], Mapping[str, Ports]], Link]


def known_links() -> dict[str, str]:
    """Kinds of links that are installed, with the functions that make them."""
    return {entry.name: entry.value for entry in entry_points(group="quintet.links")}


def maker(kind: str) -> Maker:
    """Return what makes links of a kind, with its keys; KeyError if none is installed."""
    (entry,) = entry_points(group="quintet.links", name=kind) or (None,)
    if entry is None:
        raise KeyError(kind)
    make: Maker = entry.load()
    return make
