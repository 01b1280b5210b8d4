"""One run of a sweep, or of all studies: found complete, resumed from its snapshot, or run.

It is done in whatever process or thread an executor chooses, on any host that sees the folder. All
that the sweep needs to know of it stands in the folder, so that it may be killed at any time.
"""

import contextlib
import re
import signal
from collections.abc import Callable
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from typing import Any

from filelock import FileLock, Timeout

from quintet.coupler.files.run_files import SCENE
from quintet.coupler.report.show import NAME, results
from quintet.coupler.run.folder import wait_until_free
from quintet.coupler.run.results import BAD
from quintet.coupler.run.snapshots import snapshots
from quintet.coupler.scene.read import parse
from quintet.coupler.study.child_run import ChildRun
from quintet.interfaces.errors import QuintetError, SceneError

JOURNAL = "sweep.log"  # one line for each start and each end of a run
LOCK = ".lock"  # after the name of a run's folder
ORPHAN = 60.0  # s for a run to end whose sweep was killed
ELSEWHERE = "elsewhere"  # status of a run that another sweep does now
KEPT = "kept"  # key of results that were there
# Sent from outside: by a user, a batch system, or a system without memory. Other signals that end
# a process come from errors in it.
OUTSIDE = {signal.SIGKILL, signal.SIGTERM, signal.SIGHUP, signal.SIGINT, signal.SIGQUIT}


def never() -> bool:
    """Whether to end a run early, where nobody can ask for it."""
    return False


@dataclass(frozen=True, slots=True)
class Job:
    """A run to be done; it can be sent to another process or host.

    Attributes
    ----------
    name : str
        Hash of the run, and name of its folder.
    place : Path
        Folder of the sweep.
    asked : tuple
        Scene, preset, settings, swaps and transport, as on the command line.
    settings : dict
        Those of this run, by dotted path.
    resolved : dict
        The scene as it runs.
    versions : dict
        Of the packages, as they stand in results.
    retry : int
        How often the run is repeated when its process is killed from outside.
    resumes : bool
        Whether a run that was cut goes on from its snapshot; else it begins again, as its times
        are wanted, which count from where it was resumed.
    """

    name: str
    place: Path
    asked: tuple[str, str, list[str], list[str], str]
    settings: dict[str, Any]
    resolved: dict[str, Any]
    versions: dict[str, str]
    retry: int = 1
    resumes: bool = True

    @property
    def folder(self) -> Path:
        """Folder of the run."""
        return self.place / self.name

    def complete(self) -> Any:
        """Results of the run if it is done, of this scene and these versions; else None."""
        if not (self.folder / NAME).is_file():
            return None
        try:
            run = results(self.folder)
            same = parse(self.folder / SCENE) == self.resolved
        except SceneError:  # changed, or cut: it is run again
            return None
        same = same and (run.get("machine") or {}).get("versions") == self.versions
        return run if same and run.get("status") == "done" else None

    def note(self, event: str) -> None:
        """Note what happens to the run; a line is written at once, as others may write too."""
        time = datetime.now().isoformat(timespec="milliseconds")
        with open(self.place / JOURNAL, "a", encoding="utf-8") as file:
            file.write(f"{time} {self.name} {event}\n")


def carry_out(job: Job, stop: Callable[[], bool] = never) -> Any:
    """Do one run, unless it is complete; return its results.

    The status of the results is that of the run, or `elsewhere` if another sweep does it now.
    """
    path = job.place / f"{job.name}{LOCK}"
    lock = FileLock(path, timeout=0)
    try:
        lock.acquire()
    except Timeout:
        return {"status": ELSEWHERE}
    try:
        run = job.complete()
        if run is not None:
            run[KEPT] = True
        else:
            run = _repeat(job, stop)
    except QuintetError as error:
        run = {"status": "failed", "fault": {"cause": str(error)}}
    else:
        if run["status"] == "done":  # whoever takes the lock now looks whether it is complete
            path.unlink(missing_ok=True)
    finally:
        lock.release()
    return run


def _repeat(job: Job, stop: Callable[[], bool]) -> Any:
    """Run until the end is not due to a signal from outside, or too often."""
    scene, preset, settings, swaps, transport = job.asked
    child = ChildRun(scene, preset, settings, swaps, transport, stop, force=True)
    run: Any = None
    for _ in range(1 + job.retry):
        run = _begin(job, child)
        job.note(run["status"])
        if stop() or not was_killed(run):
            break
    return run


def _begin(job: Job, child: ChildRun) -> Any:
    """Go on with the run from its last snapshot; without one, run it."""
    wait_until_free(job.folder, ORPHAN)
    if job.resumes and snapshots(job.folder):
        job.note("resumed")
        with contextlib.suppress(SceneError):
            run = child.resume(job.settings, job.folder)
            if run["exit"] != BAD:
                return run
    job.note("started")
    return child.run(job.settings, job.folder)


def was_killed(run: Any) -> bool:
    """Whether a signal from outside has ended the run, or a process of it, before it was done.

    A run that stalled was ended by the series itself.
    """
    if run["status"] in ("done", "stalled"):
        return False
    if run.get("exit", 0) < 0:
        return -run["exit"] in OUTSIDE
    cause = str((run.get("fault") or {}).get("cause", ""))
    killed = re.search(r"killed by signal (\d+)", cause)
    return run["status"] == "interrupted" or bool(killed and int(killed[1]) in OUTSIDE)
