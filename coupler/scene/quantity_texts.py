"""Texts with units in a scene, ``"20 mm"``: each becomes a number in the unit of its key."""

import contextlib
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import fields
from pathlib import Path
from typing import Any

from quintet.coupler.coupling.links import keys_of
from quintet.coupler.measures.expectation import Expectation
from quintet.coupler.scene.foreign_code import trusted_params
from quintet.coupler.scene.scene import GroupSettings, Scene, SceneFile
from quintet.coupler.scene.stability_table import LimitTable
from quintet.coupler.scene.tables import SceneTables
from quintet.interfaces.errors import SceneError
from quintet.interfaces.keys import Key, keys
from quintet.interfaces.quantities import has_quantities, in_si, is_in_si, number_in

Table = dict[str, Any]
TABLES = {field.name for field in fields(SceneTables)}
LEVEL = "`unit`, after offset and scale"
# Measures in the unit of what is measured.
LIKE_FIELD = ("rms", "at", "max", "min", "mean", "amplitude")
OF_PARAMETER = "of the parameter"
OF_OTHERS = ("`unit`", LEVEL, OF_PARAMETER)  # units that another key of the scene gives


def scene_in_si(table: Table, folder: Path, imports: bool) -> tuple[Table, list[str]]:
    """Return the tables of a scene with numbers in the place of texts with units, and mistakes.

    Presets, and settings of studies, limits and scans, stay as they are: what they set is converted
    where it is put.

    Parameters
    ----------
    table
        Of the whole scene. It is not changed.
    folder
        Of the scene.
    imports
        Whether code of the scene's own may be imported to learn the units of its keys.
    """
    if not has_quantities(table):
        return table, []
    conversion = _Conversion(table, folder, imports)
    return conversion.tables(), conversion.mistakes


def units_of_keys(scene: Scene, paths: Iterable[str]) -> dict[str, str]:
    """Units of keys of a scene that runs, by their dotted paths; those without one are left out."""
    conversion = _Conversion(scene.resolved, scene.folder, imports=True)
    units = {path: conversion.unit_at(path) for path in paths}
    return {path: unit for path, unit in units.items() if unit != "1" and is_in_si(unit)}


def value_in_si(table: Table, folder: Path, imports: bool, path: str, value: Any) -> Any:
    """A value of a key of a scene, by its dotted path, as the scene runs with it.

    Whole numbers of keys that do not count are floats, texts with units numbers; what is of an
    unknown key, or cannot be converted, stays as it is: the check of the scene refuses it.
    """
    key = _Conversion(table, folder, imports).key_at(path)
    if key is None or not key.numeric or "whole" in key.words or isinstance(value, bool):
        return value
    if isinstance(value, str) and has_quantities(value):
        with contextlib.suppress(ValueError, SceneError):
            return number_in(value, key.unit, path)
    return float(value) if isinstance(value, int) else value


class _Conversion:
    """The tables of one scene, and the mistakes in their texts."""

    def __init__(self, table: Table, folder: Path, imports: bool) -> None:
        self.table, self.folder, self.imports = table, folder, imports
        self.mistakes: list[str] = []

    def tables(self) -> Table:
        """Convert all tables of the scene."""
        file_keys = {key: value for key, value in self.table.items() if key not in TABLES}
        converted = {**self.table, **self._of(SceneFile, file_keys, "scene")}
        converted["components"] = self._each("components", self._component)
        converted["groups"] = self._each("groups", lambda t, at: self._of(GroupSettings, t, at))
        converted["links"] = self._each("links", self._link)
        converted["expect"] = self._each("expect", lambda t, at: self._of(Expectation, t, at))
        converted["stability"] = self._each("stability", lambda t, at: self._of(LimitTable, t, at))
        converted["stand_ins"] = self._each("stand_ins", self._stand_ins)
        return {key: converted[key] for key in self.table}

    def _each(self, name: str, convert: Callable[[Table, str], Table]) -> Any:
        """Convert each table of a list, or of a table by names."""
        tables = self.table.get(name)
        if isinstance(tables, dict):
            pairs = {key: (entry, f"{name}.{key}") for key, entry in tables.items()}
            return {k: _if_table(convert, entry, place) for k, (entry, place) in pairs.items()}
        if isinstance(tables, list):
            labels = [_label(entry, number) for number, entry in enumerate(tables)]
            return [
                _if_table(convert, entry, f"{name}.{label}")
                for entry, label in zip(tables, labels, strict=True)
            ]
        return tables

    def _of(self, params: type | None, table: Table, where: str) -> Table:
        if params is None:
            return table
        converted, mistakes = in_si(params, table, where, self._unit)
        self.mistakes += mistakes
        return converted

    def _component(self, table: Table, where: str) -> Table:
        return self._of(self._params(table.get("kind")), table, where)

    def _link(self, table: Table, where: str) -> Table:
        return self._of(keys_of(table.get("kind")), table, where)

    def _stand_ins(self, table: Table, where: str) -> Table:
        return {
            kind: self._of(self._params(kind), keys, f"{where}.{kind}")
            if isinstance(keys, dict)
            else keys
            for kind, keys in table.items()
        }

    def _params(self, kind: Any) -> type | None:
        return trusted_params(kind, self.folder, self.imports)

    def _unit(self, key: Key, table: Mapping[str, Any]) -> str:
        """Unit of a key: its own, that of its expectation, or that of the parameter it is about."""
        unit, measure = table.get("unit"), table.get("measure")
        if isinstance(unit, str) and key.unit == "`unit`":
            return "s" if (key.name, measure) == ("within", "crossing") else unit
        if isinstance(unit, str) and key.unit == LEVEL:
            integral = f"({unit})/s" if measure == "integral" else key.unit
            return unit if measure in LIKE_FIELD else integral
        if key.unit == OF_PARAMETER:
            path = table.get("parameter")
            return (self.unit_at(path) if isinstance(path, str) else "1") or key.unit
        return key.unit

    def unit_at(self, path: str) -> str:
        """Unit of the key at a dotted path of the scene; "" where there is none."""
        key = self.key_at(path)
        return key.unit if key else ""

    def key_at(self, path: str) -> Key | None:
        """The key at a dotted path of the scene, or None."""
        names = path.split(".")
        params: type | None = SceneFile
        if names[0] == "components" and len(names) > 2:
            components = self.table.get("components")
            table = components.get(names[1]) if isinstance(components, dict) else None
            params = self._params(table.get("kind")) if isinstance(table, dict) else None
            names = names[2:]
        return next(_keys_on(params, names), None) if params else None


def _keys_on(params: type, names: list[str]) -> Iterator[Key]:
    """Yield the key at the end of a path through tables, lists and names."""
    known = {key.name: key for key in keys(params)}
    for number, name in enumerate(names):
        if key := known.get(name):
            if key.inner is None:
                yield key
            else:
                yield from _keys_on(key.inner, names[number + 1 :])
            return


def _if_table(convert: Callable[[Table, str], Table], entry: Any, where: str) -> Any:
    return convert(entry, where) if isinstance(entry, dict) else entry


def _label(entry: Any, number: int) -> str:
    """Name of a table in a list as sentences have it."""
    name = entry.get("name") if isinstance(entry, dict) else None
    return name if isinstance(name, str) and name else str(number)
