"""What is left of a run: ``results.json``, pictures, and the status it ends with."""

import json
import os
import platform
import sys
import time
from dataclasses import asdict
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

from quintet.coupler.coupling.participant import ComponentFailed, Part
from quintet.coupler.files.recording import Recording
from quintet.coupler.measures.expectation import Expectation, Outcome, evaluate
from quintet.coupler.report.pictures import comparison, snapshots
from quintet.coupler.scene.scene import Scene
from quintet.interfaces.errors import SceneError
from quintet.interfaces.serving.serve import peak_memory

DONE, UNMET, BAD, FAILED, INTERRUPTED = 0, 1, 2, 3, 130  # exit status
PACKAGES = ("quintet", "numpy", "numba", "mpi4py", "eclipse-zenoh", "h5py", "msgpack")


def outcomes(scene: Scene, folder: Path) -> list[Outcome]:
    """Compare a run with what its scene expects."""
    path = folder / "recording.h5"
    if not scene.expect or not path.exists():
        return []
    with Recording(path) as recording:
        return [_outcome(one, recording, scene.folder) for one in scene.expect]


def _outcome(one: Expectation, recording: Recording, folder: Path) -> Outcome:
    """Compare; what a run turns out not to have, an item or a time, is not met."""
    try:
        return evaluate(one, recording, folder)
    except SceneError as error:
        print(f"quintet: expectation {one.name}: {error}", file=sys.stderr)
        return Outcome(one.name, None, one.value or 0.0, one.within, one.unit, False, one.source)


def draw(scene: Scene, folder: Path, found: list[Outcome]) -> None:
    """Draw the pictures that the scene asks for; nothing of it is loaded where there are none."""
    times = scene.file.output.pictures
    if times and list(folder.glob("*.vtkhdf")):
        snapshots(folder, folder / "scene.png", times)
    if any(one.csv for one in scene.expect) and found:
        with Recording(folder / "recording.h5") as recording:
            comparison(scene.folder, scene.expect, found, recording, folder / "comparison.png")


def timing(parts: dict[str, Part], wall: float, mapping: float) -> dict[str, Any]:
    """Wall time, and where it went; memory of all processes together at their peaks [bytes]."""
    components = {}
    exchange = compile_time = 0.0
    for name, part in parts.items():
        one = part.timing
        components[name] = {
            "compute": one.compute,
            "cpu": one.cpu,
            "wait": max(0.0, wall - one.compute),
            "steps": one.steps,
            "items": one.items,
            "memory": one.memory or None,
        }
        exchange += max(0.0, one.wait - one.compute)
        compile_time += max(0.0, one.first - one.usual)
    return {
        "wall": wall,
        "compile": compile_time,
        "components": components,
        "exchange": exchange,
        "mapping": mapping,
        "memory": peak_memory() + sum(part.timing.memory for part in parts.values()),
    }


def machine() -> dict[str, Any]:
    """On what it ran, and with which versions."""
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
    """Who failed, when, why, and what it said last."""
    return {
        "component": error.component,
        "window": error.window,
        "cause": error.cause,
        "traceback": error.trace,
        "log": str(folder / "log" / f"{error.component}.log"),
        "tail": lines,
    }


def write(folder: Path, content: dict[str, Any]) -> None:
    """Write ``results.json`` in one piece: there is never half of one."""
    path = folder / "results.json"
    part = path.with_suffix(".part")
    part.write_text(json.dumps(content, indent=2, default=float))
    part.replace(path)


def expectations(found: list[Outcome]) -> list[dict[str, Any]]:
    """As ``results.json`` says it."""
    return [asdict(one) for one in found]


class Clock:
    """Wall time since it was made [s]."""

    def __init__(self) -> None:
        self._began = time.perf_counter()

    def __call__(self) -> float:
        """Return the seconds gone by."""
        return time.perf_counter() - self._began
