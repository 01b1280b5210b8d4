"""Materials in a scene: names of the library and of the scene's own, replaced by constants."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from quintet.coupler.scene.foreign_code import trusted_params
from quintet.coupler.scene.toml import read_file
from quintet.interfaces.errors import SceneError
from quintet.interfaces.materials.filling import fill, takes_materials
from quintet.interfaces.materials.library import library, wrong_materials
from quintet.interfaces.params import shown

Table = dict[str, Any]
KEY = "materials"  # of a scene


def with_materials(table: Table, folder: Path, imports: bool) -> tuple[Table, list[str]]:
    """Return a scene with constants in place of names of materials, and mistakes.

    Parameters
    ----------
    table
        Of the whole scene. It is not changed. Its key `materials` has materials of its own, or
        names a file with them; it is left out of what is returned.
    folder
        Of the scene, where that file lies.
    imports
        Whether code of the scene's own may be imported to learn which keys take constants.
    """
    added, mistakes = _own_materials(table.get(KEY, {}), folder)
    components = table.get("components")
    if mistakes or not isinstance(components, dict):
        return table, mistakes
    filled = {
        name: _component(entry, f"components.{name}", folder, imports, added, mistakes)
        for name, entry in components.items()
    }
    scene = {key: value for key, value in table.items() if key != KEY}
    return {**scene, "components": filled}, mistakes


def _own_materials(described: Any, folder: Path) -> tuple[Mapping[str, Table], list[str]]:
    """Materials of a scene: its tables, or those of the file that it names."""
    where = KEY
    if isinstance(described, str):
        where = described
        if not _is_file_below(folder, described):
            return {}, [
                f"{KEY}: file {shown(described)} must lie beside the scene; in its folder there is "
                "none. Put it there, or correct its name."
            ]
        try:
            described = read_file(folder / described, "a file of materials")
        except SceneError as error:
            return {}, error.mistakes
    return described, wrong_materials(described, where)


def _is_file_below(folder: Path, name: str) -> bool:
    """Whether a name is that of a file in a folder or below it."""
    try:
        path = (folder / name).resolve()
        return path.is_relative_to(folder.resolve()) and path.is_file()
    except (OSError, ValueError):  # no file can have such a name
        return False


def _component(
    table: Any,
    where: str,
    folder: Path,
    imports: bool,
    added: Mapping[str, Table],
    mistakes: list[str],
) -> Any:
    params = trusted_params(table.get("kind"), folder, imports) if isinstance(table, dict) else None
    if params is None or not takes_materials(params):
        return table
    filled, wrong = fill(params, table, where, {**library(), **added})
    mistakes += wrong
    return filled
