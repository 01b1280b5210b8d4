"""Results of a run: ``results.json``, pictures and the exit status."""

import os
import platform
import sys
import time
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import TYPE_CHECKING, Any

from quintet.coupler.coupling.participant import ComponentFailed, Participant
from quintet.coupler.coupling.schedule import Costs
from quintet.coupler.files.checksums import of_files, sealed
from quintet.coupler.files.disk import write_at_last
from quintet.coupler.files.recording import Recording
from quintet.coupler.files.run_files import LEDGER, PICTURES, RESULTS, SCENE
from quintet.coupler.measures.advice import Load, advice, serial_share, stages
from quintet.coupler.measures.evaluation import Outcome, evaluate
from quintet.coupler.measures.expectation import ROUNDING, Expectation
from quintet.coupler.report.comparison import comparison
from quintet.coupler.report.panels import can_draw
from quintet.coupler.report.picture import Picture, draw_run
from quintet.coupler.report.profiles import profiles_of
from quintet.coupler.report.view_steps import view_files
from quintet.coupler.scene.overrides import command_line
from quintet.coupler.scene.planned_times import cores_here, may_be_divided, serial_of
from quintet.coupler.scene.scene import ComponentPlan, OutputSettings, Scene
from quintet.interfaces.errors import SceneError
from quintet.interfaces.serving.serve import peak_memory

if TYPE_CHECKING:
    from quintet.coupler.coupling.judgement.error_bar import ErrorBar

DONE, UNMET, BAD, FAILED, INTERRUPTED = 0, 1, 2, 3, 130  # exit status
PACKAGES = ("quintet", "numpy", "numba", "mpi4py", "eclipse-zenoh", "h5py", "msgpack")


def headline(scene: Scene, outcome: dict[str, Any]) -> dict[str, Any]:
    """What ``results.json`` begins with: what ran, how it ended, where, and how to repeat it."""
    return {
        "scene": scene.file.name,
        "preset": scene.preset,
        "transport": scene.transport,
        **outcome,
        "machine": machine(),
        "command": command_line("run", **scene.asked),
        "asked": scene.asked,
    }


def outcomes(scene: Scene, folder: Path) -> list[Outcome]:
    """Evaluate the expectations of a scene."""
    path = folder / "recording.h5"
    if not scene.expect or not path.exists():
        return []
    try:
        with Recording(path) as recording:
            return [_outcome(expectation, recording, scene.folder) for expectation in scene.expect]
    except SceneError as error:
        print(f"quintet: {error}", file=sys.stderr)
        return [_unknown(expectation) for expectation in scene.expect]


def with_error_bars(
    bar: "ErrorBar", scene: Scene, folder: Path, outcomes: list[Outcome]
) -> tuple[list[Outcome], dict[str, Any]]:
    """Put error bars beside outcomes; return them, and what ``results.json`` has of the bars."""
    # Only runs with error bars load it.
    from quintet.coupler.run.error_bars import beside, summary

    path = folder / "recording.h5"
    if not path.exists():
        return outcomes, {}
    with Recording(path) as recording:
        bars = summary(bar, scene, recording)
    return beside(outcomes, bars["watched"]), {"error_bar": bars}


def _outcome(expectation: Expectation, recording: Recording, folder: Path) -> Outcome:
    """Evaluate one expectation; it is not met where the run lacks its item or time."""
    try:
        return evaluate(expectation, recording, folder)
    except SceneError as error:
        print(f"quintet: expectation {expectation.name}: {error}", file=sys.stderr)
        return _unknown(expectation)


def _unknown(expectation: Expectation) -> Outcome:
    """Outcome of an expectation of which nothing is known."""
    return Outcome(
        expectation.name,
        None,
        expectation.value or 0.0,
        expectation.within,
        expectation.unit,
        False,
        expectation.source,
        expectation.required,
        reference_kind=expectation.reference_kind,
        read_from=expectation.read_from,
        doi=expectation.doi,
        licence=expectation.licence,
    )


def picture_of(output: OutputSettings, times: Sequence[float]) -> Picture:
    """Choose what a scene wants to be shown, at some times [s]."""
    region, scale = output.region, output.displacement_scale
    return Picture(times, output.colours, region=region, displacement_scale=scale)


def draw_until(scene: Scene, folder: Path, reached: float) -> None:
    """Draw what was due before a failure at a time [s]; what is torn is left out, and told."""
    output, out = scene.file.output, folder / PICTURES[0]
    due = [time for time in output.pictures if time <= reached]
    if not due or not can_draw():
        return
    try:
        if view_files(folder):
            draw_run(folder, out, picture_of(output, due), scene.headline)
    except (Exception, KeyboardInterrupt) as error:  # the fault is what counts
        print(f"quintet: pictures before the fault left out: {error}", file=sys.stderr, flush=True)


