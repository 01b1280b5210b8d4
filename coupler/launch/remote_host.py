"""The host of a component elsewhere, which may be out of reach for a while, or for good."""

import threading
import time
from dataclasses import dataclass, field

from quintet.interfaces.lines.line_elsewhere import LineElsewhere
from quintet.interfaces.lines.signs import SILENCE, SignsOfLife
from quintet.interfaces.lines.zenoh import Session, ZenohLine

SETTLING = 0.5  # s in which the end of a connection may arrive after its signs of life have ended
CLOSING = 2.0  # s


def line_to(session: Session, run: str, name: str) -> ZenohLine:
    """Return the coupler's end of a line to a component on another host."""
    return LineElsewhere(session, run, name)


@dataclass(slots=True)
class RemoteHost:
    """Whether there are signs of life from the host of a component.

    Parameters
    ----------
    line : ZenohLine
        To the component. Where its connection has ended, nothing is awaited from the host.
    """

    session: Session
    line: ZenohLine
    name: str = "its host"
    silent: float = 0.0  # s since the last sign of life; 0 while they come
    noticed_within: float = SILENCE + 2.0  # s
    _signs: SignsOfLife = field(init=False)
    _told_since: float = 0.0  # s of the monotonic clock: the beginning of the silence that was told

    def __post_init__(self) -> None:
        self._signs = SignsOfLife(self.session, self.line.other)

    def look(self, patience: float) -> str:
        """Return what the user should know now; called in every round of the watchdog."""
        silent = self._signs.silent_for()
        if silent < SILENCE + SETTLING or self.line.partner_has_left():
            silent = 0.0
        self.silent, now = silent, time.monotonic()
        if silent and not self._told_since:
            self._told_since = now - silent
            return f"{self.silence_text()}; the run waits up to {patience:g} s more for it"
        if self._told_since and not silent:
            lasted, self._told_since = now - self._told_since, 0.0
            return f"{self.name} gives signs of life again, after {lasted:.0f} s"
        return ""

    def silence_text(self) -> str:
        """How long the host is silent, in words."""
        return f"no sign of life from {self.name} for {self.silent:.0f} s"


def close_within(session: Session, seconds: float = CLOSING) -> None:
    """Close a session; leave it to itself where messages to a silent host hold it up."""
    closing = threading.Thread(target=session.close, daemon=True)
    closing.start()
    closing.join(seconds)
