"""How long components will compute, by what their kinds plan, and on how many cores they should."""

import math
import os
from typing import Any

from quintet.coupler.measures.advice import Load, advice, stages
from quintet.coupler.scene.scene import ComponentPlan, Scene, SceneFile


def cores_here() -> int:
    """Cores of this machine that this process may use; all that SLURM lends it here in a job."""
    return max(len(os.sched_getaffinity(0)), int(os.environ.get("SLURM_CPUS_ON_NODE", "0")))


def planned_seconds(component: ComponentPlan, file: SceneFile) -> float:
    """Computing time of a whole run on one core [s]; 0 where the kind plans none."""
    plan = component.planned
    if plan is None:
        return 0.0
    step = plan.dt if file.window == "auto" else min(plan.dt, file.window)
    return float(plan.items) * math.ceil(file.end / step) / plan.rate if step < math.inf else 0.0


def planned_load(component: ComponentPlan, file: SceneFile) -> Load:
    """The same on the ranks and threads that the scene has."""
    alone = Load(planned_seconds(component, file), serial=serial_of(component))
    return Load(
        alone.on(component.ranks * component.threads),
        component.threads,
        alone.serial,
        ranks=component.ranks,
        divisible=may_be_divided(component),
    )


def serial_of(component: ComponentPlan) -> float:
    """Share of a component's time that more threads do not shorten, as its kind plans.

    It is all of it on a device, which computes beside the cores.
    """
    is_on_cores = component.device == "cpu"
    return component.planned.serial if component.planned and is_on_cores else 1.0


def may_be_divided(component: ComponentPlan) -> bool:
    """Whether more cores, as ranks, may shorten a component's time."""
    return component.manifest.ranks and component.device == "cpu"


def planned_advice(scene: Scene) -> dict[str, Any]:
    """Threads for the shortest run on this machine, before it; see `advice`."""
    loads = {name: planned_load(plan, scene.file) for name, plan in scene.components.items()}
    return advice(stages(scene.coupling, scene.transport != "memory"), loads, cores_here())
