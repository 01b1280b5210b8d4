"""One component as the run loop sees it, wherever it runs."""

import statistics
import sys
import time
from collections import deque
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from quintet.coupler.coupling.answers import AnswerSums, check_answer, check_outputs
from quintet.interfaces.component import Array, Field, Fields
from quintet.interfaces.errors import LineError, MessageError, QuintetError, SceneError
from quintet.interfaces.lines.message import Message, Shapes, order_of, require_finite
from quintet.interfaces.lines.transport import WatchedLine
from quintet.interfaces.serving.failing import sendable

BEFORE = {
    "",
    "go",
    "describe",
    "sample",
    "bind",
    "begin",
    "prime",
}  # orders in which a scene is refused
LONGEST_WAIT = 86400.0  # s for one answer, also of a component that nobody watches


class ComponentFailed(QuintetError):
    """A component, or the line to it, failed: who, in which window, why.

    Where an item was at fault, `place` (3,) m is where, and `shown` what there is to see.
    """

    def __init__(self, component: str, window: int, cause: str, trace: str = "") -> None:
        self.component, self.window, self.cause, self.trace = component, window, cause, trace
        self.place: Array = np.full(3, np.nan)
        self.shown: Fields = {}
        self.units: dict[str, str] = {}
        super().__init__(f"{component} failed in window {window}: {cause}")

    def look(self, message: Message) -> None:
        """Take what the component showed with its failure, if that is well-formed."""
        place, units = message.header.get("place"), message.header.get("units")
        if not isinstance(place, list) or not isinstance(units, dict) or len(place) != 3:
            return
        if all(type(number) in (int, float) for number in place):
            self.place, self.shown = np.array(place, float), message.fields
            self.units = {str(key): str(unit) for key, unit in units.items()}


class TrialFailed(QuintetError):
    """A component could not do a trial window; it will come back to the state before."""


@dataclass(slots=True)
class Timing:
    """Where a component's time went."""

    compute: float = 0.0  # s, as the component itself measured
    cpu: float = 0.0  # s of processor time in its windows, all threads and ranks
    wait: float = 0.0  # s that the coupler waited for it
    build: float = 0.0  # s of its construction, with what that compiles
    prepare: float = 0.0  # s, what it did before its first window, such as compiling
    first: float = 0.0  # s, its first window
    steps: int = 0
    windows: int = 0  # that were ordered, repetitions counted
    items: int = 0
    memory: int = 0  # bytes, the most that its processes held; of one apart that ended well
    recent: deque[float] = field(default_factory=lambda: deque(maxlen=50))

    @property
    def usual(self) -> float:
        """Its usual time for a window [s]."""
        return statistics.median(self.recent) if self.recent else 0.0


class Waiting:
    """A time in which the coupler waits for a component, for who watches it meanwhile."""

    __slots__ = ("note", "since")

    def __init__(self) -> None:
        self.since = 0.0  # s of the monotonic clock; 0 while nobody waits
        self.note: Callable[[float], None] | None = None  # who else is told

    def __enter__(self) -> None:
        self.since = time.monotonic()
        if self.note:
            self.note(self.since)

    def __exit__(self, *_: object) -> None:
        self.since = 0.0
        if self.note:
            self.note(0.0)


