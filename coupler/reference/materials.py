"""``quintet materials``: names, constants, units and sources of the library's materials."""

import json
from collections.abc import Iterator

from quintet.interfaces.errors import SceneError
from quintet.interfaces.manifest import find, known_kinds
from quintet.interfaces.materials.filling import fitting, places
from quintet.interfaces.materials.library import (
    CONSTANTS,
    Table,
    constants,
    leaves,
    library,
    sources_of,
)
from quintet.interfaces.params import unknown


def print_materials(name: str, as_json: bool) -> None:
    """List all materials, or print the constants of one."""
    materials = library()
    if name and name not in materials:
        known = ", ".join(materials)
        raise SceneError(f"{unknown(f'material {name}', name, materials)} The library has {known}.")
    if as_json:
        chosen = {name: materials[name]} if name else materials
        print(json.dumps({name: as_data(table) for name, table in chosen.items()}, indent=2))
    else:
        print("\n".join(_lines_of(name, materials[name]) if name else _list()))


def _list() -> Iterator[str]:
    materials = library()
    room = max(map(len, materials))
    for name, material in materials.items():
        groups = ", ".join(constants(material))
        yield f"{name:<{room}}  {material['title']}: {groups}"


def _lines_of(name: str, material: Table) -> Iterator[str]:
    sources = dict(sources_of(material))
    numbers = list(dict.fromkeys(sources.values()))
    rows = [
        (path, f"{value:.9g}", CONSTANTS[path][0], CONSTANTS[path][1])
        for path, value in leaves(constants(material))
    ]
    widths = [max(len(row[n]) for row in rows) for n in range(3)]
    yield f"{name}: {material['title']}"
    yield ""
    for row in rows:
        parts = [f"{part:<{room}}" for part, room in zip(row, widths, strict=False)]
        yield "  ".join([*parts, f"{row[-1]} [{numbers.index(sources[row[0]]) + 1}]"])
    yield ""
    yield from (f"[{number}] {source}" for number, source in enumerate(numbers, 1))
    if uses := list(_uses(name)):
        yield ""
        yield "Named in a component of kind"
        yield from uses


def _uses(name: str) -> Iterator[str]:
    """Yield the keys of each kind that take the material."""
    for kind in sorted(known_kinds()):
        for path, params in places(find(kind).params):
            if name in fitting(params, library()):
                yield f'  {kind}: {path} = "{name}"'


def as_data(material: Table) -> dict[str, object]:
    """One material, for programs."""
    sources = dict(sources_of(material))
    rows = {
        path: {"value": value, "unit": CONSTANTS[path][0], "source": sources[path]}
        for path, value in leaves(constants(material))
    }
    return {"title": material["title"], "constants": rows}
