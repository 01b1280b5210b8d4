"""Snapshots on disk, from which an interrupted run goes on with the same bits.

A snapshot holds the state of every component, what the coupler remembers (last outputs, what
links and the iteration carry over from window to window, the ledger), and how long the files of
the run were. Nothing in it is pickled; it is there whole or not at all.
"""

import json
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from quintet.coupler.coupling.schedule import Coupling
from quintet.coupler.scene.read import load, parse
from quintet.coupler.scene.scene import Scene
from quintet.interfaces.errors import SceneError

KEPT = 2  # snapshots of a run
PATTERN = "snapshot-*.h5"
FREE = ("transport", "endpoint", "tls", "minutes")  # may differ when a run goes on: no bit does


def snapshots(folder: Path) -> list[Path]:
    """Snapshots of a run, the latest last."""
    return sorted(folder.glob(PATTERN), key=window_of)


def window_of(path: Path) -> int:
    """Windows that were done when a snapshot was made."""
    return int(path.stem.rpartition("-")[2])


def remove(paths: Iterable[Path]) -> None:
    """Remove snapshots that are not needed any more."""
    for path in paths:
        path.unlink(missing_ok=True)


def save(coupling: Coupling, scene: Scene, folder: Path, window: int) -> Path:
    """Write a snapshot at the end of a window, and remove all but the last few."""
    path = folder / f"snapshot-{window}.h5"
    part = path.with_suffix(".part")
    with h5py.File(part, "w", locking=False) as file:
        for name, component in coupling.parts.items():
            _put(file, f"components/{name}", component.save())
            _put(file, f"outputs/{name}", dict(coupling.outputs[name]))
        _put(file, "memory", coupling.exchange.memory())
        owed: dict[str, Any] = {name: {} for name in coupling.parts}
        for (name, key), array in coupling.owed.items():
            owed[name][key] = array
        _put(file, "owed", owed)
        numbers = {
            "asked": scene.asked,
            "dt": coupling.dt,
            "sent": coupling.sent,
            "sizes": [[*place, size] for place, size in coupling.sizes.items()],
            "repetitions": coupling.repetitions,
            "ledger": coupling.ledger.save(),
        }
        file["numbers"] = json.dumps(numbers)  # a dataset, as an attribute ends at 64 KiB
    part.replace(path)
    remove(snapshots(folder)[:-KEPT])
    return path


def restore(coupling: Coupling, path: Path) -> int:
    """Bring a coupling that was prepared to a snapshot; return the windows done."""
    window = window_of(path)
    with h5py.File(path, "r", locking=False) as file:
        numbers = _numbers(file)
        if numbers["dt"] != coupling.dt:
            raise SceneError(
                f"snapshot {path.name}: the window must be {numbers['dt']!r} s as before; it is "
                f"{coupling.dt!r} s. Resume with the same window and end."
            )
        for name, part in coupling.parts.items():
            part.window = window
            part.ask("load", _get(file, f"components/{name}"))
            coupling.outputs[name] = _get(file, f"outputs/{name}")
        coupling.exchange.recall(list(_get(file, "memory")))
        owed = _get(file, "owed")
    coupling.owed = {(name, key): a for name, held in owed.items() for key, a in held.items()}
    coupling.sent = numbers["sent"]
    coupling.sizes = {(name, key): size for name, key, size in numbers["sizes"]}
    coupling.repetitions = numbers["repetitions"]
    coupling.ledger.load(numbers["ledger"])
    return window


def latest(folder: Path) -> Path:
    """Find the snapshot from which a run goes on."""
    found = snapshots(folder)
    if not found:
        raise SceneError(
            f"--resume {folder}: it has no snapshot. It was not run, came to its end, or failed "
            "before the first one. Run the scene again."
        )
    return found[-1]


def scene_of(path: Path, transport: str) -> Scene:
    """Read the scene of a snapshot as it was asked for, over another transport if one is given."""
    with h5py.File(path, "r", locking=False) as file:
        asked = _numbers(file)["asked"]
    return load(**{**asked, "transport": transport or asked["transport"]})


def check_same(scene: Scene, folder: Path) -> None:
    """Refuse to go on with a scene that is not the one that began."""
    before, now = parse(folder / "scene.toml"), scene.resolved
    keys = [key for key in {**before, **now} if key not in FREE]
    for key in (key for key in keys if before.get(key) != now.get(key)):
        raise SceneError(
            f"--resume {folder}: the scene must be the one that began; {key} has changed. Undo "
            "the change, or run the scene anew."
        )


def ledger_size(path: Path) -> int:
    """Length of the ledger's file when a snapshot was made [bytes]."""
    with h5py.File(path, "r", locking=False) as file:
        return int(_numbers(file)["ledger"]["size"])


def _numbers(file: h5py.File) -> Any:
    return json.loads(file["numbers"].asstr()[()])


def _put(group: Any, name: str, value: Any) -> None:
    """Write arrays in tables and lists; what is None is left out."""
    if value is None:
        return
    if isinstance(value, dict):
        made = group.create_group(name, track_order=True)
        for number, one in enumerate(value.values()):
            _put(made, str(number), one)
        made.attrs["keys"] = json.dumps(list(value))
    elif isinstance(value, (list, tuple)):
        made = group.create_group(name)
        for number, one in enumerate(value):
            _put(made, str(number), one)
        made.attrs["count"] = len(value)
    else:
        group[name] = np.asarray(value)


def _get(group: Any, name: str) -> Any:
    if name not in group:
        return None
    found = group[name]
    if isinstance(found, h5py.Dataset):
        return np.asarray(found[()])
    if "keys" in found.attrs:
        keys = json.loads(found.attrs["keys"])
        return {key: _get(found, str(number)) for number, key in enumerate(keys)}
    return tuple(_get(found, str(number)) for number in range(found.attrs["count"]))
