"""Snapshots on disk, from which an interrupted run goes on with the same bits.

A snapshot holds the state of every component, what the coupler remembers (the last two outputs of
each, what its couplings carry over from window to window, the ledger), and how long the files of
the run were. Nothing in it is pickled; it is there whole or not at all, and ends with a checksum,
by which one that was cut or changed since is found: the run then goes on from the one before.
"""

import contextlib
import json
import sys
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import asdict
from pathlib import Path
from types import MappingProxyType
from typing import Any

import h5py
import numpy as np

from quintet.coupler.coupling.group import Group
from quintet.coupler.coupling.iteration.convergence_log import ConvergenceLog, log_file
from quintet.coupler.coupling.judgement.checks import Judgement
from quintet.coupler.coupling.saved_values import attributes_like, like, require_same_keys
from quintet.coupler.coupling.schedule import Coupling
from quintet.coupler.files.checksums import of_files, require_same
from quintet.coupler.files.disk import (
    PART,
    is_sound,
    put_in_place,
    removed_on_failure,
    reporting_disk,
    seal,
)
from quintet.coupler.files.hdf5 import OF_DATASET, create, room
from quintet.coupler.files.run_files import LEDGER, SNAPSHOTS
from quintet.coupler.scene.read import load, parse
from quintet.coupler.scene.scene import Scene
from quintet.interfaces.errors import SceneError

KEPT = 2  # snapshots of a run
# What reading raises where something is missing, or of another type or shape.
UNREADABLE = (
    OSError, LookupError, TypeError, ValueError, AttributeError, RuntimeError, AssertionError,
    ArithmeticError, MemoryError,
)  # fmt: skip
# Keys that may differ when a run goes on: no bit does.
FREE = ("transport", "endpoint", "tls", "minutes", "patience", "restarts")


def snapshots(folder: Path) -> list[Path]:
    """Snapshots of a run, the latest last."""
    return sorted(folder.glob(SNAPSHOTS), key=window_of)


def window_of(path: Path) -> int:
    """Windows that were done when a snapshot was made."""
    return int(path.stem.rpartition("-")[2])


def remove(paths: Iterable[Path]) -> None:
    """Remove snapshots that are not needed any more."""
    for path in paths:
        path.unlink(missing_ok=True)


def save(
    coupling: Coupling,
    scene: Scene,
    folder: Path,
    logs: Mapping[str, ConvergenceLog],
    judgement: Judgement,
    views: Mapping[str, int] = MappingProxyType({}),
) -> Path:
    """Write a snapshot at the end of a window, and remove all but the last few.

    `views` has the checksum of what is in each component's view file.
    """
    path = folder / f"snapshot-{coupling.windows.done}.h5"
    part = path.with_name(path.name + PART)
    participants = coupling.components
    coupling.ledger.sync()
    for log in logs.values():
        log.sync()
    rest = {
        "windows": {name: participant.window for name, participant in participants.items()},
        "coupling": states(coupling),
        "ledger": coupling.ledger.save(),
        "judgement": judgement.save(),
        "costs": asdict(coupling.costs),
        "logs": {name: log.size() for name, log in logs.items()},
        "asked": scene.asked,
        "tick": coupling.windows.tick,
        "files": of_files(folder, (LEDGER, *map(log_file, logs))),
        "views": dict(views),
    }
    with removed_on_failure(part), reporting_disk(path):
        with create(part) as file:
            for name, participant in participants.items():
                _write(file, f"components/{name}", participant.save())
            for name, value in rest.items():
                _write(file, name, value)
        seal(part)
        put_in_place(part, path)
    remove(snapshots(folder)[:-KEPT])
    return path


def _write(file: h5py.File, name: str, value: Any) -> None:
    with room(file, _largest(value)):
        _put(file, name, value)


