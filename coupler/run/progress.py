"""The progress of a run on the screen."""

import importlib.util
import sys
import time

from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

LINE_INTERVAL = 5.0  # s between two lines of progress where there is no terminal


class ProgressReport:
    """Windows done, simulated time, speed, time left and residual: a bar, or lines."""

    def __init__(self, end: float, first: int = 0, time_then: float = 0.0) -> None:
        self.end, self.first, self.time_then = end, first, time_then  # s, windows, s
        self._began = self._shown = time.monotonic()
        self._bar = self._make_bar() if shows_bar() else None
        if self._bar:
            self._bar.start()
            texts = {"window": first, "speed": "", "residual": ""}
            self._task = self._bar.add_task("", total=end, completed=time_then, **texts)  # type: ignore[arg-type]

    def _make_bar(self) -> Progress:
        columns = (
            TextColumn("window {task.fields[window]}, t = {task.completed:.4g}/{task.total:.4g} s"),
            BarColumn(),
            TextColumn("{task.fields[speed]}"),
            TimeRemainingColumn(),
            TextColumn("{task.fields[residual]}"),
        )
        return Progress(*columns, refresh_per_second=4)

    def show(self, window: int, simulated: float, residual: float) -> None:
        """Show windows done, simulated time [s], speed, time left and residual."""
        now = time.monotonic()
        spent = max(now - self._began, 1e-9)
        speed = (window - self.first) / spent
        if self._bar:
            texts = {
                "window": window,
                "speed": f"{speed:.3g} windows/s",
                "residual": f"momentum {residual:.0e}",
            }
            self._bar.update(self._task, completed=simulated, **texts)  # type: ignore[arg-type]
        elif now - self._shown >= LINE_INTERVAL or window == 1 or simulated >= self.end:
            self._shown = now
            left = (self.end - simulated) * spent / max(simulated - self.time_then, 1e-300)
            print(
                f"window {window}, t = {simulated:.4g} of {self.end:.4g} s, "
                f"{speed:.3g} windows/s, {left:.0f} s left, momentum residual {residual:.0e}",
                flush=True,
            )

    def close(self) -> None:
        """Remove the bar from the terminal."""
        if self._bar:
            self._bar.stop()


def shows_bar() -> bool:
    """Whether a bar can be drawn: in a terminal, or in a notebook that has widgets."""
    notebook = Console().is_jupyter and importlib.util.find_spec("ipywidgets") is not None
    return sys.stdout.isatty() or notebook
