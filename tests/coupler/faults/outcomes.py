"""What a run with a fault did, and when it said so."""

import re
import time
from dataclasses import dataclass, field
from threading import Thread

SOON = 1.0  # s within which a death is told
TOLD = 5.0  # s, and 3 usual windows, within which a hang is
ENDED = 1.5  # s after that until the run is over


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


def shortened(cause):
    """A cause without what differs from run to run."""
    cause = re.sub(r"process \d+", "its process", cause)
    cause = re.sub(r'"[^"]*/', '"', cause).replace("|", "/").replace("\n", " ")
    cause = re.sub(r"/\S*/small", "/small", cause)
    return cause if len(cause) < 240 else cause[:237] + "..."
