"""An executor whose runs are jobs of SLURM.

Each run of a sweep is a batch job of its own, on one node. A sweep that is killed leaves its jobs;
started again, it finds them in the queue by their names and waits for them.
"""

import hashlib
import os
import shlex
import shutil
import subprocess
import threading
import time
from collections.abc import Callable, Sequence
from concurrent.futures import Executor, Future
from dataclasses import dataclass
from typing import Any

from quintet.coupler.study.job_file import JobFiles, cores_of, read_end, write_request
from quintet.coupler.study.sweep_run import Job, carry_out
from quintet.interfaces.errors import QuintetError, SceneError

Queue = dict[str, tuple[str, str]]  # state and name of a job, by its number
PROGRAMS = ("sbatch", "squeue", "scancel")
POLL = 1.0  # s between two looks at the queue
LATE = 15.0  # s until a file of another host is seen here
MARGIN = 60  # s before the limit of a job in which its run is asked to end, with a snapshot
ANSWER = 30.0  # s within which a program of SLURM must answer
OUTAGE = 600.0  # s without an answer of SLURM until runs count as lost
SCRIPT = """#!/bin/bash
# A run of quintet sweep. All its processes are on this node.
export HYDRA_LAUNCHER=fork
exec {command}
"""


class SlurmRun(Future[Any]):
    """A run that waits, is in the queue, or has ended."""

    def __init__(self, job: Job) -> None:
        super().__init__()
        self.job = job
        self.unwanted = False  # whether it is to be ended early

    def cancel(self) -> bool:
        """Withdraw it; one in the queue is ended, with a snapshot, and still gives its results."""
        self.unwanted = True
        return super().cancel()


@dataclass(slots=True)
class Queued:
    """A job of SLURM."""

    number: str
    files: JobFiles
    run: SlurmRun
    attempts: int = 1
    gone: float = 0.0  # s of the clock since which it is not in the queue
    told: bool = False  # whether it was asked to end


