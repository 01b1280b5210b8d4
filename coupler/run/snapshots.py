"""Snapshots on disk, from which an interrupted run goes on with the same bits.

A snapshot holds the state of every component, what the coupler remembers (the last two outputs of
each, what its couplings carry over from window to window, the ledger), and how long the files of
the run were. Nothing in it is pickled; it is there whole or not at all, and ends with a checksum,
by which one that was cut or changed since is found: the run then goes on from the one before.
"""

import contextlib
import sys
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import asdict
from pathlib import Path
from types import MappingProxyType
from typing import Any

import h5py

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
from quintet.coupler.files.hdf5 import create
from quintet.coupler.files.run_files import LEDGER, SNAPSHOTS, numbered, state_file, window_of
from quintet.coupler.files.stored_values import read_value, write_value
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
    return numbered(folder, SNAPSHOTS)


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
    write(path, coupling, scene, logs, judgement, views)
    remove(snapshots(folder)[:-KEPT])
    return path


def keep_state(
    coupling: Coupling,
    scene: Scene,
    folder: Path,
    logs: Mapping[str, ConvergenceLog],
    judgement: Judgement,
) -> None:
    """Write a state that stays, for other runs to begin from."""
    write(folder / state_file(coupling.windows.done), coupling, scene, logs, judgement, {})


def write(
    path: Path,
    coupling: Coupling,
    scene: Scene,
    logs: Mapping[str, ConvergenceLog],
    judgement: Judgement,
    views: Mapping[str, int],
) -> None:
    """Write the state of a run at the end of a window; it is there whole or not at all."""
    folder = path.parent
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
                write_value(file, f"components/{name}", participant.save())
            for name, value in rest.items():
                write_value(file, name, value)
        seal(part)
        put_in_place(part, path)


@contextlib.contextmanager
def _read(path: Path) -> Iterator[h5py.File]:
    """Read a snapshot; what is in it may be anything, though its checksum holds."""
    try:
        with h5py.File(path, "r", locking=False) as file:
            yield file
    except UNREADABLE as error:
        raise SceneError(
            f"snapshot {path.name} is damaged, or no snapshot "
            f"({type(error).__name__}: {error!s:.200}). Remove it, and resume from the one before."
        ) from error


def states(coupling: Coupling) -> dict[str, Any]:
    """What a coupling and its groups carry over from window to window."""
    groups = {k: group.save() for k, group in coupling.members.items() if isinstance(group, Group)}
    return {"own": coupling.save(), "groups": groups}


def restore_states(coupling: Coupling, path: Path) -> None:
    """Bring a coupling whose ports are joined, and its components, to a snapshot."""
    with _read(path) as file:
        tick = read_value(file, "tick")
        if tick != coupling.windows.tick:
            raise SceneError(
                f"snapshot {path.name}: times must be counted in {tick!r} s as before; found "
                f"{coupling.windows.tick!r} s. Resume with the same window and end."
            )
        windows = read_value(file, "windows")
        for name, participant in coupling.components.items():
            participant.load(read_value(file, f"components/{name}"), windows[name])
        state = read_value(file, "coupling")
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
        coupling.ledger.load(read_value(file, "ledger"))
        judgement.load(read_value(file, "judgement"))
        for name, cost in attributes_like(coupling.costs, read_value(file, "costs")).items():
            setattr(coupling.costs, name, cost)
    # Later ones were cut or changed, or are of windows that are now done again.
    remove(snapshot for snapshot in snapshots(path.parent) if window_of(snapshot) > window_of(path))


def latest(folder: Path, quietly: bool = False) -> Path:
    """Find the last snapshot that is as it was written; name those that are not."""
    wrong: list[str] = []
    for path in reversed(snapshots(folder)):
        if is_sound(path):
            if wrong and not quietly:
                message = f"quintet: {' '.join(wrong)} The run goes on from {path.name}."
                print(message, file=sys.stderr, flush=True)
            return path
        wrong.append(f"{path.name} is incomplete or was changed: its checksum differs.")
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
        asked = dict(read_value(file, "asked"))
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
    before, now = _without_places(parse(folder / "scene.toml")), _without_places(scene.resolved)
    keys = [key for key in {**before, **now} if key not in FREE]
    for key in (key for key in keys if before.get(key) != now.get(key)):
        raise SceneError(
            f"{command} {folder}: the scene must be the one that began; {key} has changed. Undo "
            "the change, or run the scene again."
        )


def _without_places(scene: Mapping[str, Any]) -> dict[str, Any]:
    """Return a scene without the keys that say where components compute."""
    places = ("ranks", "threads", "device")
    components = {
        name: {key: value for key, value in table.items() if key not in places}
        for name, table in scene["components"].items()
    }
    return {**scene, "components": components}


def windows_of(path: Path) -> dict[str, int]:
    """Windows that each component had done when a snapshot was made."""
    with _read(path) as file:
        return {name: like(0, done) for name, done in read_value(file, "windows").items()}


def file_sizes(path: Path) -> tuple[int, dict[str, int]]:
    """Lengths of the ledger and of the convergence logs when a snapshot was made [bytes]."""
    with _read(path) as file:
        lengths = dict(read_value(file, "logs"))
        return like(0, read_value(file, "ledger")["size"]), {
            k: like(0, v) for k, v in lengths.items()
        }


def check_files(path: Path) -> None:
    """Refuse to go on with files that were changed since a snapshot was made."""
    with _read(path) as file:
        sums = {
            like("", name): [like(0, number) for number in (size, checksum)]
            for name, (size, checksum) in dict(read_value(file, "files") or {}).items()
        }
    require_same(path.parent, sums, sums)


def view_checks(path: Path) -> dict[str, int]:
    """Checksums of what was in the view files of components when a snapshot was made."""
    with _read(path) as file:
        return dict(read_value(file, "views") or {})
