"""Runs of a series, done by an executor, and a row of results of each.

Runs are done by an executor of Python's `concurrent.futures`, each as a process of its own. Nothing
is kept in memory that is not in the folder: started again, a series does what is not done.
"""

import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Executor, Future, ThreadPoolExecutor, wait
from functools import partial
from typing import Any

from quintet.coupler.run import results
from quintet.coupler.run.signals import StopRequest
from quintet.coupler.scene.study_table import Refinement
from quintet.coupler.scene.sweep_axes import label
from quintet.coupler.study.row import row_of
from quintet.coupler.study.sweep_progress import SweepProgress
from quintet.coupler.study.sweep_run import ELSEWHERE, KEPT, Job, carry_out
from quintet.interfaces.errors import SceneError

POLL = 0.2  # s between two looks for signals
AGAIN = 1.0  # s until a run that another series does is looked at again
WRITE = 20.0  # s between two writes of the table
Row = dict[str, Any]
Write = Callable[[Sequence[Row]], None]


def run_jobs(
    tasks: Sequence[Job],
    jobs: int,
    executor: Executor | None = None,
    write: Write = lambda rows: None,
    progress: SweepProgress | None = None,
) -> list[Row]:
    """Do all runs that are not complete; return a row of each, in the order of the tasks.

    Parameters
    ----------
    tasks : sequence of Job
    jobs : int
        Runs at once, on this host, without an executor.
    executor : Executor or None
        Does the runs; if not given, `jobs` threads of this process, each of which waits for the
        process of a run.
    write : callable
        Takes all rows every 20 s, so that a table can be looked at meanwhile.
    progress : SweepProgress or None
        That of a series of several calls; if not given, one is shown for this call.
    """
    stop, shown = StopRequest(), progress or SweepProgress(len(tasks))
    try:
        with stop.listening():
            if executor:
                return _collect(tasks, executor, carry_out, stop, write, shown)
            with ThreadPoolExecutor(jobs) as threads:
                do = partial(carry_out, stop=stop)
                return _collect(tasks, threads, do, stop, write, shown)
    finally:
        if progress is None:
            shown.close()


class RunSeries:
    """What a sweep, an ensemble and a calibration tell of their runs."""

    __slots__ = ()
    rows: list[Row]

    @property
    def ok(self) -> bool:
        """Whether all runs are done."""
        return self.status == results.DONE

    @property
    def status(self) -> int:
        """Exit status: 0 if all runs are done, 130 if it was interrupted, 3 if some failed."""
        return status_of(self.rows)

    @property
    def failed(self) -> list[Row]:
        """Runs that failed; statistics leave them out."""
        return failed_rows(self.rows)


def check_numbers(series: str, jobs: int, retry: int) -> None:
    """Refuse numbers of runs at once, and of repetitions, that mean nothing."""
    if jobs < 1 or retry < 0:
        raise SceneError(
            f"{series}: --jobs must be 1 or more, --retry 0 or more; found {jobs} and {retry}. "
            "Correct them."
        )


def status_of(rows: Sequence[Row]) -> int:
    """Exit status: 0 if all runs are done, 130 if the series was interrupted, 3 if some failed."""
    states = {row["status"] for row in rows}
    if states & {"interrupted", "not run"}:
        return results.INTERRUPTED
    return results.DONE if states <= {"done"} else results.FAILED


def failed_rows(rows: Sequence[Row]) -> list[Row]:
    """Runs that failed."""
    return [row for row in rows if row["status"] not in ("done", "not run", "interrupted")]


def _collect(
    tasks: Sequence[Job],
    executor: Executor,
    do: Callable[[Job], Any],
    stop: Callable[[], bool],
    write: Write,
    progress: SweepProgress,
) -> list[Row]:
    """Do all runs by an executor; gather a row of each, in the order of the tasks."""
    rows = {job.name: _row(job, {"status": "not run"}) for job in tasks}
    written = time.monotonic()
    for job, run in finished(tasks, executor, do, stop):
        rows[job.name].update(_row(job, run))
        progress.show(rows[job.name])
        if time.monotonic() - written > WRITE:
            write(list(rows.values()))
            written = time.monotonic()
    return list(rows.values())


def finished(
    tasks: Sequence[Job], executor: Executor, do: Callable[[Job], Any], stop: Callable[[], bool]
) -> Iterator[tuple[Job, Any]]:
    """Yield runs as they end; those that another series does are asked for again and again."""
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