class SlurmExecutor(Executor):
    """Does runs of a sweep as jobs of SLURM.

    Parameters
    ----------
    jobs : int
        In the queue at once.
    options : sequence of str
        Further options of sbatch, as ``--partition=short``.
    """

    def __init__(self, jobs: int, options: Sequence[str] = ()) -> None:
        if lacking := [name for name in PROGRAMS if shutil.which(name) is None]:
            raise SceneError(
                f"--engine slurm needs the programs of SLURM; {', '.join(lacking)} not found. Run "
                "it on a host that submits jobs, or leave --engine out."
            )
        reply = _ask_for_queue()
        if reply.returncode:
            raise SceneError(
                f"--engine slurm: squeue failed: {reply.stderr.strip()}. Check that the controller "
                "of SLURM runs and is reached from here, or leave --engine out."
            )
        self._jobs, self._options = jobs, options
        self._waiting: list[tuple[SlurmRun, int]] = []  # with how often they were begun
        self._queued: list[Queued] = []
        self._lock, self._news = threading.Lock(), threading.Event()
        self._closing = False
        self._heard = time.monotonic()  # s of the clock, when SLURM answered last
        self._thread = threading.Thread(target=self._watch, name="slurm", daemon=True)
        self._thread.start()

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> SlurmRun:
        """See `Executor.submit`; it does runs of sweeps alone."""
        if fn is not carry_out or len(args) != 1 or kwargs:
            raise TypeError("jobs of SLURM carry out runs of sweeps, nothing else")
        run = SlurmRun(args[0])
        with self._lock:
            self._waiting.append((run, 0))
        self._news.set()
        return run

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """See `Executor.shutdown`."""
        if cancel_futures:
            for run in [*(run for run, _ in self._waiting), *(q.run for q in self._queued)]:
                run.cancel()
        self._closing = True
        self._news.set()
        if wait:
            self._thread.join()

    def _watch(self) -> None:
        """Submit, ask for the queue, and give out results, until all is done."""
        while not (self._closing and not self._waiting and not self._queued):
            self._news.wait(POLL if self._queued or self._waiting else None)
            self._news.clear()
            try:
                queue = self._queue()
                self._conclude(queue)
                self._submit(queue)
            except BaseException as error:  # nobody else would hear of it
                self._fail(error)

    def _queue(self) -> Queue | None:
        """Jobs of this user; None where SLURM does not answer."""
        reply = _ask_for_queue()
        if reply.returncode == 0:
            self._heard = time.monotonic()
            jobs = [line.split(maxsplit=2) for line in reply.stdout.splitlines()]
            return {number: (state, name) for number, state, name in jobs}
        if time.monotonic() - self._heard > OUTAGE:
            raise QuintetError(f"SLURM did not answer for {OUTAGE:.0f} s: {reply.stderr.strip()}")
        return None

    def _conclude(self, queue: Queue | None) -> None:
        """Give out the results of jobs that have ended; end those that nobody wants any more."""
        now = time.monotonic()
        for job in list(self._queued):
            end = read_end(job.files, job.number)
            if end is not None:
                self._queued.remove(job)
                if end["status"] == "interrupted" and self._may_go_on(job):  # by its limit of time
                    self._waiting.append((job.run, job.attempts))
                else:
                    job.run.set_result(end)
            elif queue is not None and job.number not in queue:
                job.gone = job.gone or now
                if now - job.gone > LATE or job.run.unwanted:
                    self._queued.remove(job)
                    self._lost(job)
            elif queue is not None and job.run.unwanted and not job.told:
                # To its first process alone: a run that gets two signals ends without a snapshot.
                runs = queue[job.number][0] == "RUNNING"
                _call("scancel", *(["--batch", "--signal=TERM"] if runs else []), job.number)
                job.told = True

    @staticmethod
    def _may_go_on(job: Queued) -> bool:
        """Whether a run is begun in another job."""
        return job.attempts <= job.run.job.retry and not job.run.unwanted

    def _lost(self, job: Queued) -> None:
        """Repeat a run whose job ended without a word, unless too often."""
        if self._may_go_on(job):
            job.run.job.note("lost")
            self._waiting.append((job.run, job.attempts))
            return
        cause = (
            f"job {job.number} of SLURM ended without results: it was cancelled, came to a limit, "
            f"or its node failed. See {job.files.output}."
        )
        state = "interrupted" if job.run.unwanted else "failed"
        job.run.set_result({"status": state, "fault": {"cause": cause}})

    def _submit(self, queue: Queue | None) -> None:
        """Bring as many runs into the queue as may be there; find those that are."""
        numbers = {name: number for number, (_, name) in (queue or {}).items()}
        while queue is not None and len(self._queued) < self._jobs:
            with self._lock:
                if not self._waiting:
                    return
                run, attempts = self._waiting.pop(0)
            if not attempts and not run.set_running_or_notify_cancel():
                continue
            try:
                files = JobFiles(run.job.place, run.job.name)
                number = numbers.get(job_name(files), "")  # of a sweep that was killed
                if not number or read_end(files, number) is not None:
                    number = self._begin(run.job)
            except (QuintetError, OSError) as error:
                run.set_exception(error)
            else:
                self._queued.append(Queued(number, files, run, attempts + 1))

    def _begin(self, job: Job) -> str:
        """Submit a job; return its number."""
        files = write_request(job)
        files.end.unlink(missing_ok=True)
        options = [f"--job-name={job_name(files)}", f"--output={files.output}"]
        options += ["--open-mode=append", "--nodes=1", "--ntasks=1", f"--signal=B:TERM@{MARGIN}"]
        options += [f"--cpus-per-task={cores_of(job.resolved)}", *self._options]
        script = SCRIPT.format(command=shlex.join(files.command()))
        reply = _call("sbatch", "--parsable", *options, script=script)
        if reply.returncode:
            raise QuintetError(f"sbatch refused the run: {reply.stderr.strip()}")
        return reply.stdout.strip().partition(";")[0]

    def _fail(self, error: BaseException) -> None:
        """Give an error to all who wait."""
        with self._lock:
            waiting, self._waiting = self._waiting, []
        queued, self._queued = self._queued, []
        for run in [*(run for run, _ in waiting), *(job.run for job in queued)]:
            if not run.done():
                run.set_exception(error)


def job_name(files: JobFiles) -> str:
    """Name of a run's job: the same for the same run in the same folder."""
    place = hashlib.blake2b(str(files.place).encode(), digest_size=4).hexdigest()
    return f"quintet-{place}-{files.name}"


def _ask_for_queue() -> "subprocess.CompletedProcess[str]":
    """Ask for number, state and name of this user's jobs."""
    return _call("squeue", "--noheader", f"--user={os.getuid()}", "--format=%i %T %j")


def _call(*command: str, script: str = "") -> "subprocess.CompletedProcess[str]":
    """Run a program of SLURM; one that does not answer counts as failed."""
    try:
        return subprocess.run(command, input=script, capture_output=True, text=True, timeout=ANSWER)
    except subprocess.TimeoutExpired:
        cause = f"no answer within {ANSWER:.0f} s"
        return subprocess.CompletedProcess(command, 1, "", cause)
