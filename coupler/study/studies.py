"""``quintet study --all``: the quick refinements of all scenes, and the table of what they gave.

A run is named by its hash, as in a sweep; nothing is kept in memory that is not in the folder. The
runs are done one after the other, so that they do not share processors.
"""

import argparse
import json
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

from quintet.coupler.files.disk import write_whole
from quintet.coupler.files.json_file import JsonFile
from quintet.coupler.report import marked_place
from quintet.coupler.report.studies_table import table_of
from quintet.coupler.run import results
from quintet.coupler.run.folder import share
from quintet.coupler.run.signals import StopRequest
from quintet.coupler.scene.read import library
from quintet.coupler.study.row import row_of
from quintet.coupler.study.run_jobs import finished
from quintet.coupler.study.scene_or_all import refuse_with_all
from quintet.coupler.study.studies_plan import Planned, plan_all, read_studies, within_budget
from quintet.coupler.study.study import date_of, summarize
from quintet.coupler.study.sweep_run import JOURNAL, Job, carry_out
from quintet.interfaces.errors import SceneError

NAME = "studies.json"
NOT_RUN = "not run"
LEFT_OUT = ("within", "scales", "units", "overhead", "items")  # of rows: as in the scene
PARTS = ("compute", "cpu", "memory")  # costs of a component that are kept
DIGITS = 9  # significant, of numbers
# Options of the study of one scene.
OF_ONE_STUDY = ("transport", "error", "run", "keep", "force", "beside")
MINUTES = 60.0  # for all runs, if not given
Row = dict[str, Any]


def run_all(options: argparse.Namespace) -> int:
    """Run what is quick and not complete, as far as the time goes; return the exit status."""
    _refuse_single(options)
    wanted = JsonFile(options.json, ("scene", "rows"), kind=list)
    if options.readme:
        marked_place.STUDIES.check(options.readme)
    before = read_studies(options.json)
    folder = share("studies", "all", (NAME, JOURNAL), options.out)
    minutes = MINUTES if options.minutes is None else options.minutes
    planned = plan_all(folder, library())
    tasks = list(within_budget(planned, 60.0 * minutes))
    print(*estimate_words(planned, tasks, minutes, folder), sep="\n", flush=True)
    stop = StopRequest()
    with stop.listening():
        _run(tasks, 60.0 * minutes, stop)
    studies = collect(planned, before)
    write_whole(folder / NAME, json.dumps(studies, indent=2))
    wanted.write(studies)
    if options.readme:
        marked_place.STUDIES.put(options.readme, table_of(studies))
    return _status(planned, stop())


def _refuse_single(options: argparse.Namespace) -> None:
    """Refuse what belongs to one scene where all are run."""
    refuse_with_all("study", options, *OF_ONE_STUDY)
    if options.minutes is not None and not 0.0 <= options.minutes < float("inf"):
        raise SceneError(f"--minutes must be 0 or more; found {options.minutes:g}. Correct it.")


def estimate_words(
    planned: list[Planned], tasks: list[Planned], minutes: float, folder: Path
) -> list[str]:
    """Say what will be run, and for how long."""
    quick = [entry for entry in planned if entry.is_quick]
    total = sum(entry.seconds for entry in tasks) / 60.0
    complete = sum(entry.job.complete() is not None for entry in quick)
    slow = len(planned) - len(quick)
    words = [
        f"{len(planned)} refinements of {len({entry.scene for entry in planned})} scenes, "
        f"{len(quick)} of them quick, {complete} complete, in {folder}",
        f"now {len(tasks)} runs, one after the other: about {total:.0f} min of {minutes:g}",
    ]
    if slow:
        words.append(f"{slow} refinements take more than a minute: quintet study SCENE runs them")
    chosen = {entry.job.name for entry in tasks}
    left = {
        entry.job.name: entry.seconds
        for entry in quick
        if entry.job.name not in chosen and entry.job.complete() is None
    }
    if left:
        more = sum(left.values()) / 60.0
        words.append(
            f"{len(left)} quick runs, about {more:.0f} min more, do not fit into the time: the "
            "same command goes on"
        )
    return words


