"""Whether a run can be: how many windows and steps it has, and whether its memory is there."""

from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path

import numpy as np
import psutil

from quintet.coupler.coupling.exchange import Exchange
from quintet.coupler.coupling.link import Link
from quintet.coupler.coupling.plan import CouplingPlan
from quintet.coupler.coupling.windows import run_windows
from quintet.coupler.scene.scene import ComponentPlan, Scene, SceneFile
from quintet.interfaces.component import Array
from quintet.interfaces.errors import SceneError

MOST = 2**53  # windows or steps of a run: so many can be counted, and times told apart
ROUNDING = 1e-9  # of a window, by which recorded times may differ
LIMITS = ("/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes")
GIGA = 1e9  # bytes


def refused_times(
    file: SceneFile,
    components: Mapping[str, ComponentPlan],
    coupling: CouplingPlan,
    links: list[Link],
) -> list[str]:
    """Sentences about windows and steps without number, and times that a recording lacks."""
    if wrong := list(_countless(file, components)):
        return wrong
    ports = {name: (component.takes, component.gives) for name, component in components.items()}
    equal = coupling.equal(Exchange(links, ports))
    for name in coupling.members:
        component = components.get(name)
        if (
            component is not None
            and component.planned is not None
            and component.planned.times is not None
        ):
            window = "auto" if equal else file.window
            wrong += _missing(component, component.planned.times, file.end, window)
    return wrong


def _countless(file: SceneFile, components: Mapping[str, ComponentPlan]) -> Iterator[str]:
    if file.window != "auto" and file.end / file.window > MOST:
        yield (
            f"scene.end must be at most {MOST:.0e} windows; found {file.end:g} s, of windows of "
            f"{file.window:g} s. End earlier, or lengthen scene.window."
        )
    for name, component in components.items():
        plan = component.planned
        if plan is None:
            continue
        if not plan.dt > 0.0 or file.end / plan.dt > MOST:
            yield (
                f"components.{name}: it must come to scene.end, {file.end:g} s, in at most "
                f"{MOST:.0e} steps; its step would be {plan.dt:.3g} s. Correct its sizes, "
                "stiffnesses and speeds, or scene.end."
            )


def _missing(
    component: ComponentPlan, times: Array, end: float, window: float | str
) -> Iterator[str]:
    """Ends of windows at which a component cannot give."""
    where = f"components.{component.name}: a replay can give at the times of its recording only"
    last = float(times[-1]) if len(times) else 0.0
    if end > last * (1.0 + ROUNDING):
        yield (
            f"{where}, which ends at {last:g} s; scene.end is {end:g} s. End there, replay a "
            "longer run, or one of this scene."
        )
    elif isinstance(window, float):
        windows = run_windows(end, window, False, False)
        if windows.end < len(times):
            ends = windows.tick * np.arange(1, windows.end + 1)
            place = np.minimum(
                np.searchsorted(times, ends - ROUNDING * windows.tick), len(times) - 1
            )
            lacking = np.abs(times[place] - ends) > ROUNDING * np.maximum(windows.tick, ends)
            if not lacking.any():
                return
            count = f"none at {ends[lacking][0]:g} s"
        else:
            count = f"{max(0, len(times) - 1)} windows"
        usual = float(np.median(np.diff(times))) if len(times) > 1 else 0.0
        yield (
            f"{where}; this run has {windows.end} windows of {windows.tick:g} s, the recording "
            f"{count} (of {usual:g} s). Set scene.window to that of the recorded run, or replay "
            "one of this scene."
        )


def require_memory(scene: Scene, elsewhere: Iterable[str] = ()) -> None:
    """Refuse a scene whose components, those that start here, need more memory than there is."""
    plans = {name: plan.planned for name, plan in scene.components.items() if name not in elsewhere}
    needs = {
        name: (float(plan.items), float(plan.items) * plan.bytes_per_item)
        for name, plan in plans.items()
        if plan is not None
    }
    planned, memory = sum(need for _, need in needs.values()), machine_memory()
    if planned <= memory:
        return
    parts = ", ".join(
        f"{name} {need / GIGA:.3g} GB for {items:.3g}" for name, (items, need) in needs.items()
    )
    raise SceneError(
        f"{scene.path.name}: components must fit into this machine's memory of "
        f"{memory / GIGA:.3g} GB; planned are {planned / GIGA:.3g} GB ({parts} particles, bodies "
        "or elements). Coarsen the spacing, or start components on other hosts."
    )


def machine_memory() -> float:
    """Memory of this machine, or the part of it that this process may use [bytes]."""
    sizes = [float(psutil.virtual_memory().total)]
    for limit in LIMITS:
        try:
            sizes.append(float(Path(limit).read_text()))
        except (OSError, ValueError):  # none of this version of control groups, or "max"
            continue
    return min(sizes)
