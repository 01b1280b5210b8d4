"""A component of several MPI ranks: rank 0 leads, the others follow.

Rank 0 holds the line to the coupler and passes every order on. All ranks carry it out, and rank 0
alone answers. If another rank fails, a thread of rank 0 tells the coupler, for the solver of rank 0
may be waiting for that rank.
"""

import os
import threading
import time
from collections.abc import Mapping
from typing import Any

from quintet.interfaces.component import Fields
from quintet.interfaces.errors import QuintetError
from quintet.interfaces.lines.message import Message, Shapes
from quintet.interfaces.lines.mpi import MpiLine, communicator_of
from quintet.interfaces.lines.transport import Line
from quintet.interfaces.serving.outputs import Outputs, Sums
from quintet.interfaces.serving.serve import LONGEST_WAIT, Answer, Server

FAILURES = ("failed", "unable")  # answers of a rank that could not carry out an order
LOOKING = 0.05  # s between two looks at what other ranks say
DECIDING = 1.0  # s for rank 0 to fail at the same order as another rank
TELLING = 5.0  # s for all ranks to tell what they used
NOTICING = 2.0  # s for the coupler to notice that a rank has died
MPI_ERROR = "mpi4py.MPI.Exception: "


class LeadingLine:
    """The line of rank 0 to the coupler, and its lines to the other ranks.

    Parameters
    ----------
    line : Line
        To the coupler.
    others : list of MpiLine
        To ranks 1, 2 and so on.
    hosts : list of str
        Of these ranks.
    """

    def __init__(self, line: Line, others: list[MpiLine], hosts: list[str]) -> None:
        self._line, self._others, self._hosts = line, others, hosts
        self._orders, self._answered = 0, 0  # how many were received, and answered
        self._failed_at = 0  # the last order that this rank could not carry out
        self._over = False  # a failure was reported, or the line is closed
        self._used: list[Mapping[str, Any]] = []  # by other ranks, at the end
        self._lock = threading.Lock()
        threading.Thread(target=self._watch, name="ranks", daemon=True).start()

    def receive(self, seconds: float, expected: Shapes | None = None) -> Message:
        """Receive an order, and pass it on."""
        message = self._line.receive(seconds, expected)
        for line in self._others:
            line.send(message.header, message.fields)
        self._orders += 1
        return message

    def send(self, header: Mapping[str, Any], fields: Fields) -> None:
        """Answer for all ranks."""
        if header["order"] in FAILURES and MPI_ERROR in header["traceback"]:
            time.sleep(NOTICING)  # most likely another rank has died: the coupler names that one
        if "memory" in header:
            header = self._of_all(header)
        with self._lock:
            if self._over:
                return
            if header["order"] in FAILURES:
                self._failed_at = self._orders
            self._line.send(header, fields)
            self._answered = self._orders
        if "memory" in header:  # the last answer: from now on ranks may end
            for line in self._others:
                line.send({"order": "over"}, {})

    def _of_all(self, header: Mapping[str, Any]) -> dict[str, Any]:
        """Add what the other ranks used to the last answer."""
        limit = time.monotonic() + TELLING
        while len(self._used) < len(self._others) and time.monotonic() < limit:
            time.sleep(LOOKING)
        used = [header, *self._used]
        return {**header, **{key: sum(rank[key] for rank in used) for key in ("memory", "cpu")}}

    def spread(self, state: Fields) -> Fields:
        """Give a state, which this rank has whole, to all ranks; return it."""
        for line in self._others:
            line.send({"order": "state"}, state)
        return state

    def close(self) -> None:
        """See `Line.close`."""
        self._over = True
        self._line.close()

    def _watch(self) -> None:
        while not self._over:
            time.sleep(LOOKING)
            for line, host in zip(self._others, self._hosts, strict=True):
                try:
                    if line.peek() is not None:
                        self._hear(line.receive(LOOKING), host)
                except QuintetError:  # it is dead, which the coupler sees
                    return

    def _hear(self, report: Message, host: str) -> None:
        """Note what a rank used; report its failure, unless this one fails at the same order."""
        header = report.header
        if report.order == "used":
            self._used.append(header)
            return
        limit = time.monotonic() + DECIDING
        while self._answered < int(header["at"]) and time.monotonic() < limit:
            time.sleep(LOOKING)
        with self._lock:
            if self._over or self._failed_at >= int(header["at"]):
                return
            self._over = True
            text = f"rank {header['rank']} on {host}: {header['text']}"
            self._line.send({**header, "order": "failed", "text": text}, {})


