"""A run of a sweep as a file, and as a command that does it on any host that sees the folder.

``python -m quintet.coupler.study.job_file FOLDER HASH`` is what a batch system or a workflow runs.
Nothing is pickled: what has to be done, and how it ended, are JSON files in ``jobs`` of the folder.
"""

import json
import os
import sys
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from quintet.coupler.files.disk import reporting_disk, write_whole
from quintet.coupler.launch.processes import PYTHON
from quintet.coupler.run import results
from quintet.coupler.run.signals import StopRequest
from quintet.coupler.study.sweep_run import Job, carry_out
from quintet.interfaces.errors import QuintetError, SceneError

FOLDER = "jobs"  # in the folder of a sweep
BATCH_JOB = "SLURM_JOB_ID"  # in the environment of a job
MODULE = "quintet.coupler.study.job_file"
STATES = {"done": results.DONE, "interrupted": results.INTERRUPTED}  # exit status


@dataclass(frozen=True, slots=True)
class JobFiles:
    """Files of a run in the folder of its sweep."""

    place: Path
    name: str

    @property
    def request(self) -> Path:
        """What is to be run."""
        return self.place / FOLDER / f"{self.name}.json"

    @property
    def end(self) -> Path:
        """How it ended."""
        return self.place / FOLDER / f"{self.name}.end.json"

    @property
    def output(self) -> Path:
        """What the batch system keeps of its output."""
        return self.place / FOLDER / f"{self.name}.out"

    def command(self) -> list[str]:
        """What does the run."""
        return [*PYTHON, "-m", MODULE, str(self.place), self.name]


def write_request(job: Job) -> JobFiles:
    """Write what is to be run, and where the scene's path begins."""
    files = JobFiles(job.place, job.name)
    with reporting_disk(files.request):
        files.request.parent.mkdir(exist_ok=True)
    table = {**asdict(job), "place": str(job.place), "began_in": os.getcwd()}
    write_whole(files.request, json.dumps(table, indent=2, default=str))
    return files


def read_request(files: JobFiles) -> tuple[Job, Path]:
    """Read what is to be run, and the folder from which the scene's path begins."""
    try:
        table = json.loads(files.request.read_text(encoding="utf-8"))
        began_in = Path(table.pop("began_in"))
        asked = tuple(table.pop("asked"))
        return Job(**{**table, "place": files.place, "asked": asked}), began_in
    except (OSError, ValueError, KeyError, TypeError, AttributeError) as error:
        raise SceneError(
            f"{files.request}: it must be a run of a sweep; it cannot be read ({error}). Give the "
            "sweep's command again."
        ) from error


def read_end(files: JobFiles, batch_job: str) -> Any:
    """How a run ended in a job of the batch system; None where it has not yet."""
    try:
        end = json.loads(files.end.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None
    return end["run"] if end.get("batch_job") == batch_job else None


def cores_of(resolved: Mapping[str, Any]) -> int:
    """Cores that a run uses at once, all on one node: over memory components take turns."""
    components = resolved["components"].values()
    cores = [table.get("threads", 1) * table.get("ranks", 1) for table in components]
    return max(cores) if resolved.get("transport") == "memory" else sum(cores)


def main(arguments: list[str]) -> int:
    """Do one run; write how it ended; return the exit status."""
    try:
        if len(arguments) != 2:
            raise SceneError(
                f"a run of a sweep needs FOLDER and HASH; found {len(arguments)} arguments. Give "
                "both."
            )
        files = JobFiles(Path(arguments[0]).resolve(), arguments[1])
        job, began_in = read_request(files)
        os.chdir(began_in)
        stop = StopRequest()
        with stop.listening():
            run = carry_out(job, stop)
        end = {"batch_job": os.environ.get(BATCH_JOB, ""), "run": run}
        write_whole(files.end, json.dumps(end))
    except (QuintetError, OSError) as error:
        print(f"quintet: {error}", file=sys.stderr)
        return results.BAD
    cause = (run.get("fault") or {}).get("cause", "")
    print(f"{files.name}: {run['status']} {cause}".rstrip(), flush=True)
    return STATES.get(run["status"], results.FAILED)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
