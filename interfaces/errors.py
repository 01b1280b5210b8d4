"""Every error that quintet raises on purpose, as one tree.

Each message says where, the rule, the value found, and what to do.
"""

from pathlib import Path
from typing import Any


class QuintetError(Exception):
    """Anything wrong that quintet noticed itself."""


class SceneError(QuintetError):
    """A scene that cannot run; carries all its mistakes, found before anything starts."""

    def __init__(self, mistakes: str | list[str]) -> None:
        self.mistakes = [mistakes] if isinstance(mistakes, str) else list(mistakes)
        super().__init__("\n".join(self.mistakes))


class PortError(QuintetError):
    """Fields that do not fit the port they are given to."""


class OrderError(QuintetError):
    """A component was asked for something it may not do at this point."""


class StepError(QuintetError):
    """A component cannot advance: no stable step, or a state that is not finite.

    Parameters
    ----------
    place : (3,) numbers, m, or None
        Where the item at fault is. What is around it is then written into the run's folder.
    """

    def __init__(self, text: str, place: Any = None) -> None:
        super().__init__(text)
        self.place = place


class MessageError(QuintetError):
    """Bytes that are not a valid message."""


class LineError(QuintetError):
    """A connection broke, lost a message, or stayed silent past its deadline."""


class LostMessage(LineError):
    """A message that was sent did not arrive, and a later one did."""


class DiskError(QuintetError):
    """A file that cannot be written: its disk is full, gone, or may only be read."""


class RunError(QuintetError):
    """A run that failed on the way; carries the folder with its results and logs."""

    def __init__(self, cause: str, folder: Path) -> None:
        super().__init__(cause)
        self.folder = folder


class LinkError(QuintetError):
    """Fields of two components that the link between them cannot carry."""
