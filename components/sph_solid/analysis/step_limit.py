"""Largest Courant number of a scene's solid, by its step linearised at its state.

    python -m quintet.components.sph_solid.analysis.step_limit SCENE.toml NAME TIME [TIME ...]

The solid of a scene file, with the settings of its limit of stability NAME, is run by itself at its
Courant number that is stable; the limit is printed for the state at each TIME [s].
"""

import sys
from pathlib import Path

from quintet.components.shared.scene_limits import keys_of, scene_at_limit
from quintet.components.sph_solid.analysis.linear_step import largest_courant
from quintet.components.sph_solid.component import SphSolid
from quintet.components.sph_solid.params import SphSolidParams
from quintet.interfaces.errors import SceneError
from quintet.interfaces.params import read


def solid_of(path: Path, name: str) -> SphSolid:
    """Make the solid of a scene file as its limit of that name has it."""
    scene, _ = scene_at_limit(path, name)
    keys = keys_of(scene, "sph_solid")
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


if __name__ == "__main__":
    main(sys.argv[1:])
