"""``quintet launch``: a scene as a job of SLURM, written and submitted."""

import re
import subprocess
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from quintet.coupler.files.disk import write_whole
from quintet.coupler.launch.placement import Program, place
from quintet.coupler.launch.processes import PYTHON
from quintet.coupler.launch.slurm_script import COUPLER, MARK, Job, Rank, job_script
from quintet.coupler.measures.advice import Load
from quintet.coupler.scene.overrides import run_arguments
from quintet.coupler.scene.planned_times import planned_load
from quintet.coupler.scene.read import library
from quintet.coupler.scene.scene import Scene
from quintet.interfaces.errors import SceneError

# As sbatch takes it: days-hours[:minutes[:seconds]], or [[hours:]minutes:]seconds, or minutes.
TIME = re.compile(r"(?:(\d+)-(\d+)(?::(\d+))?(?::(\d+))?|(?:(?:(\d+):)?(\d+):)?(\d+))")
# Compiled kernels lie beside the sources: numba reads them only where it could write others.
IN_IMAGE = ("apptainer", "exec", "--writable-tmpfs")


@dataclass(frozen=True, slots=True)
class Request:
    """What a user asks of SLURM.

    Parameters
    ----------
    nodes : int
    time : str
        Limit of a job, as sbatch takes it.
    margin : int, s
        How long before the limit the run is asked to end.
    cores : int or None
        Of a node; None: as many as are needed.
    mpi : str
        An ``--mpi`` of srun.
    image : Path or None
        Apptainer image in which all ranks run.
    options : mapping
        Further options of sbatch; empty ones are left out.
    """

    nodes: int
    time: str
    margin: int
    cores: int | None
    mpi: str
    image: Path | None
    options: Mapping[str, str]


def write_job(
    scene: Scene, out: Path, script: Path, request: Request, measured: Mapping[str, Load]
) -> dict[str, list[int]]:
    """Write the job script of a scene; return the nodes of the ranks of every program.

    Parameters
    ----------
    scene : Scene
        Over mpi.
    out : Path
        Folder of the run: new or empty.
    script : Path
        Job script; only a former one is replaced.
    request : Request
    measured : mapping of Load
        Computing times of components in a former run; of others those are taken that are planned.

    Raises
    ------
    SceneError
        What is asked for cannot be.
    """
    _check(out, script, request)
    components = [_rank(scene, name, measured) for name in scene.components]
    programs = [Program(COUPLER), *(component.program for component in components)]
    nodes_of = place(programs, request.nodes, request.cores)
    job = Job(
        script.resolve(),
        request.time,
        request.margin,
        _options(request, scene, script.resolve()),
        request.mpi,
        _python(request),
    )
    text = job_script(job, out.resolve(), _arguments(scene), components, nodes_of)
    write_whole(script, text)
    return nodes_of


def submit(script: Path) -> str:
    """Hand a job script to SLURM; return what sbatch says."""
    try:
        done = subprocess.run(["sbatch", str(script)], capture_output=True, text=True)
    except FileNotFoundError as error:
        raise SceneError(
            "--submit needs sbatch; there is none on PATH. Submit the script where SLURM is."
        ) from error
    if done.returncode:
        raise SceneError(f"--submit: sbatch refuses {script}: {done.stderr.strip()}")
    return done.stdout.strip()


def limit_of(time: str) -> int:
    """Time limit in seconds, of a text as sbatch takes it."""
    match = TIME.fullmatch(time)
    if not match:
        raise SceneError(
            f"--time must be as sbatch takes it, as in 02:00:00 or 1-12:00:00; found {time!r}."
        )
    days, hours, minutes, seconds, clock_hours, clock_minutes, last = (
        int(part or 0) for part in match.groups()
    )
    if match[1]:
        return ((days * 24 + hours) * 60 + minutes) * 60 + seconds
    if match[6]:
        return (clock_hours * 60 + clock_minutes) * 60 + last
    return 60 * last


def _check(out: Path, script: Path, request: Request) -> None:
    if request.margin >= limit_of(request.time):
        raise SceneError(
            f"--margin must be shorter than --time, {limit_of(request.time)} s; found "
            f"{request.margin} s."
        )
    if out.exists() and (not out.is_dir() or any(out.iterdir())):
        raise SceneError(f"--out {out}: it must be a new or an empty folder. Name another.")
    if script.exists() and MARK not in script.read_text(errors="replace")[:1000]:
        raise SceneError(
            f"--output {script}: it is there already and no job script. Name another file."
        )


def _rank(scene: Scene, name: str, measured: Mapping[str, Load]) -> Rank:
    plan = scene.components[name]
    load = measured.get(name) or planned_load(plan, scene.file)
    arguments = [plan.kind, *(w for place in scene.import_folders for w in ("--look-in", place))]
    if plan.ranks > 1:
        arguments += ["--ranks", str(plan.ranks), "--first", str(scene.first_rank(name))]
    seconds = load.on(plan.ranks * plan.threads)
    return Rank(Program(name, plan.threads, plan.ranks, seconds), arguments)


def _options(request: Request, scene: Scene, script: Path) -> Sequence[str]:
    output = f"{script.with_suffix('')}-%j.out"
    asked = {key: value for key, value in request.options.items() if value}
    options = {"job-name": scene.file.name, "output": output, **asked}
    return [f"--{key}={value}" for key, value in options.items()]


def _python(request: Request) -> Sequence[str]:
    return [*IN_IMAGE, str(request.image.resolve()), "python", "-P"] if request.image else PYTHON


def _arguments(scene: Scene) -> list[str]:
    """Arguments of run, but for the transport; a scene file by its whole path."""
    name = scene.path.parent.name
    known = library().get(name) == scene.path
    place = name if known else str(scene.path.resolve())
    return run_arguments(**{**scene.asked, "scene": place, "transport": ""})
