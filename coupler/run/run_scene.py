"""Running a scene over any transport: in this process, or as an MPI job started from it."""

import os
from pathlib import Path

from quintet.coupler.files.disk import reserve
from quintet.coupler.files.run_files import RECORDING, RESULTS
from quintet.coupler.launch.mpi_job import find_launcher, run_under_mpi
from quintet.coupler.run import results
from quintet.coupler.run.folder import begin, files_of, go_on
from quintet.coupler.run.simulate import conclude_for_coupler, make_folder, simulate
from quintet.coupler.scene.needs import require_memory
from quintet.coupler.scene.overrides import run_arguments
from quintet.coupler.scene.scene import Scene
from quintet.interfaces.errors import QuintetError, SceneError
from quintet.interfaces.libraries import require
from quintet.interfaces.lines.endpoint import require_free


def run_scene(
    scene: Scene,
    out: Path | None = None,
    force: bool = False,
    own_process: bool = False,
    rank: bool = False,
) -> tuple[Path, int]:
    """Run a scene from its start; return the folder of the run and the exit status.

    Parameters
    ----------
    out : path or None
        A new or empty folder; ``runs/NAME``, or the next number that is free, if not given.
    force : bool
        Replace a former run in the folder: only what it wrote, once the new one has begun.
    own_process : bool
        Whether this process may be left from within, if a solver in it does not come back.
    rank : bool
        Whether it is rank 0 of an MPI job that a launcher has started with all its ranks.
    """
    check_machine(scene, rank)  # before a former run is touched
    replaced = out or (Path("runs") / scene.file.name if force else None)
    if scene.beginning and replaced and replaced.resolve() == scene.beginning.folder.resolve():
        raise SceneError(
            f"--out {replaced}: it must be another folder than that of begin_from, whose state is "
            "read. Name another."
        )
    with begin("run", scene.file.name, files_of(scene), out, force) as place:
        try:
            make_folder(scene, place.path)
            print(headline(scene, place.path), flush=True)
            status = _run(scene, place.path, None, own_process, rank)
        except QuintetError:
            if not (place.path / RECORDING).exists():  # else it began, and what it wrote stays
                place.undo()
            raise
        if status == results.BAD and place.replaces:
            place.undo()
    return place.path, status


def resume_scene(
    scene: Scene, folder: Path, snapshot: Path, own_process: bool = False, rank: bool = False
) -> int:
    """Continue a run from one of its snapshots; return the exit status. See `run_scene`."""
    check_machine(scene, rank)
    with go_on(folder, "run"):
        reserve(folder, RESULTS)
        print(headline(scene, folder), flush=True)
        return _run(scene, folder, snapshot, own_process, rank)


def _several(count: int, unit: str) -> str:
    return f", {count} {unit}" if count > 1 else ""


def headline(scene: Scene, folder: Path) -> str:
    """What is about to run: scene, transport, components, folder."""
    name = scene.file.name + (f" ({scene.preset})" if scene.preset else "")
    parts = [
        f"{component.name} ({component.kind}{_several(component.ranks, 'ranks')}"
        f"{_several(component.threads, 'threads')})"
        for component in scene.components.values()
    ]
    where = os.path.relpath(folder)
    return f"{name}: {', '.join(parts)} over {scene.transport}, into {where}"


def check_machine(scene: Scene, rank: bool = False) -> None:
    """Refuse what this machine lacks: memory, a library, a launcher, an endpoint that is free."""
    require_memory(scene, scene.elsewhere)
    if scene.transport == "mpi" and not rank:
        find_launcher()
    elif scene.transport == "zenoh":
        require("zenoh", "transport zenoh")
        if scene.endpoint:
            require_free(scene.endpoint)


def _run(scene: Scene, folder: Path, snapshot: Path | None, own_process: bool, rank: bool) -> int:
    if scene.transport == "mpi" and not rank:
        target = ["--resume", str(folder)] if snapshot else ["--out", str(folder)]
        target += ["--grace", str(scene.grace)] if scene.grace else []
        target += ["--chaos", str(scene.chaos)] if scene.chaos is not None else []
        end = run_under_mpi(["run", *run_arguments(**scene.asked), *target], scene, folder)
        if end.cause:
            conclude_for_coupler(scene, folder, end.status, end.cause)
        return end.status
    return simulate(scene, folder, snapshot, own_process)
