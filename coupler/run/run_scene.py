"""Running a scene over any transport: in this process, or as an MPI job started from it."""

from pathlib import Path

from quintet.coupler.launch.mpi_job import run_under_mpi
from quintet.coupler.run.simulate import make_folder, simulate
from quintet.coupler.scene.overrides import run_arguments
from quintet.coupler.scene.scene import Scene


def run_folder(scene: Scene, out: Path | None) -> Path:
    """Return the folder of a run: as given, or ``runs/NAME``."""
    return (out or Path("runs") / scene.file.name).resolve()


def run_scene(scene: Scene, folder: Path, snapshot: Path | None = None) -> int:
    """Run a scene from its start or from a snapshot; return the exit status."""
    if snapshot is None:
        make_folder(scene, folder)
    if scene.transport == "mpi":
        target = ["--resume", str(folder)] if snapshot else ["--out", str(folder)]
        return run_under_mpi(["run", *run_arguments(**scene.asked), *target], scene, folder)
    return simulate(scene, folder, snapshot)
