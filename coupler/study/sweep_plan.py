"""What a series has to run: every combination of settings, checked before anything starts."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from quintet.coupler.run.results import machine
from quintet.coupler.run.run_scene import check_machine
from quintet.coupler.scene.overrides import assignments, value_text
from quintet.coupler.scene.quantity_texts import units_of_keys
from quintet.coupler.scene.read import load
from quintet.coupler.scene.scene import Scene
from quintet.coupler.scene.sweep_axes import Axis, label
from quintet.coupler.scene.varied_tables import value_at
from quintet.coupler.study.run_hash import run_hash
from quintet.coupler.study.sweep_run import Job
from quintet.interfaces.errors import SceneError
from quintet.interfaces.quantities import has_quantities

# Scene, preset, settings, swaps and transport, as on the command line.
SceneRequest = tuple[str, str, list[str], list[str], str]


def plan(
    series: str, asked: SceneRequest, products: Sequence[Mapping[str, Any]], jobs: int, retry: int
) -> tuple[str, list[Job]]:
    """Check every run; return the scene's name and the runs, whose folder is unknown.

    Parameters
    ----------
    series : str
        The command, for messages.
    asked : tuple
        Scene, preset, settings, swaps and transport, as on the command line.
    products : sequence of mappings
        Settings of each run by dotted path, on top of these.
    jobs, retry : int

    Raises
    ------
    SceneError
        With every mistake, each with the combinations that it is in.
    """
    name, preset, settings, swaps, transport = asked
    mistakes: dict[str, list[str]] = {}
    labels: dict[str, str] = {}  # by hash
    planned: list[Job] = []
    scene_name, versions = "", machine()["versions"]
    for combination in products:
        words = [*settings, *assignments(combination)]
        try:
            scene = load(name, preset, words, swaps, transport)
            _check(scene, jobs)
        except SceneError as error:
            for mistake in error.mistakes:
                mistakes.setdefault(mistake, []).append(label(combination))
            continue
        digest, scene_name = run_hash(scene), scene.file.name
        if digest in labels:
            same = f"{labels[digest]} and {label(combination)}"
            mistakes[f"{series}: {same} are the same run. Remove one of the values."] = []
        labels[digest] = label(combination)
        numbers = _in_si(combination, scene)
        planned.append(Job(digest, Path(), asked, numbers, scene.resolved, versions, retry))
    if mistakes:
        raise SceneError([_told(*entry, len(products)) for entry in mistakes.items()])
    return scene_name, planned


def _in_si(settings: Mapping[str, Any], scene: Scene) -> dict[str, Any]:
    """Settings with numbers in the place of texts with units, as the scene runs."""
    return {
        path: value_at(scene.resolved, path)[0] if has_quantities(value) else value
        for path, value in settings.items()
    }


def axes_of_jobs(axes: Sequence[Axis], jobs: Sequence[Job]) -> list[Axis]:
    """Axes with the units of their keys and the values of the runs: of texts with units numbers."""
    name, preset, settings, swaps, transport = jobs[0].asked
    words = [*settings, *assignments(jobs[0].settings)]
    scene = load(name, preset, words, swaps, transport)
    units = units_of_keys(scene, [axis.path for axis in axes])
    return [Axis(axis.path, _values(axis, jobs), units.get(axis.path, "")) for axis in axes]


def _values(axis: Axis, jobs: Sequence[Job]) -> tuple[Any, ...]:
    if not has_quantities(axis.values):
        return axis.values
    values = [job.settings[axis.path] for job in jobs]
    return tuple({value_text(value): value for value in values}.values())


def _check(scene: Scene, jobs: int) -> None:
    """Refuse what this machine lacks, and runs at once that would listen at one endpoint."""
    check_machine(scene)
    if scene.endpoint and jobs > 1:
        raise SceneError(
            f"scene.endpoint must be left out where runs are done at once; found {scene.endpoint}. "
            "Remove it, or give --jobs 1."
        )


def _told(mistake: str, labels: list[str], count: int) -> str:
    """Say in which combinations a mistake is."""
    if not labels:
        return mistake
    if len(labels) == count and count > 1:
        return f"{mistake} (in all {count} combinations)"
    more = f" and {len(labels) - 1} more of {count} combinations" if len(labels) > 1 else ""
    return f"{mistake} (with {labels[0]}{more})"
