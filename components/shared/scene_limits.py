"""Limits of stability of a scene file, for tools that predict them from a solver alone."""

import copy
import tomllib
from pathlib import Path
from typing import Any

from quintet.interfaces.errors import SceneError

SERVED = ("kind", "threads", "ranks")  # keys of a component that are not the solver's
Table = dict[str, Any]


def scene_at_limit(path: Path, name: str = "", number: int = 0) -> tuple[Table, Table]:
    """Read a scene as a limit of stability has it.

    Parameters
    ----------
    path : Path
        Of the scene's file.
    name : str
        Of the limit; the first one if not given.
    number : int
        Of the value of its second parameter, if it has one.

    Returns
    -------
    scene, limit : dict
        Tables of the scene with the limit's settings, and of the limit, with its `end`.

    Raises
    ------
    SceneError
        There is no such limit.
    """
    scene = tomllib.loads(path.read_text("utf-8"))
    limits = [limit for limit in scene.get("stability", []) if name in ("", limit.get("name"))]
    if not limits:
        wanted = f"named {name!r} " if name else ""
        raise SceneError(f"{path}: a limit of stability {wanted}must be there; found none. Add it.")
    limit = copy.deepcopy(limits[0])
    for place, value in limit.get("settings", {}).items():
        put(scene, place, value)
    if against := limit.get("against"):
        put(scene, against["parameter"], against["values"][number])
        for place, values in against.get("along", {}).items():
            put(scene, place, values[number])
    limit.setdefault("end", scene["end"])
    return scene, limit


def keys_of(scene: Table, kind: str) -> Table:
    """Keys of the solver of the scene's one component of a kind."""
    tables = [table for table in scene["components"].values() if table["kind"] == kind]
    if len(tables) != 1:
        raise SceneError(
            f"components: one must be of the kind {kind}; found {len(tables)}. Use another scene."
        )
    return {key: value for key, value in tables[0].items() if key not in SERVED}


def put(scene: Table, path: str, value: Any) -> None:
    """Set what a dotted path leads to; numbers count items of lists."""
    *places, last = path.split(".")
    at: Any = scene
    for key in places:
        at = at[int(key)] if isinstance(at, list) else at.setdefault(key, {})
    at[last] = value
