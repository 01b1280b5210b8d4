"""Replaced components of a scene: by a stand-in that it describes, a recording, or another kind."""

import re
from pathlib import Path
from typing import Any

from quintet.coupler.files.run_files import RECORDING, read_marker
from quintet.coupler.scene.scene import PLAIN
from quintet.interfaces.errors import SceneError
from quintet.interfaces.manifest import known_kinds, unknown_kind
from quintet.interfaces.params import shown, unknown

Table = dict[str, Any]


def put_swap(table: Table, swap: str) -> list[str]:
    """Replace a component: ``NAME=KIND`` or ``NAME=replay@RUN``; return the mistakes."""
    name, equals, kind = swap.partition("=")
    if not equals:
        return [f"--swap needs NAME=KIND; found {swap!r}. Give it as in --swap NAME=replay."]
    kind, of_run, source = kind.partition("@")
    if of_run and (kind != "replay" or not source):
        return [
            f"--swap {swap}: @ names the run of a replay; found {shown(kind)} of {shown(source)}. "
            "Give it as in --swap NAME=replay@runs/earlier."
        ]
    components = table.get("components")
    if not isinstance(components, dict):
        return [
            f"--swap {swap}: components must be a table; found {shown(components)}. Write "
            "[components.NAME]."
        ]
    if name not in components:
        return [unknown(f"--swap {swap}: component {name}", name, components)]
    if kind in components and kind not in known_kinds():
        return [
            f"--swap {swap}: what takes the place of {name} must be a kind; found {kind}, a "
            f"component of this scene. Name its kind, {_kind_of(components[kind])}, or another."
        ]
    if ":" not in kind and kind not in known_kinds():
        return [unknown_kind(f"--swap {swap}: kind {kind}", kind)]
    try:
        new = _recorded(table, name, source) if kind == "replay" else _stand_in(table, name, kind)
    except SceneError as error:
        return [f"--swap {swap}: {mistake}" for mistake in error.mistakes]
    components[name] = {"kind": kind, **new}
    return []


def _kind_of(keys: Any) -> str:
    return shown(keys.get("kind")) if isinstance(keys, dict) else "its own"


def _recorded(table: Table, name: str, source: str) -> Table:
    """Settings of a replay of a run, of the latest one of the scene if none is named."""
    scene = table.get("name")
    if not source and not (isinstance(scene, str) and PLAIN.fullmatch(scene)):
        raise SceneError(
            f"the scene must have a plain name, by which its runs are found; found {shown(scene)}. "
            f"Name the run: {name}=replay@DIR."
        )
    recording = Path(source) if source else latest_run(str(scene))
    return {"recording": str(recording.resolve()), "component": name}


def latest_run(scene: str) -> Path:
    """Folder of the last run of a scene in ``runs`` that left a recording: of the highest number.

    Without any it is the folder that the first run would have.
    """
    first = Path("runs") / scene
    runs = {1: first} if (first / RECORDING).is_file() else {}
    for path in Path("runs").glob("*") if Path("runs").is_dir() else ():
        number = re.fullmatch(rf"{re.escape(scene)}-([1-9][0-9]{{0,8}})", path.name)
        if number and (path / RECORDING).is_file() and _is_of(path, scene):
            runs[int(number[1])] = path
    return runs[max(runs)] if runs else first


def _is_of(folder: Path, scene: str) -> bool:
    """Whether a folder has a run of a scene; of one whose own name ends in a number it has not."""
    try:
        marker = read_marker(folder)
    except SceneError:  # of another version
        return False
    return marker is not None and (marker.kind, marker.scene) == ("run", scene)


def _stand_in(table: Table, name: str, kind: str) -> Table:
    """Settings that the scene has for a component of a kind in another's place."""
    at: Any = table.get("stand_ins", {})
    place = "stand_ins"
    for part in (name, kind):
        if not isinstance(at, dict):
            break
        at, place = at.get(part, {}), f"{place}.{part}"
    if not isinstance(at, dict):
        raise SceneError(
            f"{place} must be a table of settings; found {shown(at)}. Write "
            f"[stand_ins.{name}.{kind}]."
        )
    return at
