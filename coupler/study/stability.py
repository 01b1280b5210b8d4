"""``quintet stability SCENE``: stability limits found by bisection, against predictions.

For each limit the two ends of its range are run, then the middle of what is left, repeatedly.
Where only expectations fail a scene is degraded, not unstable; that limit is looked for too.
"""

import argparse
import json
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.table import Table

from quintet.coupler.files.disk import write_whole
from quintet.coupler.files.json_file import JsonFile
from quintet.coupler.report.show import console
from quintet.coupler.report.work_precision import three_digits
from quintet.coupler.run import results
from quintet.coupler.run.folder import begin_series, discard_former
from quintet.coupler.run.signals import StopRequest
from quintet.coupler.scene.read import load_variants
from quintet.coupler.scene.stability_table import Limit
from quintet.coupler.scene.varied_tables import folder_name
from quintet.coupler.study.bisection import bisect, middle
from quintet.coupler.study.child_run import FOREVER, ChildRun
from quintet.coupler.study.invariants import Verdict, judge
from quintet.interfaces.errors import SceneError

NAME = "stability.json"
SLOWEST = 20.0  # times the first run of a limit, and MARGIN: a run that takes longer has stalled
MARGIN = 60.0  # s
NUMBERS = ("predicted", "found", "ratio", "degraded")  # of a limit, in the table
Found = dict[str, Any]


class Interrupted(Exception):
    """The search was interrupted by a signal."""


@dataclass(slots=True)
class Search:
    """Search for one stability limit: runs and verdicts by the value of its parameter."""

    limit: Limit
    other: float | None  # value of the second parameter
    child: ChildRun
    folder: Path
    verdicts: dict[float, Verdict] = field(default_factory=dict)
    time_limit: float = FOREVER  # s, of a run

    def __call__(self, value: float) -> Verdict:
        """Run with a value, once; return the verdict."""
        if value not in self.verdicts:
            folder = self.folder / f"{value:.6g}"
            run = self.child.run(self.limit.settings(value, self.other), folder, self.time_limit)
            if run["status"] == "interrupted" or self.child.stop():
                raise Interrupted
            if self.time_limit == FOREVER:
                self.time_limit = MARGIN + SLOWEST * run.get("timing", {}).get("wall", 0.0)
            verdict = self.verdicts[value] = judge(self.limit.table, run, folder)
            reason = f" ({verdict.broke}: {verdict.how})" if verdict.broke else ""
            print(f"{self.limit.name} = {value:.6g}: {verdict.state}{reason}", flush=True)
        return self.verdicts[value]

    def boundary(self, *accepted: str) -> tuple[float, float] | None:
        """Bisect between the accepted states and the others."""
        limit = self.limit.table
        known = sorted(self.verdicts, reverse=limit.from_ > limit.to)
        return bisect(known, lambda v: self(v).state in accepted, limit.log, limit.accuracy)


def run_stability(options: argparse.Namespace) -> int:
    """Find every limit of the scene; print them, and write them as JSON."""
    asked = (options.scene, options.preset, options.settings, options.swap, options.transport)
    scene, variants = load_variants(*asked)
    wanted = JsonFile(options.json, ("scene", "limits"))
    if not variants.stability:
        raise SceneError(
            f"{scene.path.name}: there is no limit to be found. Add a [[stability]] for each."
        )
    name = scene.file.name
    with begin_series("stability", name, (NAME,), options.out, options.force) as place:
        discard_former(place.path)
        return _find_all(options, name, variants.stability, place.path, wanted)


def _find_all(
    options: argparse.Namespace, scene: str, searched: list[Limit], folder: Path, wanted: JsonFile
) -> int:
    """Find every limit in a folder; return the exit status."""
    stop, limits, interrupted = StopRequest(), [], False
    with stop.listening():
        for limit in searched:
            for number, other in enumerate(limit.others()):
                if not interrupted:
                    place = folder / limit.folder
                    place = place if other is None else place / folder_name(f"{other:.6g}")
                    child = ChildRun.of(options, stop, limit.table.transport)
                    search = Search(limit, other, child, place)
                    interrupted = not find_limit(search)
                    limits.append(summary(search, limit.predicted(number)))
    content = {"scene": scene, "limits": limits, "machine": results.machine()}
    write_whole(folder / NAME, json.dumps(content, indent=2))
    wanted.write(content)
    print_limits(limits, console())
    if interrupted:
        return results.INTERRUPTED
    return results.DONE if all(limit["found"] is not None for limit in limits) else results.UNMET


