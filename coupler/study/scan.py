"""``quintet scan SCENE``: whether wrong results are reported, from safe settings to absurd ones.

Every run of a scan is judged as if the scene had no expectations: it ends soundly, or with a
warning, a refusal or a failure. The values of the expectations give its error. A run that is wrong
and yet ends soundly is silently wrong: the worst that can happen to a user.
"""

import argparse
import json
import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rich.table import Table

from quintet.coupler.files.disk import write_whole
from quintet.coupler.files.json_file import JsonFile
from quintet.coupler.report.show import console
from quintet.coupler.report.work_precision import three_digits
from quintet.coupler.run import results
from quintet.coupler.run.folder import begin_series, discard_former
from quintet.coupler.run.signals import StopRequest
from quintet.coupler.scene.read import library, load_variants, parse
from quintet.coupler.scene.scan_table import Scan
from quintet.coupler.scene.scene import Scene
from quintet.coupler.study.child_run import FOREVER, ChildRun
from quintet.coupler.study.scene_or_all import refuse_with_all, require_scene_or_all
from quintet.interfaces.errors import SceneError
from quintet.interfaces.params import shown, unknown

NAME = "scan.json"
TRANSPORT = "memory"  # of runs, if none is given
SLOWEST, MARGIN = 20.0, 60.0  # times the first run of a scan, plus s: then a run has stalled
WRONG = 0.1  # relative error above which a result is wrong
RIGHT = 0.03  # relative error below which a warning is a false alarm
RIGHT_ROW, TOLD, FALSE_ALARM, SILENT = "right", "told", "false alarm", "SILENT"  # verdicts
QUICK = "quick"  # preset
ENERGY = "energy gained"  # name of its error, beside those of expectations
STATES = {
    results.DONE: "sound",
    results.UNMET: "warned",
    results.BAD: "refused",
    results.FAILED: "failed",
}
Row = dict[str, Any]


@dataclass(slots=True)
class Runs:
    """Runs of one scan, one after the other."""

    scan: Scan
    child: ChildRun
    folder: Path
    keep: bool  # results of an earlier scan
    time_limit: float = FOREVER  # s, of a run

    def row(self, number: int) -> Row | None:
        """Run with one of the values; return its row, None if interrupted."""
        settings = self.scan.settings(number)
        folder = self.folder / self.scan.run_folder(number)
        result = self.child.earlier(settings, folder) if self.keep else None
        if result is None:
            result = self.child.run(settings, folder, self.time_limit)
        if self.child.stop() or result["status"] == "interrupted":
            return None
        if self.time_limit == FOREVER:
            self.time_limit = MARGIN + SLOWEST * result.get("timing", {}).get("wall", 0.0)
        row = row_of(self.scan, number, result)
        print(f"{self.scan.name} = {shown(row['value'])}: {_sentence(row)}", flush=True)
        return row


def run_scan(options: argparse.Namespace) -> int:
    """Run the scans of a scene, or of all scenes; return the exit status: 1 if a row is silent."""
    require_scene_or_all("scan", options)
    if not options.all and options.quick:
        raise SceneError("--quick belongs to --all. Give --preset quick in its place.")
    wanted = JsonFile(options.json, ("scene", "scans"))
    if not options.all:
        content, status = _scan_scene(options)
        wanted.write(content)
        return status
    refuse_with_all("scan", options, "name", "out")
    contents, statuses = [], []
    for name, preset in _scenes_with_scans(options.quick):
        print(f"{name}{f' ({preset})' if preset else ''}", flush=True)
        asked = argparse.Namespace(**{**vars(options), "scene": name, "preset": preset})
        content, status = _scan_scene(asked)
        contents.append(content)
        statuses.append(status)
        if status == results.INTERRUPTED:
            break
    wanted.write(contents)
    return max(statuses, default=results.DONE)


def _scenes_with_scans(quick: bool) -> list[tuple[str, str]]:
    """Scenes that come with quintet and have scans, each with its preset."""
    tables = {name: parse(path) for name, path in library().items()}
    return [
        (name, QUICK if quick and QUICK in table.get("presets", {}) else "")
        for name, table in tables.items()
        if table.get("scan")
    ]


def _scan_scene(options: argparse.Namespace) -> tuple[Row, int]:
    """Run the scans of one scene in its folder; return what was found and the exit status."""
    asked = (options.scene, options.preset, options.settings, options.swap, options.transport)
    scene, variants = load_variants(*asked)
    scans = _chosen(scene, variants.scan, options.name)
    name = scene.file.name
    with begin_series("scan", name, (NAME,), options.out, options.force, options.keep) as place:
        runs = [Path(scan.folder) / scan.run_folder(k) for scan in scans for k in _numbers(scan)]
        place.check_runs(str(run) for run in runs)
        discard_former(place.path)
        return _run_all(options, name, scans, place.path)


def _numbers(scan: Scan) -> range:
    return range(len(scan.table.values))


