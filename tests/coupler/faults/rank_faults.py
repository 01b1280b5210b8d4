"""Faults of one rank of a component of two, at three moments, over each transport."""

import os
import tempfile
from dataclasses import dataclass
from pathlib import Path

from chain_scene import write
from outcomes import ENDED, SOON, TOLD, Outcome, Reader, shortened
from started import Started

TRANSPORTS = ("zenoh", "mpi")
WINDOW, FIRST_STEP = 60, 120  # of the later moment
MOMENTS = {"build": -1, "first window": 0, "later window": FIRST_STEP}  # step


@dataclass(frozen=True)
class RankFault:
    """One way of rank 1 to fail.

    `kind` is what becomes of it: it says so itself, it is dead, stopped, or it hangs.
    """

    name: str
    kind: str
    cause: str


HANGS = "stopped responding: kept the others waiting for"
RANK = f"rank 1 on {os.uname().nodename}"
FAULTS = [
    RankFault("exception", "said", f"{RANK}: asked to raise"),
    RankFault("sys.exit", "said", f"{RANK}: asked Python to exit, with status 0"),
    RankFault("os._exit", "dead", f"{RANK}: process"),
    RankFault("SIGKILL", "dead", f"{RANK}: process"),
    RankFault("SIGSTOP", "stopped", f"stopped responding: {RANK}: process"),
    RankFault("endless loop", "hangs", HANGS),
    RankFault("deadlock", "hangs", HANGS),
    RankFault("NaN", "said", f"what {RANK} gave: every number of motion.position must be finite"),
]
CASES = [
    (fault, moment, transport) for fault in FAULTS for moment in MOMENTS for transport in TRANSPORTS
]


def fail(fault, moment, transport, folder, patience):
    """Run a scene of a chain of two ranks, of which rank 1 fails."""
    at = folder / "moment"
    keys = f'fails_on = 1\nfails_at = {MOMENTS[moment]}\nfails_by = "{fault.name}"\nmoment = "{at}"'
    kind = "toy_rank_faults:FaultyChain"
    run = Started(write(folder, transport, 2, 100.0, keys, kind, patience))
    reader = Reader(run)
    status, ended, left = reader.wait(60.0 + patience)
    assert at.is_file(), f"it came to no fault: {reader.lines}"
    begun = float(at.read_text())
    told = reader.first("keeps the others waiting") or ended
    said = reader.first("failed in window") or ended
    err = "".join(line for _, line in reader.lines)
    results = run.results if (run.folder / "results.json").is_file() else {}
    return Outcome(status, results, err, told - begun, said - begun, ended - begun, left)


def wrong(fault, moment, patience, outcome, slack=0.5):
    """Rules that a run broke; a loaded machine may need some seconds more."""
    blamed = outcome.results.get("fault", {})
    cause, late = blamed.get("cause", ""), outcome.took - outcome.said
    rules = {
        f"status 3; found {outcome.status}": outcome.status == 3,
        f"culprit chain; found {blamed.get('component')}": blamed.get("component") == "chain",
        f"window; found {blamed.get('window')}": blamed.get("window") == window(moment),
        f"cause {fault.cause}; found {cause}": fault.cause in cause,
        f"rank and host; found {cause}": RANK in cause and "rank 0" not in cause,
        "the screen must say so": "quintet: chain failed in window" in outcome.err,
        f"nothing left; found {outcome.left}": not outcome.left,
        f"over {ENDED} s later; found {late:.2f}": late < ENDED + slack,
    }
    if fault.kind == "hangs":
        limit, longest = min(TOLD, patience) + slack, patience + 1.0 + slack
        first = min(outcome.told, outcome.said)
        rules |= {
            f"told within {limit} s; found {first:.2f}": first < limit,
            f"ended after {patience} s; found {outcome.said:.2f}": outcome.said < longest,
            "its stack": "in fail" in blamed.get("traceback", ""),
            "its stack on the screen": "toy_rank_faults.py" in outcome.err,
        }
    else:
        rules[f"told within {SOON} s; found {outcome.said:.2f}"] = outcome.said < SOON + slack
    return [rule for rule, holds in rules.items() if not holds]


def window(moment):
    """Window in which a rank fails at a moment."""
    return WINDOW if MOMENTS[moment] == FIRST_STEP else 0


def rank_rows(patience):
    """Rows of the table for a rank that fails."""
    for fault in FAULTS:
        for moment in MOMENTS:
            cells, causes = [], []
            for transport in TRANSPORTS:
                with tempfile.TemporaryDirectory() as folder:
                    outcome = fail(fault, moment, transport, Path(folder) / "run", patience)
                times = f"{outcome.said:.2f} s"
                if fault.kind == "hangs":
                    times = f"{outcome.told:.1f} s, {outcome.said:.1f} s"
                cells.append("; ".join(wrong(fault, moment, patience, outcome)) or times)
                causes.append(outcome.results.get("fault", {}).get("cause", ""))
                print(f"rank 1 of 2, {fault.name}, {moment}", transport, cells[-1], flush=True)
            cause = shortened(causes[-1]).replace(os.uname().nodename, "HOST")
            name = f"rank 1 of 2, {moment}: {fault.name}"
            yield f"| {name} | | {' | '.join(cells)} | {cause} |"
