"""Fill tables of a scene with the constants of the materials that they name."""

from collections.abc import Iterator, Mapping
from functools import cache
from typing import Annotated, Any

from pydantic import AfterValidator

from quintet.interfaces.keys import Key, keys
from quintet.interfaces.materials.library import constants
from quintet.interfaces.params import shown, unknown

Table = dict[str, Any]
NAME = "material"  # key of a table that names its material
FEWEST = 2  # constants that a table must get from a material: density alone makes no solid
SEE = "`quintet materials` lists all."


def _left(name: str) -> str:
    """Refuse a name that was not replaced by constants."""
    raise ValueError(
        f"material {name}: material names work only in scene files. Give the constants instead."
    )


MaterialName = Annotated[str, AfterValidator(_left)]  # of the key `material`, see `fill`


def fill(
    params: type, table: Table, where: str, materials: Mapping[str, Table]
) -> tuple[Table, list[str]]:
    """Return settings with constants in place of names of materials, and every mistake.

    Parameters
    ----------
    params : type
        Made by `quintet.interfaces.params.parameters`. It, or classes of its inner tables, state
        in ``MATERIAL`` which of their keys, as dotted paths, take which constants, and in
        ``INSTEAD_OF`` keys of which one table has only one.
    table : dict
        The settings, as they stand in a scene. It is not changed.
    where : str
        What the settings are called in sentences.
    materials : mapping of tables
        Constants by the names of materials.
    """
    mistakes: list[str] = []
    if not takes_materials(params):
        return table, mistakes
    return _filled(params, table, where, materials, mistakes), mistakes


@cache
def takes_materials(params: type) -> bool:
    """Whether tables of a class, or tables in them, may name a material."""
    return hasattr(params, "MATERIAL") or bool(_inner(params))


def places(params: type, above: str = "") -> Iterator[tuple[str, type]]:
    """Yield where tables of a class may name a material, with the class of that table."""
    if hasattr(params, "MATERIAL"):
        yield above or NAME, params
    for name, key in _inner(params).items():
        assert key.inner is not None
        part = {"table": name, "list": f"{name}.0", "names": f"{name}.NAME"}[key.place]
        yield from places(key.inner, f"{above}.{part}" if above else part)


def fitting(params: type, materials: Mapping[str, Table]) -> list[str]:
    """Names of the materials that have constants for a class."""
    return [name for name, material in materials.items() if _fits(params, material)]


@cache
def _inner(params: type) -> dict[str, Key]:
    """Keys of a class that hold tables in which materials may be named."""
    return {
        key.name: key
        for key in keys(params)
        if key.inner is not None and takes_materials(key.inner)
    }


def _filled(
    params: type, value: Any, where: str, materials: Mapping[str, Table], mistakes: list[str]
) -> Any:
    """Fill a table of a class, tables in a list, or a material's name in the place of a table."""
    if isinstance(value, list):
        return [
            _filled(params, part, f"{where}.{number}", materials, mistakes)
            for number, part in enumerate(value)
        ]
    takes = hasattr(params, "MATERIAL")
    if isinstance(value, str) and takes:
        value = {NAME: value}
    if not isinstance(value, dict):
        return value
    inner = _inner(params)
    filled = {
        name: _inside(inner[name], part, f"{where}.{name}", materials, mistakes)
        if name in inner
        else part
        for name, part in value.items()
    }
    return _with_constants(params, filled, where, materials, mistakes) if takes else filled


def _inside(
    key: Key, value: Any, where: str, materials: Mapping[str, Table], mistakes: list[str]
) -> Any:
    """Fill the tables that a key holds."""
    assert key.inner is not None
    if key.place == "names" and isinstance(value, dict):
        return {
            name: _filled(key.inner, part, f"{where}.{name}", materials, mistakes)
            for name, part in value.items()
        }
    return _filled(key.inner, value, where, materials, mistakes)


def _with_constants(
    params: Any, table: Table, where: str, materials: Mapping[str, Table], mistakes: list[str]
) -> Table:
    name = table.get(NAME)
    if name is None:
        return table
    place = f"{where}.{NAME}"
    if not isinstance(name, str) or name not in materials:
        if isinstance(name, str):
            mistakes.append(f"{unknown(f'{place} {name}', name, fitting(params, materials))} {SEE}")
        else:
            mistakes.append(f"{place} must be the name of a material; found {shown(name)}. {SEE}")
        return table
    if not _fits(params, materials[name]):
        names = ", ".join(fitting(params, materials))
        mistakes.append(
            f"{place} must be one with constants for this table: {names}; found {name}. Choose one "
            "of them."
        )
        return table
    instead = getattr(params, "INSTEAD_OF", {})
    filled = {key: value for key, value in table.items() if key != NAME}
    for key, value in _constants_for(params, materials[name]).items():
        if instead.get(key) not in filled:
            _put(filled, key.split("."), value)
    return filled


def _fits(params: Any, material: Table) -> bool:
    return len(_constants_for(params, material)) >= min(FEWEST, len(params.MATERIAL))


def _constants_for(params: Any, material: Table) -> Table:
    """Constants of a material that a class takes, by the dotted paths of its keys."""
    values = constants(material)
    return {key: values[name] for key, name in params.MATERIAL.items() if name in values}


def _put(table: Table, path: list[str], value: Any) -> None:
    """Set a value where none stands; tables are merged."""
    key, *rest = path
    if rest:
        inner = table.get(key, {})
        if isinstance(inner, dict):
            table[key] = dict(inner)
            _put(table[key], rest, value)
    elif key not in table:
        table[key] = value
    elif isinstance(value, dict) and isinstance(table[key], dict):
        table[key] = {**value, **table[key]}
