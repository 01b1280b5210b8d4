"""Messages over zenoh that are dropped, duplicated and corrupted, below all checks."""

from collections import deque
from typing import Any

from quintet.coupler.chaos.plan import BEFORE, Fault
from quintet.interfaces.lines.zenoh import ZenohLine

REPEAT = 1.0  # s without an answer until an order is sent again: sooner than in other runs


class Wire:
    """What carries the messages of a component, whichever process it is at the time."""

    def __init__(self) -> None:
        self._order: Fault | None = None  # disturbs the next order
        self._answer: Fault | None = None

    def attach(self, line: ZenohLine) -> None:
        """Carry the messages of a line from now on."""
        line.disturb(lambda outbox: Outbox(outbox, self), lambda inbox: Inbox(inbox, self))
        line.repeat_after = min(line.repeat_after, REPEAT)

    def disturb(self, fault: Fault) -> None:
        """Disturb the next order, or the answer to it."""
        if fault.moment == BEFORE:
            self._order = fault
        else:
            self._answer = fault

    def sent(self, frame: bytes | bytearray) -> list[bytes]:
        """What arrives of an order."""
        fault, self._order = self._order, None
        return disturbed(bytes(frame), fault)

    def received(self, frame: bytes) -> list[bytes]:
        """What arrives of an answer."""
        fault, self._answer = self._answer, None
        return disturbed(frame, fault)


def disturbed(frame: bytes, fault: Fault | None) -> list[bytes]:
    """What arrives of a frame."""
    match fault and fault.kind:
        case "drop":
            return []
        case "duplicate":
            assert fault
            return [frame] * int(fault.amount)
        case "corrupt":
            assert fault
            return [flipped(frame, fault.amount)]
        case _:
            return [frame]


def flipped(frame: bytes, place: float) -> bytes:
    """Flip a bit at a place, a share of the frame below 1."""
    bit = int(place * 8 * len(frame))
    copy = bytearray(frame)
    copy[bit // 8] ^= 1 << bit % 8
    return bytes(copy)


class Outbox:
    """In the place of zenoh's publisher."""

    def __init__(self, outbox: Any, wire: Wire) -> None:
        self._outbox, self._wire = outbox, wire

    @property
    def matching_status(self) -> Any:
        """Whether somebody receives."""
        return self._outbox.matching_status

    def put(self, frame: bytes | bytearray, **more: Any) -> None:
        """Send the rest of a frame."""
        for copy in self._wire.sent(frame):
            self._outbox.put(copy, **more)

    def undeclare(self) -> None:
        """Send nothing more."""
        self._outbox.undeclare()


class Inbox:
    """In the place of zenoh's subscriber."""

    def __init__(self, inbox: Any, wire: Wire) -> None:
        self._inbox, self._wire = inbox, wire
        self._arrived: deque[Sample] = deque()

    def try_recv(self) -> "Sample | None":
        """Return what has arrived next, if anything has."""
        while not self._arrived and (sample := self._inbox.try_recv()) is not None:
            for frame in self._wire.received(sample.payload.to_bytes()):
                self._arrived.append(Sample(frame, sample.attachment))
        return self._arrived.popleft() if self._arrived else None

    def undeclare(self) -> None:
        """Receive nothing more."""
        self._inbox.undeclare()


class Sample:
    """A message as zenoh hands it out; it is its own payload."""

    def __init__(self, frame: bytes, attachment: Any) -> None:
        self._frame, self.attachment = frame, attachment

    @property
    def payload(self) -> "Sample":
        """Its content."""
        return self

    def to_bytes(self) -> bytes:
        """Bytes of it."""
        return self._frame
