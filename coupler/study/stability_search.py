"""The search for one stability limit: runs by bisection, and what they found.

Every verdict is written to the folder of the limit with the hash of its run, so that a search that
was ended goes on, and nothing is run twice.
"""

import json
import time
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

from quintet.coupler.files.disk import write_whole
from quintet.coupler.scene.overrides import assignments
from quintet.coupler.scene.read import load
from quintet.coupler.scene.stability_table import Limit
from quintet.coupler.study.bisection import bisect, middle
from quintet.coupler.study.child_run import FOREVER, ChildRun
from quintet.coupler.study.invariants import Verdict, judge
from quintet.coupler.study.run_hash import run_hash
from quintet.coupler.study.sweep_run import was_killed
from quintet.interfaces.errors import SceneError

VERDICTS = "verdicts.json"  # in the folder of a limit
SLOWEST = 20.0  # times the first run of a limit, and MARGIN: a run that takes longer has stalled
MARGIN = 60.0  # s
RULES = ("energy", "momentum", "bounds", "expectation")  # of a limit, by which a run is judged
Row = dict[str, Any]


class Interrupted(Exception):
    """The search was interrupted by a signal, or a run was killed from outside."""


@dataclass(slots=True)
class Search:
    """Search for one stability limit: runs and verdicts by the value of its parameter."""

    limit: Limit
    other: float | None  # value of the second parameter
    child: ChildRun
    folder: Path
    keep: bool  # whether verdicts in the folder, of the same runs, count
    prefix: str = ""  # of the lines that tell the verdicts
    verdicts: dict[float, Verdict] = field(default_factory=dict)
    time_limit: float = FOREVER  # s, of a run
    seconds: float = 0.0  # of all runs
    _former: Row = field(default_factory=dict)  # verdicts in the folder, by the hash of the run

    def __post_init__(self) -> None:
        path = self.folder / VERDICTS
        if self.keep and path.is_file():
            self._former = json.loads(path.read_text("utf-8"))

    def __call__(self, value: float) -> Verdict:
        """Run with a value, once; return the verdict."""
        if value not in self.verdicts:
            run = self._hash(value)
            former = self._former.get(run)
            if former is None:
                former = self._former[run] = self._run(value)
                write_whole(self.folder / VERDICTS, json.dumps(self._former, indent=2))
            if self.time_limit == FOREVER:
                self.time_limit = MARGIN + SLOWEST * former["seconds"]
            self.seconds += former["seconds"]
            verdict = self.verdicts[value] = Verdict(**former["verdict"])
            reason = f" ({verdict.broke}: {verdict.how})" if verdict.broke else ""
            name = f"{self.prefix}{self.limit.name}"
            print(f"{name} = {value:.6g}: {verdict.state}{reason}", flush=True)
        return self.verdicts[value]

    def _run(self, value: float) -> Row:
        """Run with a value; return the verdict, and how long it took [s]."""
        began, folder = time.monotonic(), self.folder / f"{value:.6g}"
        run = self.child.run(self.limit.settings(value, self.other), folder, self.time_limit)
        if self.child.stop() or was_killed(run):
            raise Interrupted
        verdict = judge(self.limit.table, run, folder)
        return {"seconds": time.monotonic() - began, "verdict": asdict(verdict)}

    def _hash(self, value: float) -> str:
        """Hash of the run with a value, and of what it is judged by."""
        child = self.child
        settings = [*child.settings, *assignments(self.limit.settings(value, self.other))]
        try:
            scene = load(child.scene, child.preset, settings, child.swaps, child.transport)
        except SceneError as error:
            return str(error)  # the run is refused with this message
        rules = {rule: getattr(self.limit.table, rule) for rule in RULES}
        return f"{run_hash(scene)} {rules}"

    def boundary(self, *accepted: str) -> tuple[float, float] | None:
        """Bisect between the accepted states and the others."""
        limit = self.limit.table
        known = sorted(self.verdicts, reverse=limit.from_ > limit.to)
        return bisect(known, lambda v: self(v).state in accepted, limit.log, limit.accuracy)


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


def summary(search: Search, predicted: float | None, is_complete: bool = True) -> Row:
    """Summarize a limit from the runs that were made."""
    limit, keys = search.limit, search.limit.table
    edges = {
        "unstable": _known_boundary(search, "stable", "degraded"),
        "degraded": _known_boundary(search, "stable"),
    }
    state = next((state for state, edge in edges.items() if edge), None)
    edge = edges[state] if state and is_complete else None
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
        "state": state if is_complete else None,
        "broke": verdict.broke or None,
        "how": verdict.how or None,
        "degraded": middle(*degraded, keys.log) if degraded and was_degraded else None,
        "range": [keys.from_, keys.to],
        "complete": is_complete,
        "source": keys.source,
        "seconds": search.seconds,
        "runs": runs,
    }


def _known_boundary(search: Search, *accepted: str) -> tuple[float, float] | None:
    """Return the last accepted value and the first that is not, of those that were run."""
    limit = search.limit.table
    known = sorted(search.verdicts, reverse=limit.from_ > limit.to)
    return bisect(known, lambda v: search.verdicts[v].state in accepted, limit.log, float("inf"))
