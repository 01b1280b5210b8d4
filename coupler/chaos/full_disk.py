"""A disk that is full for a few pieces of the run's files."""

import errno
import os
from collections.abc import Callable
from pathlib import Path

from quintet.coupler.files.disk import Writing


class FullDisk:
    """Refuses pieces of files as a full disk does.

    Parameters
    ----------
    tell : function
        Called with what happened.
    """

    def __init__(self, tell: Callable[[str], None]) -> None:
        self._tell, self._left, self._before = tell, 0, Writing.begin
        Writing.begin = staticmethod(self._begin)

    def fill(self, pieces: int) -> None:
        """Refuse so many pieces from now on."""
        self._left += pieces

    def close(self) -> None:
        """Refuse nothing more."""
        Writing.begin = staticmethod(self._before)

    def _begin(self, path: Path) -> None:
        if self._left:
            self._left -= 1
            self._tell(f"the disk is full for {path.name}")
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), str(path))
