"""``quintet sweep SCENE --over KEY=1,2,3``: a run for each combination of values."""

import argparse
import contextlib
import json
import shlex
from collections.abc import Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, field, replace
from pathlib import Path

from quintet.coupler.files.disk import write_whole
from quintet.coupler.files.json_file import JsonFile
from quintet.coupler.files.run_files import REPORT
from quintet.coupler.launch.processes import PYTHON
from quintet.coupler.report.show import console
from quintet.coupler.report.sweep_report import draw, table, write_csv
from quintet.coupler.run import results
from quintet.coupler.run.folder import share
from quintet.coupler.scene.overrides import command_line, run_arguments
from quintet.coupler.scene.sweep_axes import Axis, combinations, read_axes
from quintet.coupler.study.run_jobs import Row, RunSeries, check_numbers, run_jobs
from quintet.coupler.study.sweep_plan import SceneRequest, axes_of_jobs, plan
from quintet.coupler.study.sweep_run import JOURNAL
from quintet.interfaces.errors import SceneError

NAME, TABLE, PICTURE = "sweep.json", "sweep.csv", "sweep.png"
JOBS = {"local": 2, "slurm": 64}  # runs at once, by engine


@dataclass(slots=True)
class Sweep(RunSeries):
    """A sweep: its runs, and what is known of them.

    Attributes
    ----------
    scene : str
        Name of the scene.
    folder : Path
        With a folder for each run.
    command : str
        Repeats it.
    axes : list of Axis
        Keys that are varied, and their values.
    rows : list of dict
        One for each run: `run` (its hash and folder), `settings`, `status`, `met`, `values` and
        `units` of its expectations, `cause` of a failure, `wall` and `cpu` [s], `kept`.
    """

    scene: str
    folder: Path
    command: str
    axes: list[Axis]
    rows: list[Row] = field(default_factory=list)

    def summary(self) -> Row:
        """All of it, for programs."""
        keys = {axis.path: list(axis.values) for axis in self.axes}
        units = {axis.path: axis.unit for axis in self.axes if axis.unit}
        content = {"scene": self.scene, "over": keys, "units": units, "rows": self.rows}
        return {**content, "machine": results.machine(), "command": self.command}


def run_sweep(options: argparse.Namespace) -> int:
    """Run a sweep from the command line; return the exit status."""
    asked = (options.scene, options.preset, options.settings, options.swap, options.transport)
    wanted = JsonFile(options.json, ("scene", "rows"))
    axes = read_axes(options.over)
    if options.snakefile:
        return _write_rules(options, asked, axes)
    jobs = JOBS[options.engine] if options.jobs is None else options.jobs
    with _engine(options.engine, jobs, options.sbatch) as executor:
        swept = sweep(asked, axes, options.out, jobs, options.retry, executor)
    wanted.write(swept.summary())
    screen = console()
    screen.print(table(swept.axes, swept.rows))
    for row in swept.failed:
        screen.print(f"{row['status']}: {row['label']}: {row['cause']}", markup=False)
    for name in (TABLE, PICTURE):
        if (swept.folder / name).is_file():
            screen.print(f"left {swept.folder / name}")
    if swept.failed:
        screen.print(f"{len(swept.failed)} runs failed: the same command tries them again")
    return swept.status


def _engine(
    name: str, jobs: int, options: Sequence[str]
) -> contextlib.AbstractContextManager[Executor | None]:
    """What does the runs: a batch system, or, for None, this host."""
    if name == "slurm":
        # Only sweeps on a cluster need it.
        from quintet.coupler.study.slurm_executor import SlurmExecutor

        check_numbers("sweep", jobs, 0)
        return SlurmExecutor(jobs, options)
    if options:
        raise SceneError(
            f"sweep: --sbatch is for --engine slurm; found {shlex.join(options)} without. Add "
            "--engine slurm, or remove it."
        )
    return contextlib.nullcontext()


def _write_rules(options: argparse.Namespace, asked: SceneRequest, axes: Sequence[Axis]) -> int:
    """Write the sweep as a Snakefile; run nothing."""
    # Only sweeps that others run need it.
    from quintet.coupler.study import snakefile

    snakefile.check_place(options.snakefile)
    scene, planned = plan("sweep", asked, combinations(axes), 1, options.retry)
    folder = share("sweep", scene, (NAME, TABLE, PICTURE, JOURNAL, REPORT), options.out)
    jobs = [replace(job, place=folder) for job in planned]
    words = [*run_arguments(*asked), *(w for text in options.over for w in ("--over", text))]
    command = [*PYTHON, "-m", "quintet.coupler.cli", "sweep", *words, "--out", str(folder)]
    snakefile.write_snakefile(options.snakefile, scene, jobs, command, TABLE)
    print(f"written: {options.snakefile}, {len(jobs)} runs into {folder}")
    return 0


def sweep(
    asked: SceneRequest,
    axes: Sequence[Axis],
    out: Path | None,
    jobs: int,
    retry: int,
    executor: Executor | None = None,
) -> Sweep:
    """Check all runs of a sweep, do those that are not complete, and write table and picture.

    Parameters
    ----------
    asked : tuple
        Scene, preset, settings, swaps and transport, as on the command line.
    axes : sequence of Axis
    out : path or None
        Folder of the sweep, new, empty, or of a former sweep.
    jobs : int
        Runs at once, on this host.
    retry : int
        How often a run is repeated that was killed from outside.
    executor : Executor or None
        Does the runs; if not given, `jobs` threads of this process, each of which waits for the
        process of a run.
    """
    check_numbers("sweep", jobs, retry)
    scene, planned = plan("sweep", asked, combinations(axes), jobs, retry)
    folder = share("sweep", scene, (NAME, TABLE, PICTURE, JOURNAL, REPORT), out)
    words = [word for axis in axes for word in ("--over", axis.text)]
    command = command_line("sweep", *asked, words=words)
    swept = Sweep(scene, folder, command, axes_of_jobs(axes, planned))
    tasks = [replace(job, place=folder) for job in planned]
    print(f"{scene}: {len(tasks)} runs, {jobs} at once, in {folder}", flush=True)

    def write(rows: Sequence[Row]) -> None:
        write_csv(swept.axes, rows, folder / TABLE)

    swept.rows = run_jobs(tasks, jobs, executor, write)
    write(swept.rows)
    write_whole(folder / NAME, json.dumps(swept.summary(), indent=2))
    draw(swept.axes, swept.rows, folder / PICTURE, scene)
    return swept
