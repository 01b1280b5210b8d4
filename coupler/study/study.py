"""``quintet study SCENE``: error against run time over the refinements of a scene.

Every refinement is a run in a folder of its own, one after the other, so that they do not share
processors. An interrupted study reports those that ran; ``--keep`` continues from there.
"""

import argparse
import json
from pathlib import Path
from typing import Any

from quintet.coupler.files.disk import write_whole
from quintet.coupler.files.json_file import JsonFile
from quintet.coupler.measures.convergence import least_squares, richardson
from quintet.coupler.report import show
from quintet.coupler.report.work_precision import draw, table
from quintet.coupler.run import results
from quintet.coupler.run.folder import begin_series, discard_former
from quintet.coupler.run.signals import StopRequest
from quintet.coupler.scene.read import load_variants
from quintet.coupler.scene.study_table import Refinement
from quintet.coupler.study.child_run import ChildRun
from quintet.interfaces.errors import SceneError

NAME, PICTURE = "study.json", "study.png"
Row = dict[str, Any]


def run_study(options: argparse.Namespace) -> int:
    """Run all refinements, compare them, and recommend the cheapest that meets all expectations."""
    asked = (options.scene, options.preset, options.settings, options.swap, options.transport)
    scene, variants = load_variants(*asked)
    wanted = JsonFile(options.json, ("scene", "rows"))
    if not variants.study:
        raise SceneError(f"{scene.path.name}: there is no [[study]]. Add one for every refinement.")
    files = (NAME, PICTURE)
    with begin_series(
        "study", scene.file.name, files, options.out, options.force, options.keep
    ) as place:
        place.check_runs(refinement.folder for refinement in variants.study)
        discard_former(place.path)
        return _run_all(options, scene.file.name, variants.study, place.path, wanted)


def _run_all(
    options: argparse.Namespace,
    scene: str,
    refinements: list[Refinement],
    folder: Path,
    wanted: JsonFile,
) -> int:
    """Run all refinements in a folder; return the exit status."""
    stop, rows = StopRequest(), []
    child = ChildRun.of(options, stop)
    with stop.listening():
        for refinement in refinements:
            place = folder / refinement.folder
            earlier = child.earlier(refinement.settings, place) if options.keep else None
            print(f"{refinement.label}: {'kept' if earlier else 'running'} in {place}", flush=True)
            rows.append(row_of(refinement, earlier or child.run(refinement.settings, place)))
            print(f"{refinement.label}: {rows[-1]['status']}, {rows[-1]['wall']:.1f} s", flush=True)
            if rows[-1]["status"] == "interrupted" or stop():
                break
    summary = conclude(scene, rows)
    write_whole(folder / NAME, json.dumps(summary, indent=2))
    wanted.write(summary)
    print_summary(summary, folder / PICTURE)
    return status_of(summary, len(refinements))


def _judged(outcomes: list[Row]) -> Row:
    """What expectations gave, by their names."""
    names = [outcome["name"] for outcome in outcomes]
    columns = {
        "errors": map(error_of, outcomes),
        "values": (outcome["value"] for outcome in outcomes),
        "within": (outcome["within"] for outcome in outcomes),
        "units": (outcome["unit"] for outcome in outcomes),
    }
    return {key: dict(zip(names, column, strict=True)) for key, column in columns.items()}


def row_of(refinement: Refinement, run: Row) -> Row:
    """Summarize the run of a refinement; times in s, memory in bytes."""
    timing = run.get("timing", {})
    components = timing.get("components", {})
    wall = timing.get("wall", 0.0)
    expected = run.get("expect", [])
    return {
        "label": refinement.label,
        "settings": refinement.settings,
        "size": refinement.size,
        "status": run["status"],
        "met": bool(expected)
        and all(outcome["met"] or not outcome["required"] for outcome in expected),
        **_judged(expected),
        "wall": wall,
        "cpu": sum(times["cpu"] for times in components.values()),
        "memory": timing.get("memory"),
        "overhead": (timing["exchange"] + timing["mapping"]) / wall if wall else None,
        "items": sum(times["items"] for times in components.values()),
        "components": components,
    }


def error_of(outcome: Row) -> float | None:
    """Distance of a value from its reference; None where the run has no value."""
    return None if outcome["value"] is None else abs(outcome["value"] - outcome["reference"])


def conclude(scene: str, rows: list[Row]) -> Row:
    """Compare the refinements: observed orders, and the cheapest that meets all expectations."""
    done = [row for row in rows if row["status"] == "done"]
    sized = [row for row in done if row["size"] is not None]
    names = list(dict.fromkeys(name for row in done for name in row["errors"]))
    orders: dict[str, float | None] = {}
    settled: dict[str, float | None] = {}
    for name in names:
        known = [row for row in sized if row["errors"][name] is not None]
        sizes = [row["size"] for row in known]
        orders[name] = least_squares(sizes, [row["errors"][name] for row in known])
        settled[name] = richardson(sizes, [row["values"][name] for row in known])
    cheapest = min((row for row in done if row["met"]), key=lambda row: row["cpu"], default=None)
    keys = ("label", "settings", "cpu", "wall", "errors")
    return {
        "scene": scene,
        "rows": rows,
        "orders": orders,
        "richardson": settled,
        "recommended": {key: cheapest[key] for key in keys} if cheapest else None,
        "machine": results.machine(),
    }


def print_summary(summary: Row, picture: Path) -> None:
    """Print the table, the orders and the recommendation; draw the work-precision diagram."""
    screen, rows = show.console(), summary["rows"]
    screen.print(table(rows))
    for name, order in summary["orders"].items():
        orders = [f"{order:.2f} by least squares" if order is not None else "no order observed"]
        if (also := summary["richardson"][name]) is not None:
            orders.append(f"{also:.2f} from the three finest")
        screen.print(f"order of {name}: {', '.join(orders)}")
    best = summary["recommended"]
    screen.print(
        f"recommended: {best['label']}, the cheapest that meets all expectations "
        f"({best['cpu']:.3g} s of processor time)"
        if best
        else "recommended: none; no refinement meets all expectations"
    )
    if draw(rows, picture, summary["scene"]):
        screen.print(f"drawn in {picture}")


def status_of(summary: Row, refinements: int) -> int:
    """Exit status of the worst run; 1 where no refinement meets all expectations."""
    states = [row["status"] for row in summary["rows"]]
    if "interrupted" in states or len(states) < refinements:
        return results.INTERRUPTED
    if any(state != "done" for state in states):
        return results.FAILED
    return results.DONE if summary["recommended"] else results.UNMET
