"""``quintet study SCENE``: error against run time over the rungs of the scene's ladder.

Every rung is a run in a folder of its own, one after the other, so that none takes the time of
another. Rungs that ran are told when the study is interrupted; ``--keep`` goes on from there.
"""

import argparse
import json
from pathlib import Path
from typing import Any

from quintet.coupler.files.toml_writer import text_of
from quintet.coupler.measures.convergence import least_squares, richardson
from quintet.coupler.report import show
from quintet.coupler.report.work_precision import draw, table
from quintet.coupler.run import results
from quintet.coupler.run.signals import StopRequest
from quintet.coupler.scene.read import load, parse
from quintet.coupler.scene.study_table import Rung
from quintet.coupler.study.child_run import Trial
from quintet.interfaces.errors import SceneError

NAME, PICTURE = "study.json", "study.png"
Row = dict[str, Any]


def run_study(given: argparse.Namespace) -> int:
    """Run the ladder, compare its rungs, and tell which is the cheapest that will do."""
    scene = load(given.scene, given.preset, given.settings, given.swap, given.transport)
    if not scene.study:
        raise SceneError(f"{scene.path.name}: there is no ladder. Add a [[study]] for every rung.")
    folder = (given.out or Path("runs") / f"{scene.file.name}-study").resolve()
    stop, rows = StopRequest(), []
    trial = Trial.of(given, stop)
    with stop.listening():
        for rung in scene.study:
            place = folder / rung.folder
            kept = left(given, rung, place) if given.keep else None
            print(f"{rung.label}: {'kept' if kept else 'running'} in {place}", flush=True)
            rows.append(row_of(rung, kept or trial.run(rung.settings, place)))
            print(f"{rung.label}: {rows[-1]['status']}, {rows[-1]['wall']:.1f} s", flush=True)
            if rows[-1]["status"] == "interrupted" or stop():
                break
    found = conclude(scene.file.name, rows)
    folder.mkdir(parents=True, exist_ok=True)
    for path in (folder / NAME, given.json):
        if path:
            path.write_text(json.dumps(found, indent=2))
    tell(found, folder / PICTURE)
    return status_of(found, len(scene.study))


def left(given: argparse.Namespace, rung: Rung, folder: Path) -> Row | None:
    """Results that an earlier study left of this very run; None if there are none.

    Done, of the scene as it is read now, on this machine with these versions.
    """
    if not (folder / show.NAME).is_file():
        return None
    found, added = show.results(folder), [f"{k}={text_of(v)}" for k, v in rung.settings.items()]
    asked = (given.scene, given.preset, [*given.settings, *added], given.swap, given.transport)
    same = parse(folder / "scene.toml") == load(*asked).resolved
    done = same and found.get("status") == "done" and found.get("machine") == results.machine()
    return found if done else None


def row_of(rung: Rung, found: Row) -> Row:
    """What is kept of a rung's run; times in s, memory in bytes."""
    timing = found.get("timing", {})
    components = timing.get("components", {})
    wall = timing.get("wall", 0.0)
    expected = found.get("expect", [])
    return {
        "label": rung.label,
        "settings": rung.settings,
        "size": rung.size,
        "status": found["status"],
        "met": bool(expected) and all(one["met"] for one in expected),
        "errors": {one["name"]: error_of(one) for one in expected},
        "values": {one["name"]: one["value"] for one in expected},
        "within": {one["name"]: one["within"] for one in expected},
        "units": {one["name"]: one["unit"] for one in expected},
        "wall": wall,
        "cpu": sum(one["cpu"] for one in components.values()),
        "memory": timing.get("memory"),
        "overhead": (timing["exchange"] + timing["mapping"]) / wall if wall else None,
        "items": sum(one["items"] for one in components.values()),
        "components": components,
    }


def error_of(one: Row) -> float | None:
    """Distance of a value from its reference; None where the run has no value."""
    return None if one["value"] is None else abs(one["value"] - one["reference"])


def conclude(scene: str, rows: list[Row]) -> Row:
    """Put the rungs together: observed orders, and the cheapest that meets all expectations."""
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
    enough = min((row for row in done if row["met"]), key=lambda row: row["cpu"], default=None)
    keys = ("label", "settings", "cpu", "wall", "errors")
    return {
        "scene": scene,
        "rows": rows,
        "orders": orders,
        "richardson": settled,
        "recommended": {key: enough[key] for key in keys} if enough else None,
        "machine": results.machine(),
    }


def tell(found: Row, picture: Path) -> None:
    """Print the table, the orders and the recommendation; draw errors against time."""
    console, rows = show.on_screen(), found["rows"]
    console.print(table(rows))
    for name, order in found["orders"].items():
        said = [f"{order:.2f} by least squares" if order is not None else "no order observed"]
        if (also := found["richardson"][name]) is not None:
            said.append(f"{also:.2f} from the three finest")
        console.print(f"order of {name}: {', '.join(said)}")
    best = found["recommended"]
    console.print(
        f"recommended: {best['label']}, the cheapest that meets all expectations "
        f"({best['cpu']:.3g} s of processor time)"
        if best
        else "recommended: none; no rung meets all expectations"
    )
    if draw(rows, picture):
        console.print(f"drawn in {picture}")


def status_of(found: Row, rungs: int) -> int:
    """Exit status: as of a run, of the worst rung; 1 where no rung meets all expectations."""
    states = [row["status"] for row in found["rows"]]
    if "interrupted" in states or len(states) < rungs:
        return results.INTERRUPTED
    if any(state != "done" for state in states):
        return results.FAILED
    return results.DONE if found["recommended"] else results.UNMET