def _largest(value: Any) -> int:
    """Bytes that a value may need on the disk."""
    if isinstance(value, dict):
        return OF_DATASET + sum(map(_largest, value.values()))
    if isinstance(value, (list, tuple)) and any(isinstance(item, np.ndarray) for item in value):
        return OF_DATASET + sum(map(_largest, value))
    size = value.nbytes if isinstance(value, np.ndarray) else len(json.dumps(value))
    return OF_DATASET + int(size)


@contextlib.contextmanager
def _read(path: Path) -> Iterator[h5py.File]:
    """Read a snapshot; what is in it may be anything, though its checksum holds."""
    try:
        with h5py.File(path, "r", locking=False) as file:
            yield file
    except UNREADABLE as error:
        raise SceneError(
            f"snapshot {path.name}: it must have what a run writes into it; it has not "
            f"({type(error).__name__}: {error!s:.200}). Remove it, and resume from the one before."
        ) from error


def states(coupling: Coupling) -> dict[str, Any]:
    """What a coupling and its groups carry over from window to window."""
    groups = {k: group.save() for k, group in coupling.members.items() if isinstance(group, Group)}
    return {"own": coupling.save(), "groups": groups}


def restore_states(coupling: Coupling, path: Path) -> None:
    """Bring a coupling whose ports are joined, and its components, to a snapshot."""
    with _read(path) as file:
        tick = _get(file, "tick")
        if tick != coupling.windows.tick:
            raise SceneError(
                f"snapshot {path.name}: times must be counted in {tick!r} s as before; found "
                f"{coupling.windows.tick!r} s. Resume with the same window and end."
            )
        windows = _get(file, "windows")
        for name, participant in coupling.components.items():
            participant.load(_get(file, f"components/{name}"), windows[name])
        state = _get(file, "coupling")
        _require_same_fields(coupling, state["own"])
        coupling.load(state["own"])
        for name, saved in state["groups"].items():
            group = coupling.members[name]
            assert isinstance(group, Group)
            group.load(saved)


def _require_same_fields(coupling: Coupling, state: Mapping[str, Any]) -> None:
    """Refuse a state whose components or fields are others than those that were joined."""
    for key in ("outputs", "previous", "sent"):
        present = getattr(coupling, key)
        require_same_keys(present, state[key])
        if key != "sent":
            for name, fields in present.items():
                require_same_keys(fields, state[key][name])
    like(0.0, state["last_dt"])


def restore(coupling: Coupling, judgement: Judgement, path: Path) -> None:
    """Bring a run whose ports are joined to a snapshot."""
    restore_states(coupling, path)
    with _read(path) as file:
        coupling.ledger.load(_get(file, "ledger"))
        judgement.load(_get(file, "judgement"))
        for name, cost in attributes_like(coupling.costs, _get(file, "costs")).items():
            setattr(coupling.costs, name, cost)
    # Later ones were cut or changed, or are of windows that are now done again.
    remove(snapshot for snapshot in snapshots(path.parent) if window_of(snapshot) > window_of(path))


def latest(folder: Path, quietly: bool = False) -> Path:
    """Find the last snapshot that is as it was written; name those that are not."""
    wrong: list[str] = []
    for path in reversed(snapshots(folder)):
        if is_sound(path):
            if wrong and not quietly:
                said = f"quintet: {' '.join(wrong)} The run goes on from {path.name}."
                print(said, file=sys.stderr, flush=True)
            return path
        wrong.append(f"{path.name} is not as it was written: it was cut or changed.")
    if wrong:
        raise SceneError(
            f"--resume {folder}: it has no snapshot that can be used. {' '.join(wrong)} Run the "
            "scene again."
        )
    raise SceneError(
        f"--resume {folder}: it has no snapshot. It was not run, came to its end, or failed "
        "before the first one. Run the scene again."
    )