def _run(tasks: list[Planned], seconds: float, stop: Callable[[], bool]) -> None:
    """Run the shortest first, so that most are done if they take longer than estimated."""
    by_name = {entry.job.name: entry for entry in tasks}
    limit = time.monotonic() + seconds

    def do(job: Job) -> Any:
        if time.monotonic() + by_name[job.name].seconds > limit:
            return {"status": NOT_RUN}  # earlier ones took longer than estimated
        return carry_out(job, stop)

    with ThreadPoolExecutor(1) as thread:
        jobs = [entry.job for entry in by_name.values()]
        for number, (job, run) in enumerate(finished(jobs, thread, do, stop), 1):
            entry = by_name[job.name]
            wall = run.get("timing", {}).get("wall", 0.0)
            if run["status"] == NOT_RUN:
                continue
            line = f"{entry.scene} {entry.refinement.label}: {run['status']}, {wall:.1f} s"
            print(f"{number} of {len(jobs)}: {line}", flush=True)


def collect(planned: list[Planned], before: list[Row]) -> list[Row]:
    """Summarize the studies of all scenes from what is complete in the folder.

    Of refinements that are not, the rows that were measured before are taken over.
    """
    known = {
        (study["scene"], json.dumps(row["settings"], sort_keys=True)): row
        for study in before
        for row in study["rows"]
        if row["status"] == "done"
    }
    studies = []
    for scene in dict.fromkeys(entry.scene for entry in planned):
        entries = [entry for entry in planned if entry.scene == scene]
        rows = [_row(entry, known) for entry in entries]
        folders = {entry.refinement.label: entry.job.folder for entry in entries}
        refinements = [entry.refinement for entry in entries]
        study = summarize(scene, refinements, rows, folders)
        del study["machine"]  # each row says on what it was measured
        studies.append(study)
    return studies


def _row(entry: Planned, known: dict[tuple[str, str], Row]) -> Row:
    """Row of one refinement: as complete now, as measured before, or as estimated."""
    run = entry.job.complete()
    if run is None:
        key = (entry.scene, json.dumps(entry.refinement.settings, sort_keys=True))
        row = row_of(entry.refinement, {"status": NOT_RUN})
        if key in known:  # kinds and labels are those of the scene as it is now
            names = ("label", "settings", "kind", "size", "sizes", "ladders")
            return known[key] | {name: row[name] for name in names}
        return row | {"seconds": entry.seconds, "is_quick": entry.is_quick}
    row = row_of(entry.refinement, run) | {"run": entry.job.name, "date": date_of(entry.job.folder)}
    row["on"] = {key: run["machine"][key] for key in ("cpu", "cores")}
    row["components"] = {
        name: {key: times[key] for key in PARTS} for name, times in row["components"].items()
    }
    short: Row = rounded({key: value for key, value in row.items() if key not in LEFT_OUT})
    return short


def rounded(value: Any) -> Any:
    """Round all numbers of a table, so that a file of many runs stays small."""
    if isinstance(value, float):
        return float(f"{value:.{DIGITS}g}")
    if isinstance(value, dict):
        return {key: entry if key == "settings" else rounded(entry) for key, entry in value.items()}
    return [rounded(entry) for entry in value] if isinstance(value, list) else value


def _status(planned: list[Planned], stopped: bool) -> int:
    """Exit status: 0 if all that is quick is done, 130 if something is left, 3 if it failed."""
    left = [e for e in planned if e.is_quick and e.job.complete() is None]
    if not left:
        return results.DONE
    failed = [entry for entry in left if (entry.job.folder / results.RESULTS).is_file()]
    return results.FAILED if failed and not stopped else results.INTERRUPTED
