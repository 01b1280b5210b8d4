"""Which refinements of all scenes are quick, and how long they will take."""

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from quintet.coupler.run.results import machine
from quintet.coupler.scene.overrides import assignments
from quintet.coupler.scene.planned_times import planned_seconds
from quintet.coupler.scene.read import load, load_variants, parse
from quintet.coupler.scene.scene import Scene
from quintet.coupler.scene.study_table import Refinement
from quintet.coupler.study.run_hash import run_hash
from quintet.coupler.study.sweep_plan import SceneRequest
from quintet.coupler.study.sweep_run import Job

KEPT = "studies.json"  # beside the folders of the scenes: what was measured before
QUICK = 60.0  # s, longest run of a quick refinement
START = 4.0  # s to start a run, to draw, and to end it


@dataclass(frozen=True, slots=True)
class Planned:
    """One refinement of one scene.

    Attributes
    ----------
    seconds : float
        Run time, as measured before or estimated.
    job : Job
        Its run.
    """

    scene: str
    refinement: Refinement
    seconds: float
    job: Job

    @property
    def is_quick(self) -> bool:
        """Whether its run time is at most a minute."""
        return self.seconds <= QUICK


def plan_all(folder: Path, scenes: Mapping[str, Path], retry: int = 1) -> list[Planned]:
    """All refinements of scenes, given by name and file, to be run in a folder."""
    versions = machine()["versions"]
    planned = []
    for name, path in sorted(scenes.items()):
        if not parse(path).get("study"):
            continue
        base, variants = load_variants(str(path))
        before = measured_times(path.parent.parent / KEPT, name)
        for refinement in variants.study:
            scene = load(str(path), settings=list(assignments(refinement.settings)))
            seconds = before.get(_key(refinement.settings)) or estimated(base, scene)
            asked: SceneRequest = (str(path), "", [], [], "")
            job = Job(
                run_hash(scene), folder, asked, refinement.settings, scene.resolved, versions, retry
            )
            planned.append(Planned(name, refinement, seconds, replace(job, resumes=False)))
    return planned


def estimated(base: Scene, scene: Scene) -> float:
    """Run time [s]: `minutes` of the scene, by what its kinds plan for it and the refinement."""
    times = [
        sum(planned_seconds(component, variant.file) for component in variant.components.values())
        for variant in (base, scene)
    ]
    ratio = times[1] / times[0] if times[0] > 0.0 else 1.0
    return START + 60.0 * base.file.minutes * ratio


def measured_times(path: Path, scene: str) -> dict[str, float]:
    """Run times [s] of a scene's refinements that were measured before, by their settings.

    At most a start and the processor time of the components: beside other work runs take longer.
    """
    rows = (row for study in read_studies(path) if study["scene"] == scene for row in study["rows"])
    return {
        _key(row["settings"]): min(row["wall"], START + row["cpu"])
        for row in rows
        if row["status"] == "done"
    }


def read_studies(path: Path | None) -> list[dict[str, Any]]:
    """Studies in a file that `quintet study --all` has written; none where there is no file."""
    if path is None or not path.is_file() or not path.stat().st_size:
        return []
    content: list[dict[str, Any]] = json.loads(path.read_text(encoding="utf-8"))
    return content


def _key(settings: dict[str, Any]) -> str:
    return json.dumps(settings, sort_keys=True)


def within_budget(planned: list[Planned], seconds: float) -> Iterator[Planned]:
    """Yield the quick ones that are not complete and fit into a time [s], the shortest first."""
    names: set[str] = set()
    for entry in sorted(planned, key=lambda entry: entry.seconds):
        if entry.is_quick and entry.job.name not in names and entry.job.complete() is None:
            seconds -= entry.seconds
            if seconds < 0.0:
                return
            names.add(entry.job.name)
            yield entry
