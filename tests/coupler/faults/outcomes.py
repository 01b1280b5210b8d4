"""What a run with a fault did, when it said so, and which rules of a cell it broke."""

import re
import time
from dataclasses import dataclass, field
from threading import Thread

SOON = 1.0  # s within which a death is told
TOLD = 5.0  # s, and 3 usual windows, within which a hang is
ENDED = 1.5  # s after that until the run is over
EARLIER = 0.2  # s, of its window before the fault, in which it is waited for too
BUILDING = 30.0  # times its patience may a component compute while it is built


@dataclass
class Outcome:
    """What a run did."""

    status: int
    results: dict
    err: str
    told: float  # s after the fault until the screen said who keeps the others waiting
    said: float  # s until it said what failed
    took: float  # s until the run had ended
    left: list = field(default_factory=list)

    @property
    def cause(self):
        """The cause in its results."""
        return self.results.get("fault", self.results).get("cause", "")


@dataclass(frozen=True)
class Expected:
    """What a run with a fault must do.

    `kind` is what becomes of the process: it says so itself, it is dead, stopped, it hangs, the
    scene is refused, or the process is that of the run and is gone.
    """

    culprit: str
    window: int
    cause: str  # words of it; of several, parted by " | ", one is enough
    kind: str
    status: int = 3
    patience: float = 8.0  # s
    built: bool = True  # else it is told of after its patience, and may compute for longer
    computes: bool = True
    stack: str = "toy_faults.py"  # file that it must name

    @property
    def times(self):
        """Until a hang is told, and the shortest and longest time until it is ended [s]."""
        told_soon = self.built or not self.computes
        first = min(TOLD, self.patience) if told_soon else self.patience
        last = BUILDING * self.patience if self.computes and not self.built else self.patience
        return first, min(last, self.patience) - EARLIER, last + 1.0


class Reader:
    """Reads what a run says, and when."""

    def __init__(self, run):
        self.run, self.lines = run, []
        streams = (run.process.stdout, run.process.stderr)
        self.threads = [Thread(target=self._read, args=[stream]) for stream in streams]
        for thread in self.threads:
            thread.start()

    def _read(self, stream):
        with stream:
            for line in stream:
                self.lines.append((time.time(), line))

    def wait(self, seconds):
        """Wait for the run's end; return its status, when that was, and what it has left."""
        try:
            status = self.run.process.wait(seconds)
        finally:
            ended = time.time()
            left = [*self.run.left_processes(), *self.run.left_in_shared_memory()]
            self.run.end()
            for thread in self.threads:
                thread.join(5.0)
        return status, ended, left

    def first(self, words):
        """When some words were said first, if they were."""
        return next((then for then, line in self.lines if words in line), None)


def outcome(run, moment, culprit, seconds):
    """Wait for the end of a run whose component notes in a file when it fails."""
    reader = Reader(run)
    status, ended, left = reader.wait(seconds)
    assert moment.is_file(), f"it came to no fault: {reader.lines}"
    at = float(moment.read_text().split()[0])
    told = reader.first(f"{culprit} keeps the others waiting") or ended
    said = reader.first(f"{culprit} failed in window") or ended
    err = "".join(line for _, line in reader.lines)
    results = run.results if (run.folder / "results.json").is_file() else {}
    return Outcome(status, results, err, told - at, said - at, ended - at, left)


def broken_rules(expected, outcome, slack=0.5):
    """Rules that a run broke; a loaded machine may need some seconds more."""
    rules = {
        f"status {expected.status}; found {outcome.status}": outcome.status == expected.status,
        f"cause {expected.cause}; found {outcome.cause}": any(
            words in outcome.cause for words in expected.cause.split(" | ")
        ),
        f"nothing left; found {outcome.left}": not outcome.left,
    }
    state, fault = outcome.results.get("status"), outcome.results.get("fault", {})
    if expected.kind == "refused":
        return _failing(rules | {f"results say refused; found {state}": state == "refused"})
    culprit, window = fault.get("component"), fault.get("window")
    said = f"quintet: {expected.culprit} failed in window {expected.window}: "
    late = outcome.took - outcome.said
    rules |= {
        f"results say failed; found {state}": state == "failed",
        f"culprit {expected.culprit}; found {culprit}": culprit == expected.culprit,
        f"window {expected.window}; found {window}": window == expected.window,
        "the screen must say so": said in outcome.err,
        f"over {ENDED} s later; found {late:.2f}": late < ENDED + slack,
    }
    if expected.kind == "hangs":
        told, least, most = expected.times
        first = min(outcome.told, outcome.said)
        rules |= {
            f"told within {told} s; found {first:.2f}": first < told + slack,
            f"ended after {most - 1.0} s; found {outcome.said:.2f}": least
            < outcome.said
            < most + slack,
            "its stack": "in fail" in fault.get("traceback", ""),
            "its stack on the screen": expected.stack in outcome.err,
        }
    else:
        rules[f"told within {SOON} s; found {outcome.said:.2f}"] = outcome.said < SOON + slack
    return _failing(rules)


def _failing(rules):
    return [rule for rule, holds in rules.items() if not holds]


def shortened(cause):
    """A cause without what differs from run to run."""
    cause = re.sub(r"process \d+", "its process", cause)
    cause = re.sub(r'"[^"]*/', '"', cause).replace("|", "/").replace("\n", " ")
    cause = re.sub(r"/\S*/small", "/small", cause)
    return cause if len(cause) < 240 else cause[:237] + "..."
