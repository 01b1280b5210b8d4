"""What may disturb a run on purpose, as the code knows it that is disturbed; usually nothing."""

from collections.abc import Callable
from typing import Any, Protocol

from quintet.interfaces.lines.transport import WatchedLine

Note = Callable[[int, float], None]  # of the windows done, and the simulated time [s]


class Disturbance(Protocol):
    """Disturbs a run, and tells how."""

    def line(self, name: str, line: WatchedLine, pids: Callable[[], list[int]]) -> WatchedLine:
        """Return the line through which the coupler reaches a component with some processes."""

    def wire(self, name: str, line: Any) -> None:
        """See to the messages of a component over zenoh, of every process that it has."""

    def noting(self, note: Note) -> Note:
        """Return what is called at the end of every window, in the place of a function."""

    def remark(self) -> str:
        """What to add to the cause of a failure."""

    def summary(self) -> dict[str, Any]:
        """What to add to the results."""

    def close(self) -> None:
        """Disturb nothing more; a second call does nothing."""


class Undisturbed:
    """Disturbs nothing."""

    def line(self, name: str, line: WatchedLine, pids: Callable[[], list[int]]) -> WatchedLine:
        """See `Disturbance.line`."""
        return line

    def wire(self, name: str, line: Any) -> None:
        """See `Disturbance.wire`."""

    def noting(self, note: Note) -> Note:
        """See `Disturbance.noting`."""
        return note

    def remark(self) -> str:
        """See `Disturbance.remark`."""
        return ""

    def summary(self) -> dict[str, Any]:
        """See `Disturbance.summary`."""
        return {}

    def close(self) -> None:
        """See `Disturbance.close`."""


UNDISTURBED = Undisturbed()
