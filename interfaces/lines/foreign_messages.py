"""Messages from outside a run, which are counted and dropped."""

import threading
import time
from dataclasses import dataclass, field
from typing import Any

from quintet.interfaces.lines.frame_codes import REPEATED, DroppedFrames

OUTSIDE = "quintet/**"  # all keys of quintet but those with a verbatim part
TOO_MANY = 1000  # messages between two looks, after which nobody listens to more for a while
DEAF = 5.0  # s


@dataclass
class ForeignMessages:
    """Messages and requests that came from outside a run.

    Their contents are not kept. Where too many come, the subscription is given up for a while:
    zenoh drops them then without work for this process.
    """

    session: Any
    frames: DroppedFrames = field(default_factory=DroppedFrames)  # on keys of the run
    count: int = 0  # messages on other keys
    refused: int = 0  # requests to join
    first: str = ""  # of the messages
    reason: str = ""  # why the last request to join was refused
    at_least: bool = False
    _lock: threading.Lock = field(default_factory=threading.Lock)
    _subscription: Any = None
    _reported: int = 0
    _report_at: float = 0.0
    _listen_at: float = 0.0

    def look(self) -> str:
        """Return what the user should know now; called many times a second."""
        # Imported by runs over zenoh only.
        from zenoh import handlers

        now = time.monotonic()
        if self._subscription is None:
            if now >= self._listen_at:
                # Not a function: its thread would still run as Python ends, and abort the process.
                self._subscription = self.session.declare_subscriber(
                    OUTSIDE, handlers.RingChannel(TOO_MANY + 1)
                )
        elif self._count_new() > TOO_MANY:
            self._subscription.undeclare()
            self._subscription, self._listen_at = None, now + DEAF
            self.at_least = True
        number = self.count + self.refused + self.frames.count()
        if number == self._reported or now < self._report_at:
            return ""
        self._reported, self._report_at = number, now + REPEATED
        return "; ".join(self.summary())

    def summary(self) -> list[str]:
        """What came so far, in sentences."""
        texts = []
        if self.count:
            number = f"{'at least ' * self.at_least}{self.count}"
            texts.append(
                f"{number} message(s) from outside the run were dropped; the first: {self.first}. "
                "The run is not affected. End the program that sends them, or use another endpoint."
            )
        if self.refused:
            texts.append(f"{self.refused} request(s) to join were refused; the last: {self.reason}")
        return texts + self.frames.summary()

    def _count_new(self) -> int:
        """Count what came since the last look, up to `TOO_MANY` + 1."""
        number = 0
        while number <= TOO_MANY and (sample := self._subscription.try_recv()) is not None:
            if not self.first:
                size = len(sample.payload.to_bytes())
                self.first = f"{size} bytes to {printable(str(sample.key_expr))}"
            number += 1
        self.count += number
        return number

    def refuse(self, reason: str) -> str:
        """Count a request to join that is refused."""
        with self._lock:
            self.refused += 1
            self.reason = reason
        return reason


def printable(text: str) -> str:
    """A text from outside, short and without what a terminal or an encoding takes for its own."""
    return "".join(sign if sign.isprintable() else "?" for sign in text[:80])
