"""A rank of a component that carries out orders and does not answer the coupler."""

from collections.abc import Mapping
from typing import Any

from quintet.interfaces.component import Fields
from quintet.interfaces.lines.message import Message, Shapes
from quintet.interfaces.lines.mpi import MpiLine
from quintet.interfaces.serving.outputs import Outputs, Sums
from quintet.interfaces.serving.rank_rows import computes, needed_rows, with_all_rows
from quintet.interfaces.serving.serve import LONGEST_WAIT, Answer, Server

FAILURES = ("failed", "unable")  # answers of a rank that could not carry out an order
TELLING = 5.0  # s for all ranks to tell what they used
WHOSE = "whose"  # order of rank 0: does this rank compute a row?


class FollowingLine:
    """The line of another rank to rank 0; the coupler does not hear what it answers."""

    def __init__(self, line: MpiLine, rank: int) -> None:
        self._line, self._rank = line, rank
        self._orders, self._cpu = 0, 0.0
        self._needed: Fields = {}  # rows of ports taken

    def receive(self, seconds: float, expected: Shapes | None = None) -> Message:
        """Receive the next order."""
        message = self._line.receive(seconds, expected)
        if message.order != WHOSE:
            self._orders += 1
        return with_all_rows(message, self._needed)

    def send(self, header: Mapping[str, Any], fields: Fields) -> None:
        """Tell rank 0 of a failure, of rows, and at the end of what this rank used."""
        if header.get("needed"):
            self._needed = fields
            self._line.send({"order": "needed"}, fields)
        elif "computes" in header:
            self._line.send({**header, "order": "computes"}, {})
        elif header["order"] in FAILURES:
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

    def handle(self, message: Message) -> Answer:
        """Carry out an order, of the coupler or of rank 0."""
        if message.order == WHOSE:
            return {"computes": computes(self.component, message.header)}, {}
        return super().handle(message)

    def _bind(self, message: Message) -> Answer:
        super()._bind(message)
        return {"needed": True}, needed_rows(self.component)

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