class FollowingLine:
    """The line of another rank to rank 0; the coupler does not hear what it answers."""

    def __init__(self, line: MpiLine, rank: int) -> None:
        self._line, self._rank = line, rank
        self._orders, self._cpu = 0, 0.0

    def receive(self, seconds: float, expected: Shapes | None = None) -> Message:
        """Receive the next order."""
        message = self._line.receive(seconds, expected)
        self._orders += 1
        return message

    def send(self, header: Mapping[str, Any], fields: Fields) -> None:
        """Tell rank 0 of a failure, and at the end of what this rank used."""
        if header["order"] in FAILURES:
            self._line.send({**header, "at": self._orders, "rank": self._rank}, {})
        elif "memory" in header:
            self._line.send({"order": "used", "memory": header["memory"], "cpu": self._cpu}, {})
            self._line.receive(2.0 * TELLING)  # until rank 0 has answered
        else:
            self._cpu += header.get("cpu", 0.0)

    def spread(self, _: Fields) -> Fields:
        """Return the state that rank 0 has."""
        return self._line.receive(LONGEST_WAIT).fields

    def close(self) -> None:
        """See `Line.close`."""


class Unheard(Outputs):
    """Outputs of a rank that does not answer: its rows are among those of rank 0."""

    def check(self, fields: Fields) -> Fields:
        """Accept anything."""
        return fields

    def add(self, outputs: Fields, taken: Fields, dt: float) -> None:
        """Add nothing."""

    def collect(self, outputs: Fields) -> dict[str, Any]:
        """Send nothing."""
        return {}

    def audit(self) -> Sums:
        """Tell no sums."""
        return {}


class FollowingServer(Server):
    """Carries out orders on a rank that does not answer."""

    outputs_class = Unheard

    def _view(self, message: Message) -> Answer:
        self._totals()
        if message.header.get("shown", True):
            if self.component.shows:
                self.component.view()
            else:  # as `look_at` does without a view of the component's own
                self.component.view()
                self.component.give(frozenset(self.outputs.fields))
                self.component.describe()
        if message.header.get("walls"):
            self.component.walls()
        return {}, {}


class Ranks:
    """The ranks of a component, as one of them finds them when it starts; collective.

    Parameters
    ----------
    name : str
        Of the component.
    first : int
        Number of its rank 0 among all ranks of the MPI job.
    count : int
    me : mapping
        What the coupler needs to watch this process; see `process.about_me`.
    """

    def __init__(self, name: str, first: int, count: int, me: Mapping[str, Any]) -> None:
        self.communicator = communicator_of(first, count)  # of the solver
        self.rank = self.communicator.rank
        self._between = self.communicator.Dup()
        self._name = name
        if self.rank:
            line = MpiLine("", f"{name} {self.rank}", f"rank 0 of {name}", 0, 0, self._between)
            line.send({"order": "hello", **me}, {})
            leader = line.receive(LONGEST_WAIT).header
            line.pid = int(leader["pid"]) if leader["host"] == me["host"] else 0
            self._lines, self.others = [line], []
        else:
            self._lines = [self._to(rank) for rank in range(1, count)]
            self.others = [line.receive(LONGEST_WAIT).header for line in self._lines]
            for line, other in zip(self._lines, self.others, strict=True):
                line.pid = int(other["pid"]) if other["host"] == me["host"] else 0
                line.send({"order": "hello", **me}, {})

    def _to(self, rank: int) -> MpiLine:
        other = f"rank {rank} of {self._name}"
        return MpiLine("", f"{self._name} 0", other, rank, 0, self._between)

    def about_others(self) -> list[dict[str, Any]]:
        """What the coupler needs to watch the ranks other than 0."""
        keys = ("pid", "host", "shared", "stack")
        return [{key: other[key] for key in keys} for other in self.others]

    def lead(self, line: Line) -> LeadingLine:
        """Make the line of rank 0, from its line to the coupler."""
        return LeadingLine(line, self._lines, [str(other["host"]) for other in self.others])

    def follow(self) -> FollowingLine:
        """Make the line of another rank."""
        return FollowingLine(self._lines[0], self.rank)


def rank_in_job() -> int:
    """Number of this process among those of its launcher; 0 where that cannot be told."""
    for name in ("PMI_RANK", "PMIX_RANK", "OMPI_COMM_WORLD_RANK", "SLURM_PROCID"):
        if name in os.environ:
            return int(os.environ[name])
    return 0