def asked_of(path: Path) -> dict[str, Any]:
    """What was asked for in the run of a snapshot: a scene, and what changes it."""
    with _read(path) as file:
        asked = dict(_get(file, "asked"))
        patterns = {"scene": "", "preset": "", "transport": "", "settings": [], "swaps": []}
        for key, pattern in patterns.items():
            if isinstance(pattern, list):
                asked[key] = [like("", text) for text in like(pattern, asked[key])]
            else:
                like(pattern, asked[key])
        return asked


def scene_of(path: Path, transport: str) -> Scene:
    """Read the scene of a snapshot as it was asked for, over another transport if one is given."""
    asked = asked_of(path)
    return load(**{**asked, "transport": transport or asked["transport"]})


def check_same(scene: Scene, folder: Path, command: str = "--resume") -> None:
    """Refuse to go on with a scene that is not the one that began; cores may differ."""
    before, now = _without_cores(parse(folder / "scene.toml")), _without_cores(scene.resolved)
    keys = [key for key in {**before, **now} if key not in FREE]
    for key in (key for key in keys if before.get(key) != now.get(key)):
        raise SceneError(
            f"{command} {folder}: the scene must be the one that began; {key} has changed. Undo "
            "the change, or run the scene again."
        )


def _without_cores(scene: Mapping[str, Any]) -> dict[str, Any]:
    """Return a scene without the keys by which components share work out: they change no bit."""
    components = {
        name: {key: value for key, value in table.items() if key not in ("ranks", "threads")}
        for name, table in scene["components"].items()
    }
    return {**scene, "components": components}


def windows_of(path: Path) -> dict[str, int]:
    """Windows that each component had done when a snapshot was made."""
    with _read(path) as file:
        return {name: like(0, done) for name, done in _get(file, "windows").items()}


def file_sizes(path: Path) -> tuple[int, dict[str, int]]:
    """Lengths of the ledger and of the convergence logs when a snapshot was made [bytes]."""
    with _read(path) as file:
        lengths = dict(_get(file, "logs"))
        return like(0, _get(file, "ledger")["size"]), {k: like(0, v) for k, v in lengths.items()}


def check_files(path: Path) -> None:
    """Refuse to go on with files that were changed since a snapshot was made."""
    with _read(path) as file:
        sums = {
            like("", name): [like(0, number) for number in (size, checksum)]
            for name, (size, checksum) in dict(_get(file, "files") or {}).items()
        }
    require_same(path.parent, sums, sums)


def view_checks(path: Path) -> dict[str, int]:
    """Checksums of what was in the view files of components when a snapshot was made."""
    with _read(path) as file:
        return dict(_get(file, "views") or {})


def _put(group: Any, name: str, value: Any) -> None:
    """Write tables and lists of arrays, numbers and texts; None is left out."""
    if value is None:
        return
    if isinstance(value, dict):
        part = group.create_group(name, track_order=True)
        for number, item in enumerate(value.values()):
            _put(part, str(number), item)
        part.attrs["keys"] = json.dumps(list(value))
    elif isinstance(value, (list, tuple)) and any(isinstance(item, np.ndarray) for item in value):
        part = group.create_group(name)
        for number, item in enumerate(value):
            _put(part, str(number), item)
        part.attrs["count"] = len(value)
    elif isinstance(value, np.ndarray):
        group[name] = value
    else:
        group[name] = json.dumps(value)  # a dataset, as an attribute ends at 64 KiB
        group[name].attrs["json"] = True


def _get(group: Any, name: str) -> Any:
    if name not in group:
        return None
    stored = group[name]
    if isinstance(stored, h5py.Dataset):
        if "json" in stored.attrs:
            return json.loads(stored.asstr()[()])
        return np.asarray(stored[()])
    if "keys" in stored.attrs:
        keys = [_key(key) for key in json.loads(stored.attrs["keys"])]
        return {key: _get(stored, str(number)) for number, key in enumerate(keys)}
    return tuple(_get(stored, str(number)) for number in range(stored.attrs["count"]))


def _key(key: Any) -> Any:
    """A key of a table; JSON has lists where tables have tuples."""
    return tuple(key) if isinstance(key, list) else key
