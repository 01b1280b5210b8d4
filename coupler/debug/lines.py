"""Lines to components that do not compute, and lines of which the orders are kept."""

from collections.abc import Callable, Mapping
from typing import Any

from quintet.coupler.coupling.participant import LONGEST_WAIT
from quintet.coupler.files.recording import Recording
from quintet.coupler.launch.order_log import OrderLog
from quintet.interfaces.component import Component, Fields
from quintet.interfaces.errors import QuintetError
from quintet.interfaces.lines.message import Frame, Message, Shapes
from quintet.interfaces.lines.transport import WatchedLine

NOTHING_MOVED = {"first": {}, "moved": {}, "span": 0.0}
NOTHING_COUNTED: dict[str, Any] = {"sent": {}, "received": {}, "applied": {}, "totals": None}
NO_TIME = {"busy": 0.0, "cpu": 0.0, "steps": 1}


class NotRecorded(QuintetError):
    """The recording ends before a window whose outputs are needed."""


class RecordedLine:
    """A line to a recorded component: what it gave in the run is its answer to the same order.

    Parameters
    ----------
    name : str
    recording : Recording
        Of the run.
    replay : Component
        Of kind ``replay``, which describes and samples the recorded component.
    """

    def __init__(self, name: str, recording: Recording, replay: Component) -> None:
        self.watch: Callable[[], str] = lambda: ""
        self.name, self.recording, self.replay = name, recording, replay
        self.stable = recording.marks(name)["stable_steps"]  # (rows,) s
        self.row = 0
        self._order: Mapping[str, Any] = {}
        self._fields: Fields = {}

    def send(self, header: Mapping[str, Any], fields: Fields) -> None:
        """See `Line.send`; it is answered when the answer is asked for."""
        self._order, self._fields = header, fields

    def receive(self, seconds: float = LONGEST_WAIT, expected: Shapes | None = None) -> Message:
        """See `Line.receive`."""
        header, fields = self._answer(self._order["order"])
        return Message({"order": "done", **header}, dict(fields))

    def _answer(self, order: str) -> tuple[dict[str, Any], Fields]:
        match order:
            case "describe":
                return {"seconds": 0.0}, self.replay.describe()
            case "sample":
                return {}, self.replay.sample(self._fields)
            case "bind":
                return {"items": self.replay.items()}, {}
            case "give":
                return {}, self.recording.row(self.name, 0)
            case "prepare":
                return {"stable": float(self.stable[0]), "seconds": 0.0}, {}
            case "load":
                self.row = int(self._order["window"])
                return {"stable": float(self.stable[self.row])}, {}
            case "advance":
                return self._advance()
        return {}, {}

    def _advance(self) -> tuple[dict[str, Any], Fields]:
        if self.row + 1 >= len(self.stable):
            raise NotRecorded(f"the recording has nothing of {self.name} in window {self.row}")
        self.row += 1
        header = {**NOTHING_COUNTED, **NO_TIME, "inputs": NOTHING_MOVED}
        stable = float(self.stable[self.row])
        return {**header, "stable": stable}, self.recording.row(self.name, self.row)

    def peek(self) -> Frame | None:
        """See `FramedLine.peek`."""
        return None

    def close(self) -> None:
        """See `Line.close`."""


class LoggedLine:
    """A line that keeps the orders which pass it, with checksums of their answers."""

    def __init__(self, line: WatchedLine, log: OrderLog) -> None:
        self.watch: Callable[[], str] = lambda: ""
        self.line, self.log = line, log

    def send(self, header: Mapping[str, Any], fields: Fields) -> None:
        """See `Line.send`."""
        self.log.add(header, fields)
        self.line.send(header, fields)

    def receive(self, seconds: float, expected: Shapes | None = None) -> Message:
        """See `Line.receive`."""
        message = self.line.receive(seconds, expected)
        self.log.answered(message)
        return message

    def peek(self) -> Frame | None:
        """See `FramedLine.peek`."""
        return self.line.peek()

    def close(self) -> None:
        """See `Line.close`."""
        self.line.close()
