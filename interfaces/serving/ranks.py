"""A component of several MPI ranks: rank 0 leads, the others follow.

Rank 0 holds the line to the coupler and passes every order on, with the rows that each rank needs.
All ranks carry it out, and rank 0 alone answers. If another rank fails, a thread of rank 0 tells
the coupler, for the solver of rank 0 may be waiting for that rank.
"""

import os
import threading
import time
from collections.abc import Collection, Mapping
from typing import Any

from quintet.interfaces.component import Fields
from quintet.interfaces.errors import QuintetError
from quintet.interfaces.lines.message import Message, Shapes
from quintet.interfaces.lines.mpi import MpiLine, communicator_of
from quintet.interfaces.lines.transport import Line
from quintet.interfaces.serving.following import FAILURES, TELLING, WHOSE, FollowingLine
from quintet.interfaces.serving.rank_rows import ORDERS, first_not_finite, with_rows
from quintet.interfaces.serving.serve import LONGEST_WAIT, is_trial

LOOKING = 0.05  # s between two looks at what other ranks say
DECIDING = 0.5  # s for rank 0 to fail at the same order as another rank
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
        self._needed: dict[int, Fields] = {}  # rows of ports taken, by rank
        self._computes: dict[int, bool | None] = {}  # whether a rank has given a row, by rank
        self._checks = False  # whether the answer to the last order may name a rank
        self._lock = threading.Lock()
        threading.Thread(target=self._watch, name="ranks", daemon=True).start()

    def receive(self, seconds: float, expected: Shapes | None = None) -> Message:
        """Receive an order, and pass it on."""
        message = self._line.receive(seconds, expected)
        self._checks = message.order in ("give", "advance") and not is_trial(message)
        if message.order in ORDERS:
            self._wait_for_all(self._needed, LONGEST_WAIT)
        for rank, line in enumerate(self._others, 1):
            line.send(*with_rows(message, self._needed.get(rank, {})))
        self._orders += 1
        return message

    def _wait_for_all(self, answers: Collection[Any], seconds: float) -> None:
        """Wait until all other ranks have answered, or one of them has failed."""
        limit = time.monotonic() + seconds
        while len(answers) < len(self._others) and time.monotonic() < limit and not self._over:
            time.sleep(LOOKING)

    def send(self, header: Mapping[str, Any], fields: Fields) -> None:
        """Answer for all ranks."""
        if header["order"] in FAILURES and MPI_ERROR in header["traceback"]:
            time.sleep(NOTICING)  # most likely another rank has died: the coupler names that one
        if "memory" in header:
            header = self._of_all(header)
        if self._checks and (place := first_not_finite(fields)):
            header = {**header, **self._giver(*place)}
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
        self._wait_for_all(self._used, TELLING)
        used = [header, *self._used]
        return {**header, **{key: sum(rank[key] for rank in used) for key in ("memory", "cpu")}}

    def _giver(self, key: str, row: int) -> dict[str, str]:
        """Name the rank that computed a row, if the component can tell."""
        for line in self._others:
            line.send({"order": WHOSE, "key": key, "row": row}, {})
        self._wait_for_all(self._computes, DECIDING)
        for rank, answer in sorted(self._computes.items()):
            if answer:
                return {"giver": f"rank {rank} on {self._hosts[rank - 1]}"}
        of_others = list(self._computes.values())
        if None in of_others or len(of_others) < len(self._others):
            return {}
        return {"giver": f"rank 0 on {os.uname().nodename}"}

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
            for rank, line in enumerate(self._others, 1):
                try:
                    if line.peek() is not None:
                        self._hear(line.receive(LOOKING), rank)
                except QuintetError:  # it is dead, which the coupler sees
                    return

    def _hear(self, report: Message, rank: int) -> None:
        """Note what a rank says; report its failure, unless this one fails at the same order."""
        header = report.header
        match report.order:
            case "used":
                self._used.append(header)
            case "needed":
                self._needed[rank] = report.fields
            case "computes":
                self._computes[rank] = header["computes"]
            case _:
                self._hear_failure(header, self._hosts[rank - 1])

    def _hear_failure(self, header: Mapping[str, Any], host: str) -> None:
        limit = time.monotonic() + DECIDING
        while self._answered < int(header["at"]) and time.monotonic() < limit:
            time.sleep(LOOKING)
        with self._lock:
            if self._over or self._failed_at >= int(header["at"]):
                return
            self._over = True
            text = f"rank {header['rank']} on {host}: {header['text']}"
            self._line.send({**header, "order": "failed", "text": text}, {})


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
        keys = ("pid", "host", "numbering", "shared", "stack")
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
