"""Memory for frames that arrive, used again once no array of a message is a view of it.

New memory costs more than the message: the system clears every page.
"""

import sys
from collections.abc import Sequence

import numpy as np

from quintet.interfaces.component import Array

KEPT = 4  # frames kept for the next messages


class FrameBuffers:
    """The last few frames of a line."""

    def __init__(self) -> None:
        self._frames: list[Array] = []

    def take(self, size: int) -> Array:
        """Return a frame (size,) u1 that is not referenced any more, or a new one."""
        for number, references in enumerate(_references(self._frames)):
            if len(self._frames[number]) == size and references == UNREFERENCED:
                return self._frames[number]
        frame = np.empty(size, np.uint8)
        self._frames = [*self._frames[1 - KEPT :], frame]
        return frame


def _references(frames: Sequence[Array]) -> list[int]:
    """References to each frame, those of this count included."""
    return [sys.getrefcount(frame) for frame in frames]


# Versions of Python count differently: 3.14 counts no argument of a call.
UNREFERENCED = _references([np.empty(0, np.uint8)])[0]
