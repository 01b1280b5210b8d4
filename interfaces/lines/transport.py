"""A line joins one component to the coupler; every wait on it has a deadline.

``Line`` is what the coupler and the serving loop see. ``FramedLine`` adds to a carrier of
bytes what must hold on any: sequence numbers, the run's name, and a watch on the other side.
"""

import os
import time
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from typing import Any, Protocol, TypeVar

from quintet.interfaces.component import Fields
from quintet.interfaces.errors import LineError
from quintet.interfaces.lines.message import Frame, Message, Shapes, decode, encode

T = TypeVar("T")

SPIN = 3e-4  # s of asking without sleep: longer than a round trip, shorter than any step
NAP = 2e-5  # s, the first sleep
LONGEST_NAP = 1e-3  # s
SETTLING = 0.05  # s from a connection's end until the system knows how the process ended


class Line(Protocol):
    """One end of a connection between a component and the coupler."""

    def send(self, header: Mapping[str, Any], fields: Fields) -> None:
        """Hand over a message; returns when its arrays may be changed again."""

    def receive(self, seconds: float, expected: Shapes | None = None) -> Message:
        """Wait for the next message, at most so long."""

    def close(self) -> None:
        """Let go; safe to call twice."""


def wait(poll: Callable[[], T | None], seconds: float, broken: Callable[[], str]) -> T:
    """Ask until something comes: first without sleep, then with naps that grow.

    Never blocks in a library: with more processes than cores a blocking wait of MPI spins and
    takes the core that a solver needs, and one of zenoh knows no deadline.
    """
    start = time.perf_counter()
    nap = NAP
    while True:
        found = poll()
        if found is not None:
            return found
        waited = time.perf_counter() - start
        if waited < SPIN:
            os.sched_yield()
            continue
        reason = broken()
        if reason:
            found = poll()  # what was sent before the break still counts
            if found is not None:
                return found
            raise LineError(reason)
        if waited > seconds:
            raise LineError(f"nothing arrived within {seconds:.1f} s")
        time.sleep(nap)
        nap = min(1.3 * nap, LONGEST_NAP)


class FramedLine(ABC):
    """A line over a carrier of bytes: numbered messages of one run, in order, none missing."""

    def __init__(self, run: str, name: str) -> None:
        self.run = run  # "" until the coupler has told it
        self.name = name  # who sends
        self.watch: Callable[[], str] = lambda: ""  # why an answer will not come, if known
        self._sent = 0
        self._received = 0
        self._scratch: bytearray | None = None

    def send(self, header: Mapping[str, Any], fields: Fields) -> None:
        """See `Line.send`."""
        stamped = {**header, "run": self.run, "from": self.name, "seq": self._sent}
        self._scratch = encode(stamped, fields, self._scratch)
        self._sent += 1
        self._put(self._scratch)

    def receive(self, seconds: float, expected: Shapes | None = None) -> Message:
        """See `Line.receive`."""
        message = decode(wait(self._poll, seconds, self._reason), expected)
        seq, run = message.header.get("seq"), message.header.get("run")
        if seq != self._received:
            raise LineError(
                f"message {self._received} was expected, message {seq} arrived: messages were "
                "lost or repeated. Nothing can be recovered; run again from the last snapshot."
            )
        self._received += 1
        self.run = self.run or str(run)
        if run != self.run and run != "":
            raise LineError(f"a message of run {run!r} arrived in run {self.run!r}.")
        return message

    def _reason(self) -> str:
        gone = self._broken()
        if gone:
            time.sleep(SETTLING)
        return self.watch() or gone

    @abstractmethod
    def _put(self, frame: bytearray) -> None:
        """Send a frame; the buffer is free again on return."""

    @abstractmethod
    def _poll(self) -> Frame | None:
        """Return the next frame if it has come."""

    @abstractmethod
    def _broken(self) -> str:
        """Say why the other side cannot answer any more, or ""."""

    @abstractmethod
    def close(self) -> None:
        """Let go of the carrier."""