class Participant:
    """A component behind a line: orders go out, answers come back checked."""

    def __init__(self, name: str, line: WatchedLine) -> None:
        self.name, self.line = name, line
        self.components = {name: self}
        self.order = ""  # the last that it got
        self.built = False  # whether it has answered an order
        self.keeping_others_waiting = Waiting()
        # What ended the run meanwhile, if a watch has ended it.
        self.verdict: Callable[[], BaseException | None] = lambda: None
        self.window = 0  # the next
        self.stable = 0.0  # s, largest step from its present state
        self.timing = Timing()
        self.notes: list[str] = []  # what the user should read of it
        self.shapes: Shapes | None = None  # of its outputs, once known
        self.sums: AnswerSums | None = None  # of which its answers tell, once its ports are joined
        self.asked = time.perf_counter()  # s, when it got its last order, or was made
        self._answered = True  # whether the answer to the last order was received
        self._looked_at = False  # whether it has arrived, and tells of no failure
        self._kept: dict[int, tuple[int, float]] = {}  # window and stable step, by depth
        self.trial = False  # whether its windows are a trial, undone afterwards
        self.window_order: tuple[dict[str, Any], Fields] = ({}, {})  # the last of a window

    def send_order(self, order: str, fields: Fields | None = None, **header: Any) -> None:
        """Send an order."""
        self.asked = time.perf_counter()
        self.order, self._answered, self._looked_at = order, False, False
        if self.trial:
            header["trial"] = True
        header, fields = {"order": order, "window": self.window, **header}, fields or {}
        if order == "advance":
            self.window_order = header, fields
        try:
            with self.keeping_others_waiting:
                self.line.send(header, fields)
        except (LineError, MessageError) as error:
            raise self._failure(error) from error

    def receive(self, expected: Shapes | None = None, finite: bool = True) -> Message:
        """Wait for the answer."""
        try:
            with self.keeping_others_waiting:
                message = self.line.receive(LONGEST_WAIT, expected)
            failed = message.order == "failed"
            if self.trial and message.order == "unable":
                self._answered = True
                cause = f"{message.header.get('error')}: {message.header.get('text')}"
                raise TrialFailed(f"{self.name}: {sendable(cause)}")
            if not failed:
                check_answer(self.order, message)
                if self.sums and self.order == "advance":
                    self.sums.check(message)
            if finite and not failed:
                giver = message.header.get("giver")  # the rank, of a component of several
                giver = sendable(str(giver)) if giver else "it"
                require_finite(message.fields, f"what {giver} gave")
        except MessageError as error:
            if self.trial:
                self._answered = True
                raise TrialFailed(f"{self.name}: {error}") from error
            raise self._failure(error) from error
        except LineError as error:
            raise self._failure(error) from error
        self._answered = self.built = True
        if failed:
            text = sendable(str(message.header.get("text")))
            if message.header.get("error") == SceneError.__name__ and self.order in BEFORE:
                # It has not begun: the scene is refused, by who knows the rule.
                raise SceneError(f"components.{self.name}: {text}")
            cause = f"{sendable(str(message.header.get('error')))}: {text}"
            trace = sendable(str(message.header.get("traceback", "")))
            failure = ComponentFailed(self.name, self.window, cause, trace)
            failure.look(message)
            raise failure
        return message

    def _failure(self, error: QuintetError) -> BaseException:
        return self.verdict() or ComponentFailed(self.name, self.window, str(error))

    def has_failed(self) -> bool:
        """Whether the answer that has arrived, but was not yet asked for, tells of a failure."""
        if self._answered or self._looked_at or (frame := self.line.peek()) is None:
            return False
        self._looked_at = True
        try:
            return order_of(frame) == "failed"
        except MessageError:  # as whoever receives it will say
            return True

    def await_hello(self, seconds: float, connect: Callable[[float], None]) -> Message:
        """Wait until the component has connected, and for its first message."""
        try:
            with self.keeping_others_waiting:
                connect(seconds)
                return self.line.receive(seconds)
        except (LineError, MessageError) as error:
            cause = f"did not join: {error}"
            raise self.verdict() or ComponentFailed(self.name, 0, cause) from error

    def wait_for_replay(self, built: bool) -> None:
        """Begin the present wait again: another process takes over, built already or not."""
        self.built = built
        self.keeping_others_waiting.__enter__()

    def call(self, order: str, fields: Fields | None = None, **header: Any) -> Message:
        """Send an order and wait for the answer."""
        self.send_order(order, fields, **header)
        return self.receive()

    def sample(self, request: Fields) -> Fields:
        """Ask for samples of its surface, before its ports are joined."""
        return self.call("sample", request).fields

    def bind(self, static: Fields, **header: Any) -> None:
        """Join its ports: who reads what, and with what forces do work."""
        answer = self.call("bind", static, **header)
        self.timing.items = int(answer.header["items"])

    def order_prepare(self) -> None:
        """Order that it compile, or whatever else it does before its first step; no limit holds."""
        self.built = False
        self.send_order("prepare")

    def prepared(self) -> None:
        """Wait until that is done."""
        header = self.receive().header
        self.stable, self.timing.prepare = float(header["stable"]), float(header["seconds"])

    def prime(self, fields: Fields, **header: Any) -> None:
        """Tell it what holds as the run begins."""
        self._note(self.call("prime", fields, **header))

    def _note(self, message: Message) -> None:
        """Show the user what it has to say."""
        for note in message.header.get("notes", ()):
            self.notes.append(str(note))
            print(f"quintet: note of {self.name}: {note}", file=sys.stderr, flush=True)

    def start(self, dt: float, fields: Fields, ends: list[str], **header: Any) -> None:
        """Order the next window, of a length `dt` [s]."""
        self.send_order("advance", fields, dt=dt, ends=ends, **header)

    def finish(self) -> Message:
        """Wait for the end of the window that was ordered."""
        message = self.receive(self.shapes)
        took = time.perf_counter() - self.asked
        timing, header = self.timing, message.header
        self.stable = float(header["stable"])
        self.window += 1
        if not self.trial and not timing.windows:
            timing.recent.clear()
        if not self.trial or not timing.windows:  # of pieces of windows, until a whole one is known
            timing.recent.append(took)
        if self.trial:
            return message
        timing.first = timing.first or took
        timing.wait += took
        timing.compute += float(header["busy"])
        timing.cpu += float(header["cpu"])
        timing.steps += int(header["steps"])
        timing.windows += 1
        self._note(message)
        return message

    def give(
        self, wanted: Iterable[str] | None = None, gives: Mapping[str, Field] | None = None
    ) -> dict[str, Array]:
        """Ask for the outputs at the start, and remember their shapes."""
        fields = self.call("give").fields
        try:
            if wanted is not None and gives is not None:
                check_outputs(fields, wanted, gives)
        except MessageError as error:
            raise ComponentFailed(self.name, self.window, str(error)) from error
        self.shapes = {key: array.shape for key, array in fields.items()}
        return fields

    def final_warnings(self) -> dict[str, str]:
        """Ask for the warnings that only the whole run can justify, by subject."""
        return dict(self.call("conclude").header["warnings"])

    @property
    def answered(self) -> bool:
        """Whether it has answered the last order."""
        return self._answered

    def order_keep(self, depth: int) -> None:
        """Order that the present state be kept, for couplings that repeat windows at a depth."""
        self._kept[depth] = self.window, self.stable
        self.send_order("keep", depth=depth)

    def order_rewind(self, depth: int, last: bool = False) -> None:
        """Order that it come back to the state that was kept; for the last time it forgets it."""
        self.send_order("rewind", depth=depth, last=last)
        self.window, self.stable = self._kept[depth]

    def save(self) -> dict[str, Array]:
        """Ask for all state; it may hold what is not finite, as a limit that was not met yet."""
        self.send_order("save")
        return self.receive(finite=False).fields

    def begin_from(self, state: Fields, goes_on: bool = False) -> None:
        """Have it begin from a state of another run, of which it may go on with the inputs."""
        answer = self.call("begin", state, goes_on=goes_on)
        if goes_on:
            self.stable = float(answer.header["stable"])

    def load(self, state: Fields, window: int) -> None:
        """Bring it to a saved state, after so many windows."""
        self.window = window
        self.stable = float(self.call("load", state).header["stable"])


def describe_all(participants: Mapping[str, Participant]) -> dict[str, Fields]:
    """Ask every component for its static fields."""
    described: dict[str, Fields] = {}
    for name, participant in participants.items():
        answer = participant.call("describe")
        participant.timing.build = float(answer.header["seconds"])
        described[name] = answer.fields
    return described


def finish_all(participants: Mapping[str, Participant]) -> None:
    """Order every component to finish, and await its answer."""
    for participant in participants.values():
        participant.send_order("finish")
    for participant in participants.values():
        used = participant.receive().header
        participant.timing.memory = int(used["memory"])
        participant.timing.cpu += float(used["cpu"])