def _chosen(scene: Scene, scans: list[Scan], name: str) -> list[Scan]:
    """Scans of a scene, or the one of a name."""
    if not scans:
        raise SceneError(
            f"{scene.path.name}: there is nothing to be scanned. Add a [[scan]] for each setting."
        )
    names = [scan.name for scan in scans]
    if name and name not in names:
        raise SceneError(unknown(f"--name {name}", name, names))
    return [scan for scan in scans if name in ("", scan.name)]


def _run_all(
    options: argparse.Namespace, scene: str, scans: list[Scan], folder: Path
) -> tuple[Row, int]:
    """Run scans in a folder; return what was found and the exit status."""
    stop, scan_rows, interrupted = StopRequest(), [], False
    child = ChildRun.of(options, stop, TRANSPORT)
    with stop.listening():
        for scan in scans:
            runs, rows = Runs(scan, child, folder / scan.folder, options.keep), []
            for number in _numbers(scan):
                row = None if interrupted else runs.row(number)
                interrupted = row is None
                rows += [row] if row else []
            scan_rows.append(summary(scan, rows))
    content = {"scene": scene, "scans": scan_rows, "machine": results.machine()}
    write_whole(folder / NAME, json.dumps(content, indent=2))
    for scan_summary in scan_rows:
        console().print(table(scan_summary))
    if interrupted:
        return content, results.INTERRUPTED
    silent = any(row["verdict"] == SILENT for scan_row in scan_rows for row in scan_row["rows"])
    return content, results.UNMET if silent else results.DONE


def summary(scan: Scan, rows: list[Row]) -> Row:
    """One scan with its rows, for programs."""
    return {
        "name": scan.name,
        "parameter": scan.table.parameter,
        "source": scan.table.source,
        "judged": [*scan.judged, *([ENERGY] if scan.table.energy else [])],
        "rows": rows,
    }


def row_of(scan: Scan, number: int, result: Row) -> Row:
    """Judge the run with one of the values by its results."""
    status, why = status_of(result)
    outcomes = {outcome["name"]: outcome for outcome in result.get("expect", [])}
    errors = {
        name: _error(scan, name, number, outcomes[name]) if name in outcomes else None
        for name in scan.judged
    }
    if scan.table.energy:
        errors[ENERGY] = _energy_gained(result)
    error = None if None in errors.values() else max(errors.values(), key=lambda e: e or 0.0)
    return {
        "value": scan.table.values[number],
        "status": status,
        "state": STATES[status],
        "why": why,
        "error": error,
        "errors": errors,
        "values": {name: outcome["value"] for name, outcome in outcomes.items() if name in errors},
        "verdict": verdict(status, error),
        "wall": result.get("timing", {}).get("wall"),
    }


def status_of(result: Row) -> tuple[int, str]:
    """Exit status that a run would have without expectations, and the reason."""
    warnings = result.get("warnings") or []
    match result["status"]:
        case "done":
            reasons = [str(warning.get("text", warning)) for warning in warnings]
            return (results.UNMET if warnings else results.DONE), "; ".join(reasons)
        case "refused":
            cause = result.get("cause") or result.get("fault", {}).get("cause", "")
            return results.BAD, str(cause)
        case "stalled":
            return results.FAILED, "it takes too long: its steps became too small"
        case _:
            return results.FAILED, str(result.get("fault", {}).get("cause", "no results"))


def _error(scan: Scan, name: str, number: int, outcome: Row) -> float | None:
    """Relative error of one expectation; None where it could not be measured."""
    if outcome["value"] is None:
        return None
    answer = scan.exact(name, number)
    exact = float(outcome["reference"] if answer is None else answer)
    scale = scan.scale.get(name, abs(exact))  # 0 where the measure of a reference curve is
    error = abs(outcome["value"] - exact) / scale if scale else math.inf
    return error if math.isfinite(error) else None


def _energy_gained(result: Row) -> float | None:
    """Energy that the run gained, over that turned over; None where it was not measured."""
    balance = result.get("ledger", {}).get("energy_balance")
    if not balance:
        return None
    share = balance["run"]["gained"] / balance["scale"]
    return share if math.isfinite(share) else None


def verdict(status: int, error: float | None) -> str:
    """Verdict on a run with this status and relative error; None: it could not be measured."""
    if status == results.DONE:
        return RIGHT_ROW if error is not None and error <= WRONG else SILENT
    return FALSE_ALARM if error is not None and error < RIGHT else TOLD


def _sentence(row: Row) -> str:
    error = "error not measured" if row["error"] is None else f"error {_percent(row['error'])}"
    return f"{row['verdict']} ({row['state']}, {error})"


def _percent(error: float | None) -> str:
    return "-" if error is None else f"{three_digits(100.0 * error)} %"


def table(scan: Row) -> Table:
    """One line for each value, one column for each expectation's error."""
    names = scan["judged"]
    screen_table = Table(box=None, pad_edge=False, title=scan["name"], title_justify="left")
    for head in (scan["parameter"], "status", *names, "verdict", "why"):
        screen_table.add_column(head, justify="right" if head in names else "left", overflow="fold")
    for row in scan["rows"]:
        errors = [_percent(row["errors"][name]) for name in names]
        status = f"{row['status']} {row['state']}"
        screen_table.add_row(shown(row["value"]), status, *errors, row["verdict"], row["why"])
    return screen_table