def draw(scene: Scene, folder: Path, outcomes: list[Outcome]) -> None:
    """Draw the pictures of a scene, and its time series against references."""
    output, title = scene.file.output, scene.headline
    if not ((output.pictures or outcomes) and can_draw()):
        return
    if output.pictures and view_files(folder):
        out, end = folder / PICTURES[0], scene.file.end
        if late := [f"{time:g}" for time in output.pictures if time > end * (1.0 + ROUNDING)]:
            beyond = f"pictures at t = {', '.join(late)} s lie beyond the run's end"
            instead = f"its last state, at {end:g} s, is drawn in their place"
            print(f"quintet: {beyond}: {instead}", file=sys.stderr, flush=True)
        draw_run(folder, out, picture_of(output, output.pictures), title)
    if outcomes:
        out, values = folder / PICTURES[1], bool(output.pictures)
        profiles = profiles_of(folder)
        with Recording(folder / "recording.h5") as recording:
            comparison(
                scene.folder, scene.expect, outcomes, recording, out, title, values, profiles
            )


def timing(
    participants: dict[str, Participant], wall: float, costs: Costs, energy: float | None = None
) -> dict[str, Any]:
    """Wall time and its parts [s], and the sum of the peak memories of all processes [bytes].

    Components that are processes of their own build, compile and compute at the same time.
    The energy [J] is there where the machine counts it.
    """
    components = {}
    exchange = compile_time = build_time = 0.0
    memory = peak_memory()
    for name, participant in participants.items():
        times = participant.timing
        components[name] = {
            "compute": times.compute,
            "cpu": times.cpu,
            "build": times.build,
            "wait": max(0.0, wall - times.build - times.prepare - times.compute),
            "steps": times.steps,
            "items": times.items,
            "memory": times.memory or None,
        }
        exchange += max(0.0, times.wait - times.compute)
        compile_time += times.prepare + max(0.0, times.first - times.usual)
        build_time += times.build
        memory += times.memory
    return {
        "wall": wall,
        "build": build_time,
        "compile": compile_time,
        "components": components,
        "exchange": exchange,
        "mapping": costs.mapping,
        "checks": costs.checks,
        "memory": memory,
        **({} if energy is None else {"energy": energy}),
    }


def advise(scene: Scene, participants: Mapping[str, Participant]) -> dict[str, Any]:
    """Who waited for whom, and the threads with which the same run would take the shortest time."""
    loads = {
        name: _load(scene.components[name], participant)
        for name, participant in participants.items()
    }
    if loads.keys() != scene.components.keys():  # it ended before all had joined
        return {}
    return advice(stages(scene.coupling, scene.transport != "memory"), loads, cores_here())


def _load(plan: ComponentPlan, participant: Participant) -> Load:
    times = participant.timing  # of its rank 0, where it has several
    cores = plan.threads if plan.device == "cpu" else 1  # a device computes beside them
    share = serial_share(times.compute, times.cpu, cores)
    planned, measured = serial_of(plan) if share is None else share, share is not None
    divisible = may_be_divided(plan)
    return Load(times.compute, plan.threads, planned, measured, plan.ranks, divisible)


def machine() -> dict[str, Any]:
    """Describe the machine and the versions of the packages."""
    versions = {"python": platform.python_version()}
    for package in PACKAGES:
        try:
            versions[package] = version(package)
        except PackageNotFoundError:
            continue
    return {"cpu": cpu(), "cores": os.cpu_count(), "versions": versions}


def cpu() -> str:
    """Name of the processor."""
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
    except OSError:
        return platform.processor()
    names = [line.partition(":")[2].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.processor()


def fault(error: ComponentFailed, folder: Path, lines: list[str]) -> dict[str, Any]:
    """Describe a failure: component, window, cause, traceback, its log if it has one."""
    log = folder / "log" / f"{error.component}.log"  # a component in this process has none
    return {
        "component": error.component,
        "window": error.window,
        "cause": error.cause,
        "traceback": error.trace,
        "log": str(log) if log.is_file() else "",
        "tail": lines,
    }


def write(folder: Path, content: dict[str, Any]) -> None:
    """Write ``results.json``: whole, and elsewhere where the folder's disk has no room for it.

    It holds the checksums of the files that are read back, where the run has finished them.
    """
    finished = content["status"] in ("done", "interrupted")
    sums = of_files(folder, (LEDGER, SCENE)) if finished else {}
    write_at_last(folder / RESULTS, sealed(content, sums))


def expectations(outcomes: list[Outcome]) -> list[dict[str, Any]]:
    """Outcomes as they stand in ``results.json``."""
    return [asdict(outcome) for outcome in outcomes]


class Clock:
    """Wall time since it was made [s]."""

    def __init__(self) -> None:
        self._began = time.perf_counter()

    def __call__(self) -> float:
        """Return the elapsed time [s]."""
        return time.perf_counter() - self._began