def find_limit(search: Search) -> bool:
    """Search for one limit; return whether the search was completed."""
    try:
        for value in (search.limit.table.from_, search.limit.table.to):
            search(value)
        search.boundary("stable", "degraded")
        if any(verdict.state == "degraded" for verdict in search.verdicts.values()):
            search.boundary("stable")
    except Interrupted:
        return False
    return True


def summary(search: Search, predicted: float | None) -> Found:
    """Summarize a limit from the runs that were made."""
    limit, keys = search.limit, search.limit.table
    edges = {
        "unstable": _known_boundary(search, "stable", "degraded"),
        "degraded": _known_boundary(search, "stable"),
    }
    state = next((state for state, edge in edges.items() if edge), None)
    edge = edges[state] if state else None
    boundary = middle(*edge, keys.log) if edge else None
    verdict = search.verdicts.get(edge[1] if edge else keys.from_, Verdict("stable"))
    degraded = edges["degraded"] if state == "unstable" else None
    was_degraded = degraded is not None and search.verdicts[degraded[1]].state == "degraded"
    runs = [{"value": value, **asdict(each)} for value, each in sorted(search.verdicts.items())]
    return {
        "name": limit.name,
        "parameter": keys.parameter if isinstance(keys.parameter, str) else list(keys.parameter),
        "against": {keys.against.parameter: search.other} if keys.against else None,
        "predicted": predicted,
        "found": boundary,
        "ratio": boundary / predicted if boundary is not None and predicted else None,
        "holds": edge[0] if edge else None,
        "breaks": edge[1] if edge else None,
        "state": state,
        "broke": verdict.broke or None,
        "how": verdict.how or None,
        "degraded": middle(*degraded, keys.log) if degraded and was_degraded else None,
        "range": [keys.from_, keys.to],
        "source": keys.source,
        "runs": runs,
    }


def _known_boundary(search: Search, *accepted: str) -> tuple[float, float] | None:
    """Return the last accepted value and the first that is not, of those that were run."""
    limit = search.limit.table
    known = sorted(search.verdicts, reverse=limit.from_ > limit.to)
    return bisect(known, lambda v: search.verdicts[v].state in accepted, limit.log, float("inf"))


def print_limits(limits: list[Found], screen: Console) -> None:
    """Print a line of numbers for each limit, then how each was found."""
    columns = ["limit", "against", "predicted", "found", "ratio", "degraded", "then"]
    if all(limit["degraded"] is None for limit in limits):
        columns.remove("degraded")
    table = Table(box=None, pad_edge=False)
    for head in columns:
        right = head in NUMBERS
        table.add_column(head, justify="right" if right else "left", overflow="fold")
    for limit in limits:
        cells = {key: three_digits(limit[key]) for key in columns if key in NUMBERS}
        cells |= {"limit": limit["name"], "against": _against(limit), "then": limit["state"] or "-"}
        table.add_row(*(cells[head] for head in columns))
    screen.print(table)
    for limit in limits:
        place = f" at {against}" if (against := _against(limit)) else ""
        screen.print(f"{limit['name']}{place}: {_how(limit)}")


def _against(limit: Found) -> str:
    return ", ".join(f"{k} = {three_digits(v)}" for k, v in (limit["against"] or {}).items())


def _how(limit: Found) -> str:
    if limit["found"] is not None:
        return f"{limit['broke']}: {limit['how']}"
    first, last = limit["range"]
    if limit["broke"]:
        return f"at {first:g} already: {limit['broke']}: {limit['how']}"
    return f"holds from {first:g} to {last:g}"
