"""States to which components can be brought back, saved now and then during a run.

A line that replaces a dead process begins at the state that its component saved last
(`coupler/launch/order_log.py`). A snapshot of the run is one for all components; it takes longer,
since it goes to the disk.
"""

import time

from quintet.coupler.coupling.schedule import Coupling

INTERVAL = 5.0  # s between two, by the clock
COST = 20.0  # times as long as one takes is there none after it


class RestartPoints:
    """Orders all components to save, so that the windows since then are few."""

    def __init__(self) -> None:
        self._saved_at, self._cost = time.monotonic(), 0.0

    def note(self) -> None:
        """Note that all components have just saved."""
        self._saved_at = time.monotonic()

    def end_window(self, coupling: Coupling) -> None:
        """Have them save at the end of a window, if it is time."""
        began = time.monotonic()
        if began - self._saved_at < max(INTERVAL, COST * self._cost):
            return
        for component in coupling.components.values():
            component.save()
        self.note()
        self._cost = self._saved_at - began
