"""Largest Courant number of a scene's solid, by its step linearised at its state.

    python -m quintet.components.sph_solid.analysis.step_limit SCENE.toml NAME TIME [TIME ...]

The solid of a scene file, with the settings of its limit of stability NAME, is run by itself at its
Courant number that is stable; the limit is printed for the state at each TIME [s].
"""

import sys
import tomllib
from pathlib import Path
from typing import Any

from quintet.components.sph_solid.analysis.linear_step import largest_courant
from quintet.components.sph_solid.component import SphSolid
from quintet.components.sph_solid.params import SphSolidParams
from quintet.interfaces.errors import SceneError
from quintet.interfaces.params import read


def solid_of(path: Path, name: str) -> SphSolid:
    """Make the solid of a scene file as its limit of that name has it."""
    scene = tomllib.loads(path.read_text("utf-8"))
    limits = [limit for limit in scene.get("stability", []) if limit.get("name") == name]
    if not limits:
        raise SceneError(f"{path}: a limit of stability named {name!r} must be there. Add it.")
    for place, value in limits[0].get("settings", {}).items():
        _put(scene, place.split("."), value)
    (table,) = (
        component for component in scene["components"].values() if component["kind"] == "sph_solid"
    )
    keys = {key: value for key, value in table.items() if key not in ("kind", "threads")}
    params, mistakes = read(SphSolidParams, keys, "solid")
    if mistakes:
        raise SceneError(mistakes[0])
    return SphSolid(params)


def limit_at(solid: SphSolid, time: float) -> float:
    """Largest Courant number of the state at a time [s]; the solid is left there."""
    while solid.state.time < time:
        solid.step(solid.stable_dt())
    state = solid.save()
    courant = largest_courant(solid)
    solid.load(state)
    return courant


def main(words: list[str]) -> None:
    """Print the limits."""
    solid = solid_of(Path(words[0]), words[1])
    for time in map(float, words[2:]):
        print(f"{words[1]}, {time:g} s: {limit_at(solid, time):.3g}", flush=True)


def _put(scene: dict[str, Any], path: list[str], value: Any) -> None:
    """Set what a dotted path leads to; numbers count items of lists."""
    place: Any = scene
    for key in path[:-1]:
        place = place[int(key)] if isinstance(place, list) else place[key]
    place[path[-1]] = value


if __name__ == "__main__":
    main(sys.argv[1:])
