"""The outcome of a run with a fault: its end, the times of its messages, and the rules it broke."""

import re
import time
from dataclasses import dataclass, field
from threading import Thread

SOON = 1.0  # s within which a death is reported
TOLD = 5.0  # s, and 3 usual windows, within which a hang is
ENDED = 1.5  # s after that until the run is over
EARLIER = 0.2  # s, of its window before the fault, in which it is waited for too
BUILDING = 30.0  # times its patience may a component compute while it is built


@dataclass
class Outcome:
    """The end of a run and the times of its messages."""

    status: int
    results: dict
    err: str
    told: float  # s after the fault until the screen named the component that holds up the others
    said: float  # s after the fault until the screen named the failed component
    took: float  # s until the run had ended
    left: list = field(default_factory=list)

    @property
    def cause(self):
        """The cause in its results."""
        return self.results.get("fault", self.results).get("cause", "")


@dataclass(frozen=True)
class Expected:
    """The outcome that a run with a fault must have.

    `kind` is the fate of the process: it reports the fault, it is dead, stopped, it hangs, the
    scene is refused, or the process is that of the run and is gone.
    """

    culprit: str
    window: int
    cause: str  # words of the cause; one of several alternatives, separated by " | ", is enough
    kind: str
    status: int = 3
    patience: float = 8.0  # s
    built: bool = True  # else it is named after its patience, and may compute for longer
    computes: bool = True
    stack: str = "toy_faults.py"  # file that it must name

    @property
    def times(self):
        """Time until a hang is named, and the shortest and longest time until it is ended [s]."""
        named_early = self.built or not self.computes
        first = min(TOLD, self.patience) if named_early else self.patience
        last = BUILDING * self.patience if self.computes and not self.built else self.patience
        return first, min(last, self.patience) - EARLIER, last + 1.0


class Reader:
    """Reads the output of a run, with the time of each line."""

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
        """Wait for the run's end; return its status, the time, and its leftovers."""
        try:
            status = self.run.process.wait(seconds)
        finally:
            end_time = time.time()
            leftovers = [*self.run.left_processes(), *self.run.left_in_shared_memory()]
            self.run.end()
            for thread in self.threads:
                thread.join(5.0)
        return status, end_time, leftovers

    def first(self, words):
        """Time of the first line with these words, or None."""
        return next((moment for moment, line in self.lines if words in line), None)


def outcome(run, moment, culprit, seconds):
    """Wait for the end of a run whose component notes in a file when it fails."""
    reader = Reader(run)
    status, end_time, leftovers = reader.wait(seconds)
    assert moment.is_file(), f"it came to no fault: {reader.lines}"
    fault_time = float(moment.read_text().split()[0])
    named_at = reader.first(f"{culprit} keeps the others waiting") or end_time
    reported_at = reader.first(f"{culprit} failed in window") or end_time
    err = "".join(line for _, line in reader.lines)
    results = run.results if (run.folder / "results.json").is_file() else {}
    return Outcome(
        status,
        results,
        err,
        named_at - fault_time,
        reported_at - fault_time,
        end_time - fault_time,
        leftovers,
    )


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
    message = f"quintet: {expected.culprit} failed in window {expected.window}: "
    delay = outcome.took - outcome.said
    rules |= {
        f"results say failed; found {state}": state == "failed",
        f"culprit {expected.culprit}; found {culprit}": culprit == expected.culprit,
        f"window {expected.window}; found {window}": window == expected.window,
        "the screen must say so": message in outcome.err,
        f"over {ENDED} s later; found {delay:.2f}": delay < ENDED + slack,
    }
    if expected.kind == "hangs":
        limit, least, most = expected.times
        named_after = min(outcome.told, outcome.said)
        rules |= {
            f"told within {limit} s; found {named_after:.2f}": named_after < limit + slack,
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
    """A cause without the details that differ from run to run."""
    cause = re.sub(r"process \d+", "its process", cause)
    cause = re.sub(r'"[^"]*/', '"', cause).replace("|", "/").replace("\n", " ")
    cause = re.sub(r"/\S*/small", "/small", cause)
    return cause if len(cause) < 240 else cause[:237] + "..."
