"""``quintet sweep SCENE --over KEY=1,2,3``: a run for each combination of values.

Runs are done by an executor of Python's `concurrent.futures`, each as a process of its own. Nothing
is kept in memory that is not in the folder: started again, a sweep does what is not done.
"""

import argparse
import contextlib
import json
import shlex
import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Executor, Future, ThreadPoolExecutor, wait
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import Any

from quintet.coupler.files.disk import write_whole
from quintet.coupler.files.json_file import JsonFile
from quintet.coupler.launch.processes import PYTHON
from quintet.coupler.report.show import console
from quintet.coupler.report.sweep_report import draw, table, write_csv
from quintet.coupler.run import results
from quintet.coupler.run.folder import share
from quintet.coupler.run.signals import StopRequest
from quintet.coupler.scene.overrides import run_arguments
from quintet.coupler.scene.study_table import Refinement
from quintet.coupler.scene.sweep_axes import Axis, label, read_axes
from quintet.coupler.study.row import row_of
from quintet.coupler.study.sweep_plan import Asked, plan
from quintet.coupler.study.sweep_progress import SweepProgress
from quintet.coupler.study.sweep_run import ELSEWHERE, JOURNAL, KEPT, Job, carry_out
from quintet.interfaces.errors import SceneError

NAME, TABLE, PICTURE = "sweep.json", "sweep.csv", "sweep.png"
JOBS = {"local": 2, "slurm": 64}  # runs at once, by engine
POLL = 0.2  # s between two looks for signals
AGAIN = 1.0  # s until a run that another sweep does is looked at again
WRITE = 20.0  # s between two writes of the table
Row = dict[str, Any]


@dataclass(slots=True)
class Sweep:
    """A sweep: its runs, and what is known of them.

    Attributes
    ----------
    scene : str
        Name of the scene.
    folder : Path
        With a folder for each run.
    axes : list of Axis
        Keys that are varied, and their values.
    rows : list of dict
        One for each run: `run` (its hash and folder), `settings`, `status`, `met`, `values` and
        `units` of its expectations, `cause` of a failure, `wall` and `cpu` [s], `kept`.
    """

    scene: str
    folder: Path
    axes: list[Axis]
    rows: list[Row] = field(default_factory=list)

    @property
    def ok(self) -> bool:
        """Whether all runs are done."""
        return all(row["status"] == "done" for row in self.rows)

    @property
    def status(self) -> int:
        """Exit status: 0 if all runs are done, 130 if it was interrupted, 3 if some failed."""
        states = {row["status"] for row in self.rows}
        if states & {"interrupted", "not run"}:
            return results.INTERRUPTED
        return results.DONE if self.ok else results.FAILED

    @property
    def failed(self) -> list[Row]:
        """Runs that failed."""
        return [row for row in self.rows if row["status"] not in ("done", "not run", "interrupted")]

    def write(self) -> None:
        """Write the table."""
        write_csv(self.axes, self.rows, self.folder / TABLE)

    def summary(self) -> Row:
        """All of it, for programs."""
        keys = {axis.path: list(axis.values) for axis in self.axes}
        content = {"scene": self.scene, "over": keys, "rows": self.rows}
        return {**content, "machine": results.machine()}


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

        _check_counts(jobs, 0)
        return SlurmExecutor(jobs, options)
    if options:
        raise SceneError(
            f"sweep: --sbatch is for --engine slurm; found {shlex.join(options)} without. Add "
            "--engine slurm, or remove it."
        )
    return contextlib.nullcontext()


def _write_rules(options: argparse.Namespace, asked: Asked, axes: Sequence[Axis]) -> int:
    """Write the sweep as a Snakefile; run nothing."""
    # Only sweeps that others run need it.
    from quintet.coupler.study import snakefile

    snakefile.check_place(options.snakefile)
    scene, planned = plan(asked, axes, 1, options.retry)
    folder = share("sweep", scene, (NAME, TABLE, PICTURE, JOURNAL), options.out)
    jobs = [replace(job, place=folder) for job in planned]
    words = [*run_arguments(*asked), *(w for text in options.over for w in ("--over", text))]
    command = [*PYTHON, "-m", "quintet.coupler.cli", "sweep", *words, "--out", str(folder)]
    snakefile.write_snakefile(options.snakefile, scene, jobs, command, TABLE)
    print(f"written: {options.snakefile}, {len(jobs)} runs into {folder}")
    return 0


