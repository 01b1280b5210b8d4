"""Command that hands a scene to a batch system: launch."""

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from quintet.coupler.cli.options import Command, add_scene, load_scene
from quintet.interfaces.errors import SceneError

if TYPE_CHECKING:
    from quintet.coupler.measures.advice import Load

OUT = "folder of the run, new or empty (default: runs/SCENE)"
OUTPUT = "file for the job script (default: SCENE.slurm)"
TIME = "limit of one job, as sbatch takes it: 02:00:00; a longer run goes on in further jobs"
MARGIN = "ask the run to end in a snapshot so long before the limit (default: 120)"
CORES = "cores of a node, where no more may be used (default: as many as are needed)"
MPI = "how ranks join each other, an --mpi of srun (default: pmi2, which mpich has)"
IMAGE = "Apptainer image in which all ranks run (default: this environment)"
MEASURED = "place by the computing times of this run, not by planned ones"
WAYS = (
    "launch writes a job script for a batch system: say which. SLURM: quintet launch SCENE --slurm "
    "--nodes 2 --time 02:00:00. Without one, quintet run SCENE starts all processes here, and "
    "quintet run SCENE --elsewhere NAME waits for a component of another host."
)


def add_commands(command: Command) -> None:
    """Add what hands a scene to a batch system."""
    job = command("launch", launch, "write a job script that runs a scene on a cluster")
    add_scene(job, nargs="?")
    job.add_argument("--slurm", action="store_true", help="for SLURM")
    job.add_argument("--nodes", type=_count, default=1, metavar="N", help="nodes (default: 1)")
    job.add_argument("--time", default="", metavar="LIMIT", help=TIME)
    job.add_argument("--margin", type=_count, default=120, metavar="SECONDS", help=MARGIN)
    job.add_argument("--cores", type=_count, metavar="N", help=CORES)
    for name in ("partition", "account", "job-name"):
        job.add_argument(f"--{name}", default="", metavar="NAME", help="of SLURM")
    job.add_argument("--mpi", default="pmi2", metavar="NAME", help=MPI)
    job.add_argument("--image", type=Path, metavar="FILE", help=IMAGE)
    job.add_argument("--measured", type=Path, metavar="DIR", help=MEASURED)
    job.add_argument("--out", type=Path, metavar="DIR", help=OUT)
    job.add_argument("-o", "--output", type=Path, metavar="FILE", help=OUTPUT)
    job.add_argument("--submit", action="store_true", help="submit the script at once, by sbatch")


def _count(text: str) -> int:
    value = int(text) if text.isdecimal() else 0
    if value < 1:
        raise argparse.ArgumentTypeError(f"must be a whole number from 1; found {text!r}")
    return value


def launch(options: argparse.Namespace) -> int:
    """Write a job script, and submit it if asked to."""
    if not options.slurm or options.scene is None:
        raise SceneError(WAYS)
    if not options.time:
        raise SceneError("launch needs the limit of a job. Give --time, as in --time 02:00:00.")
    if options.transport not in ("", "mpi"):
        raise SceneError(
            f"launch starts one MPI job: --transport must be mpi; found {options.transport}. "
            "Leave it out."
        )
    options.transport = "mpi"
    scene = load_scene(options)
    # Start-up: only this command needs it.
    from quintet.coupler.launch.slurm_job import Request, submit, write_job

    name = scene.file.name
    script = options.output or Path(f"{name}.slurm")
    names = ("partition", "account", "job-name")
    request = Request(
        options.nodes,
        options.time,
        options.margin,
        options.cores,
        options.mpi,
        options.image,
        {key: getattr(options, key.replace("-", "_")) for key in names},
    )
    measured = _measured(options.measured) if options.measured else {}
    nodes_of = write_job(scene, options.out or Path("runs") / name, script, request, measured)
    for program, nodes in nodes_of.items():
        print(f"{program}: node {', '.join(str(node + 1) for node in nodes)}")
    print(f"written: {script}; sbatch {script} begins, sbatch {script} --resume goes on")
    if options.submit:
        print(submit(script))
    return 0


def _measured(folder: Path) -> dict[str, "Load"]:
    """Computing times in a former run."""
    # Start-up: only this option needs it.
    from quintet.coupler.measures.advice import loads_of
    from quintet.coupler.report.show import results

    advice = results(folder).get("advice")
    if not advice:
        raise SceneError(f"--measured {folder}: the run has no computing times. Name another.")
    return loads_of(advice)
