"""Which run, component and window are debugged, and from where: read and checked."""

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from quintet.coupler.coupling.plan import CouplingPlan
from quintet.coupler.files.disk import is_sound
from quintet.coupler.files.recording import NAME, Recording
from quintet.coupler.files.run_files import RESULTS
from quintet.coupler.run import failed_orders, snapshots
from quintet.coupler.scene.read import load
from quintet.coupler.scene.scene import Scene
from quintet.interfaces.errors import SceneError
from quintet.interfaces.lines.message import Message
from quintet.interfaces.params import unknown


@dataclass(frozen=True, slots=True)
class Request:
    """A component of a run, and the window at which the debugger stops.

    Parameters
    ----------
    window : int
        Counted from 0, as in the sentence of a failure; of a component in a group its own windows.
    snapshot : path or None
        The last one before the window; None: from the start.
    failed_order : Message or None
        The order of this window, where the run failed in it.
    by_recording : bool
        Whether the recording has all that the others gave to it.
    """

    scene: Scene
    folder: Path
    component: str
    window: int
    snapshot: Path | None
    failed_order: Message | None
    fault: str  # why it failed in this window; "" where it did not
    by_recording: bool

    @property
    def first(self) -> int:
        """Windows that the component had done where the repetition begins."""
        return snapshots.windows_of(self.snapshot)[self.component] if self.snapshot else 0


def read_request(folder: Path, component: str, window: int | None) -> Request:
    """Check what is asked for against what a run has left."""
    results = _results(folder)
    scene = _scene(folder, results)
    if component not in scene.components:
        raise SceneError(unknown(f"--component {component}", component, scene.components))
    fault = results.get("fault") or {}
    has_recording = (folder / NAME).is_file()
    by_recording = has_recording and _is_flat(scene.coupling)
    order = failed_orders.read(folder).get(component)
    here = fault.get("component") == component
    if window is None:
        window = int(fault["window"]) if here else _last(folder, component, order, has_recording)
    if window < 0:
        raise SceneError(f"--window must be a number from 0; found {window}. Correct it.")
    if order is not None and order.header.get("window") != window:
        order = None
    cause = str(fault.get("cause")) if here and fault.get("window") == window else ""
    before = _snapshot_before(folder, component, window)
    return Request(scene, folder, component, window, before, order, cause, by_recording)


def _results(folder: Path) -> dict[str, Any]:
    """Results of the run; nothing where its process was killed before it could write them."""
    path = folder / RESULTS
    try:
        results = json.loads(path.read_text(encoding="utf-8")) if path.is_file() else {}
    except (OSError, ValueError) as error:
        raise SceneError(f"{path}: it cannot be read ({error}). Run the scene again.") from error
    return results if isinstance(results, dict) else {}


def _scene(folder: Path, results: dict[str, Any]) -> Scene:
    """Read the scene again, as it was asked for; it must be the one that ran."""
    asked = results.get("asked")
    if not asked:
        asked = snapshots.asked_of(snapshots.latest(folder, quietly=True))
    scene = load(**asked)
    snapshots.check_same(scene, folder, "debug")
    return scene


def _is_flat(plan: CouplingPlan) -> bool:
    """Whether every window is stepped once, with outputs that are recorded at its end."""
    return plan.scheme != "iterated" and not any(plan.members.values())


def _last(folder: Path, component: str, order: Message | None, has_recording: bool) -> int:
    """Last window that the component was ordered."""
    last = int(order.header.get("window", 0)) if order else -1
    if has_recording:
        with Recording(folder / NAME) as recording:
            last = max(last, len(recording.times(component)) - 2)
    if last < 0:
        raise SceneError(
            f"debug {folder}: {component} was ordered no window that is recorded. Name one with "
            "--window."
        )
    return last


def _snapshot_before(folder: Path, component: str, window: int) -> Path | None:
    """Find the last snapshot from which a window is reached."""
    for path in reversed(snapshots.snapshots(folder)):
        if is_sound(path) and snapshots.windows_of(path)[component] <= window:
            return path
    return None
