"""Faults of one rank of a component of two, at three moments, over each transport."""

import os
from dataclasses import dataclass

from chain_scene import write
from outcomes import Expected, broken_rules, outcome
from started import Started

TRANSPORTS = ("zenoh", "mpi")
WINDOW, FIRST_STEP = 60, 120  # of the later moment
# Activity of the rank at its failure: moment of toy_rank_faults.FaultyChain, and step.
MOMENTS = {
    "build": ("build", -1),
    "first window": ("step", 0),
    "later window": ("step", FIRST_STEP),
}


@dataclass(frozen=True)
class RankFault:
    """One way of rank 1 to fail.

    `kind` is the fate of the rank: it reports the fault, it is dead, stopped, or it hangs.
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
    note, (fails_in, fails_at) = folder / "moment", MOMENTS[moment]
    keys = f'fails_in = "{fails_in}"\nfails_at = {fails_at}\nfails_by = "{fault.name}"\n'
    keys += f'moment = "{note}"'
    kind = "toy_rank_faults:FaultyChain"
    scene = write(folder, transport, 2, 100.0, keys, kind, patience)
    return outcome(Started(scene), note, "chain", 60.0 + patience)


def wrong(fault, moment, patience, outcome, slack=0.5):
    """Rules that a run broke; a loaded machine may need some seconds more."""
    window = WINDOW if moment == "later window" else 0
    # Ranks have reported their names, and are watched, before they build.
    expected = Expected("chain", window, fault.cause, fault.kind, patience=patience)
    broken = broken_rules(expected, outcome, slack)
    if RANK not in outcome.cause or "rank 0" in outcome.cause:
        broken.append(f"rank and host; found {outcome.cause}")
    return broken
