"""Signals that end a run: SIGINT, SIGTERM, SIGHUP, and the end of the process that started it."""

import contextlib
import os
import signal
import sys
from collections.abc import Iterator
from types import FrameType

from quintet.coupler.launch.signal_handler import handled_by
from quintet.interfaces.lines.process_status import running
from quintet.interfaces.serving.process import STARTER


class StopRequest:
    """Whether a run should end early: a signal asked for it, or its starter ended."""

    asked = False

    def __init__(self) -> None:
        self._starter = int(os.environ.get(STARTER, "0"))  # process that cleans up after the run

    def __call__(self) -> bool:
        """Return whether to end."""
        return self.asked or (self._starter > 0 and not running(self._starter))

    @contextlib.contextmanager
    def listening(self) -> Iterator[None]:
        """Handle signals: the first ends the run after this window, the second at once."""

        def ask(number: int, _: FrameType | None) -> None:
            if self.asked:
                raise KeyboardInterrupt
            self.asked = True
            print(f"\n{signal.Signals(number).name}: ending after this window", file=sys.stderr)

        with handled_by(ask):
            yield
