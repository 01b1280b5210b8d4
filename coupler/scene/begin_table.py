"""``begin_from``: another run whose last state is the start of this one."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from quintet.coupler.files.run_files import SCENE, read_marker
from quintet.coupler.scene.toml import read_file
from quintet.interfaces.errors import SceneError
from quintet.interfaces.params import NotNegative, parameters, shown, unknown

# Keys of a scene that say how its components step and what joins them.
COUPLED_BY = ("scheme", "order", "links", "groups", "iteration")


@parameters
class BeginFrom:
    """The run whose state is the start of this one.

    Parameters
    ----------
    run
        Its folder, from the folder on where the command is started, or else from that of the scene.
    time : s
        Of the state, one of the run's `output.states`; the last that it has if not given.
    components
        Those that begin there; if not given all whose names are in both scenes.
    """

    run: str
    time: NotNegative | None = None
    components: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Beginning:
    """A state of another run, and what of it is taken."""

    folder: Path  # of the run
    path: Path  # of the state
    components: tuple[str, ...]
    scene: dict[str, Any]  # of that run, as it ran

    def goes_on(self, resolved: Mapping[str, Any]) -> bool:
        """Whether a scene couples the same components in the same way as that run did."""
        before, after = self.scene["components"], resolved["components"]
        if before.keys() != after.keys() or set(self.components) != before.keys():
            return False
        return all(self.scene.get(key) == resolved.get(key) for key in COUPLED_BY)


def beginning_of(table: Mapping[str, Any], folder: Path) -> Beginning | None:
    """Find the state that a scene begins from; None where it begins as its own file says.

    What is not well-formed is left to the check of the scene's keys.

    Parameters
    ----------
    table
        The scene.
    folder
        Where it lies.

    Raises
    ------
    SceneError
        Where there is no such run, state or component.
    """
    asked = table.get("begin_from", "")
    asked = {"run": asked} if isinstance(asked, str) else asked
    if not isinstance(asked, dict) or not isinstance(run := asked.get("run"), str) or not run:
        return None
    place = _folder_of(run, folder)
    before = read_file(place / SCENE)
    names = _components(asked.get("components", []), before, table.get("components", {}), place)
    # Only scenes that begin from another run load HDF5.
    from quintet.coupler.files.states import choose

    time = asked.get("time")
    path = choose(place, float(time) if isinstance(time, (int, float)) else None)
    return Beginning(place, path, names, before)


def _folder_of(run: str, folder: Path) -> Path:
    """Find the folder of a run: from the working folder on, or from that of the scene."""
    places = [Path(run).absolute(), (folder / run).absolute()]
    for place in places:
        if place.is_dir() and (marker := read_marker(place)) and marker.kind == "run":
            return place
    where = " or ".join(dict.fromkeys(map(str, places)))
    raise SceneError(
        f"begin_from must be the folder of a run; found {shown(run)}, and no run in {where}. Run "
        "that scene first, or correct the path."
    )


def _components(
    asked: Any, before: Mapping[str, Any], present: Any, place: Path
) -> tuple[str, ...]:
    """Names of the components that begin from a run, which must have them, of the same kinds."""
    former = before["components"]
    present = present if isinstance(present, dict) else {}
    present = {name: entry for name, entry in present.items() if isinstance(entry, dict)}
    if isinstance(asked, list) and asked:
        for name in map(str, asked):
            for known, owner in ((present, "this scene"), (former, f"the run in {place}")):
                if name not in known:
                    where = f"begin_from.components: {name} of {owner}"
                    raise SceneError(unknown(where, name, known))
        names = tuple(map(str, asked))
    else:
        names = tuple(name for name in present if name in former)
    if not names:
        raise SceneError(
            f"begin_from: a component of this scene must be in the run in {place} too, by its name;"
            f" there are {', '.join(former)}, here {', '.join(present)}. Name them alike."
        )
    for name in names:
        was, is_now = former[name].get("kind"), present[name].get("kind")
        if was != is_now:
            raise SceneError(
                f"begin_from: components.{name} must be of kind {was}, as in the run in {place}; "
                f"found {is_now}. Rename it, or leave it out of begin_from.components."
            )
    return names