def _check_counts(jobs: int, retry: int) -> None:
    if jobs < 1 or retry < 0:
        raise SceneError(
            f"sweep: --jobs must be 1 or more, --retry 0 or more; found {jobs} and {retry}. "
            "Correct them."
        )


def sweep(
    asked: Asked,
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
    _check_counts(jobs, retry)
    scene, planned = plan(asked, axes, jobs, retry)
    folder = share("sweep", scene, (NAME, TABLE, PICTURE, JOURNAL), out)
    swept = Sweep(scene, folder, list(axes))
    stop = StopRequest()
    tasks = [replace(job, place=folder) for job in planned]
    print(f"{scene}: {len(tasks)} runs, {jobs} at once, in {folder}", flush=True)
    with stop.listening():
        if executor:
            _collect(swept, tasks, executor, carry_out, stop)
        else:
            with ThreadPoolExecutor(jobs) as threads:
                _collect(swept, tasks, threads, partial(carry_out, stop=stop), stop)
    swept.write()
    write_whole(folder / NAME, json.dumps(swept.summary(), indent=2))
    draw(swept.axes, swept.rows, folder / PICTURE, scene)
    return swept


def _collect(
    swept: Sweep,
    tasks: Sequence[Job],
    executor: Executor,
    do: Callable[[Job], Any],
    stop: Callable[[], bool],
) -> None:
    """Do all runs by an executor; gather a row of each, in the order of the product."""
    rows = {job.name: _row(job, {"status": "not run"}) for job in tasks}
    swept.rows = list(rows.values())
    progress, written = SweepProgress(len(tasks)), time.monotonic()
    try:
        for job, run in finished(tasks, executor, do, stop):
            rows[job.name].update(_row(job, run))
            progress.show(rows[job.name])
            if time.monotonic() - written > WRITE:
                swept.write()
                written = time.monotonic()
    finally:
        progress.close()


def finished(
    tasks: Sequence[Job], executor: Executor, do: Callable[[Job], Any], stop: Callable[[], bool]
) -> Iterator[tuple[Job, Any]]:
    """Yield runs as they end; those that another sweep does are asked for again and again."""
    futures: dict[Future[Any], Job] = {}
    waiting: list[Job] = []
    for job in tasks:
        run = job.complete()
        if run is None:
            futures[executor.submit(do, job)] = job
        else:
            yield job, {**run, KEPT: True}
    again = time.monotonic() + AGAIN
    while futures or waiting:
        ended = wait(futures, POLL, FIRST_COMPLETED).done if futures else set()
        for future in ended:
            job, run = futures.pop(future), _result(future)
            if run["status"] != ELSEWHERE:
                yield job, run
            elif not stop():
                waiting.append(job)
        if stop():
            for future in [future for future in futures if future.cancel()]:
                del futures[future]
            waiting.clear()
        elif not futures and waiting and time.monotonic() < again:
            time.sleep(POLL)
        elif waiting and time.monotonic() > again:
            futures |= {executor.submit(do, job): job for job in waiting}
            waiting, again = [], time.monotonic() + AGAIN


def _result(future: "Future[Any]") -> Any:
    """Results of a run; of status failed where the executor has lost it."""
    try:
        return future.result()
    except Exception as error:  # an executor may raise anything
        return {"status": "failed", "fault": {"cause": f"{type(error).__name__}: {error}"}}


def _row(job: Job, run: Any) -> Row:
    """Summarize a run; times in s, memory in bytes."""
    row = row_of(Refinement(label(job.settings), job.settings), run)
    cause = (run.get("fault") or {}).get("cause", "")
    return {"run": job.name, **row, "cause": str(cause), "kept": bool(run.get(KEPT))}
