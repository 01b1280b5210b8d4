"""Lines between a component and the coupler, with a deadline on every wait.

``Line`` is the interface for the coupler and the serving loop. ``FramedLine`` adds to any
transport of bytes sequence numbers, the name of the run, and a watch on the other side.

A message that arrives twice is used once. A lost one is sent again where a line is set to do so:
the coupler repeats an order that is not answered, and a component that has answered it already
repeats its answer. A gap in the sequence is an error.
"""

import math
import os
import reprlib
import time
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from typing import Any, Protocol, TypeVar

from quintet.interfaces.component import Fields
from quintet.interfaces.errors import LineError, LostMessage, MessageError
from quintet.interfaces.lines.message import (
    UNLIMITED,
    Frame,
    Message,
    Shapes,
    decode,
    encode,
    header_of,
)

T = TypeVar("T")

SPIN = 3e-4  # s of polling without sleep: longer than a round trip, shorter than any step
SLEEP = 2e-5  # s, the first sleep
LONGEST_SLEEP = 1e-3  # s
SETTLING = 0.5  # s from a connection's end within which the system knows how the process ended
REPEAT = 5.0  # s without an answer until the last message is sent again; then 10 s, and so on


class Line(Protocol):
    """One end of a connection between a component and the coupler."""

    def send(self, header: Mapping[str, Any], fields: Fields) -> None:
        """Send a message; its arrays may be changed after the call."""

    def receive(self, seconds: float, expected: Shapes | None = None) -> Message:
        """Receive the next message within a number of seconds."""

    def close(self) -> None:
        """Close the line; a second call does nothing."""


class WatchedLine(Line, Protocol):
    """The coupler's end of a line."""

    watch: Callable[[], str]  # why an answer will not come, if known

    def peek(self) -> Frame | None:
        """Return the next frame if it has arrived; it stays the next to be received."""


def wait(poll: Callable[[], T | None], seconds: float, broken: Callable[[], str]) -> T:
    """Poll until there is a result: first without sleep, then with growing sleeps.

    Never blocks in a library: with more processes than cores a blocking wait of MPI spins and
    takes the core that a solver needs, and one of zenoh knows no deadline.
    """
    start = time.perf_counter()
    pause = SLEEP
    while True:
        message = poll()
        if message is not None:
            return message
        waited = time.perf_counter() - start
        if waited < SPIN:
            os.sched_yield()
            continue
        reason = broken()
        if reason:
            message = poll()  # what was sent before the break still counts
            if message is not None:
                return message
            raise LineError(reason)
        if waited > seconds:
            raise LineError(f"nothing arrived within {seconds:.1f} s")
        time.sleep(pause)
        pause = min(1.3 * pause, LONGEST_SLEEP)


def unknown() -> str:
    """Why an answer will not come, where nobody watches the other side."""
    return ""


class FramedLine(ABC):
    """A line over a transport of bytes: numbered messages of one run, in order and complete."""

    limit = UNLIMITED  # bytes of a frame
    room = 0  # bytes behind a frame for what the transport adds

    def __init__(self, run: str, name: str) -> None:
        self.run = run  # "" until the first message of the coupler
        self.name = name  # who sends
        self.watch: Callable[[], str] = unknown  # why an answer will not come, if known
        self.repeat_after = math.inf  # s without an answer until the last message is sent again
        self.answers_again = False  # whether to do so when the other side repeats its last message
        self._repeat_at, self._pause = math.inf, math.inf  # s
        self._sent = 0
        self._received = 0
        self._scratch: bytearray | None = None
        self._ahead: Frame | None = None  # looked at, not yet received

    def send(self, header: Mapping[str, Any], fields: Fields) -> None:
        """See `Line.send`."""
        self._scratch = encode(
            header, fields, self._scratch, self.limit, self.room, run=self.run, seq=self._sent
        )
        self._sent += 1
        self._pause = self.repeat_after
        self._repeat_at = time.monotonic() + self._pause
        self._put(self._scratch)

    def receive(self, seconds: float, expected: Shapes | None = None) -> Message:
        """See `Line.receive`."""
        message = None
        while message is None:
            message = self._decode(wait(self._next, seconds, self._reason), expected)
        seq, run = message.header.get("seq"), message.header.get("run")
        if seq != self._received:
            raise LostMessage(
                f"message {self._received} was expected, message {reprlib.repr(seq)} arrived: "
                "messages were lost. Run again from the last snapshot, or set `restarts`."
            )
        self._received += 1
        if not isinstance(run, str):
            raise LineError(f"a message names its run; found {reprlib.repr(run)}.")
        self.run = self.run or run
        if run != self.run and run != "":
            raise LineError(f"a message of run {reprlib.repr(run)} arrived in run {self.run!r}.")
        return message

    def peek(self) -> Frame | None:
        """Return the next frame if it has arrived; it stays the next to be received."""
        while self._ahead is None and (frame := self._poll()) is not None:
            if not self._is_old(frame):
                self._ahead = frame
        return self._ahead

    def _decode(self, frame: Frame, expected: Shapes | None) -> Message | None:
        """Decode a frame; None where it is an old one, which may have any shapes."""
        try:
            message = decode(frame, expected)
        except MessageError:
            if not self._is_old(frame):
                raise
            message = None
        if message is not None:
            seq = message.header.get("seq")
            if seq == self._received or not self._was_received(message.header):
                return message
        if self.answers_again and self._was_last(frame) and self._scratch is not None:
            self._put(self._scratch)
        return None

    def _is_old(self, frame: Frame) -> bool:
        """Whether a frame was received before."""
        try:
            return self._was_received(header_of(frame))
        except MessageError:
            return False

    def _was_received(self, header: Mapping[str, Any]) -> bool:
        seq = header.get("seq")
        return (
            type(seq) is int and 0 <= seq < self._received and header.get("run") in ("", self.run)
        )

    def _was_last(self, frame: Frame) -> bool:
        """Whether an old frame is the one that was received last."""
        return bool(header_of(frame)["seq"] == self._received - 1)

    def _repeat(self) -> None:
        """Send the last message again if its answer does not come."""
        now = time.monotonic()
        if now > self._repeat_at and self._scratch is not None:
            self._pause *= 2.0
            self._repeat_at = now + self._pause
            self._put(self._scratch)

    def _next(self) -> Frame | None:
        frame, self._ahead = self._ahead, None
        return self._poll() if frame is None else frame

    def _reason(self) -> str:
        self._repeat()
        if not (broken := self._broken()):
            return self.watch()
        limit = time.monotonic() + SETTLING
        while not (ending := self.watch()):
            if self.watch is unknown or time.monotonic() > limit:
                break
            time.sleep(0.01)
        return ending or broken

    @abstractmethod
    def _put(self, frame: bytearray) -> None:
        """Send a frame and the room behind it; its buffer may be reused after the call."""

    @abstractmethod
    def _poll(self) -> Frame | None:
        """Return the next frame if it has arrived."""

    @abstractmethod
    def _broken(self) -> str:
        """Return why the other side cannot answer any more, or ""."""

    @abstractmethod
    def close(self) -> None:
        """Close the transport."""
