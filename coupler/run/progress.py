"""The progress of a run on the screen."""

import importlib.util
import sys
import time

from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

LINE_INTERVAL = 5.0  # s between two lines of progress where there is no terminal


class ProgressReport:
    """Windows done, speed, time left and residual: a bar, or lines without a terminal."""

    def __init__(self, windows: int, end: float, first: int = 0) -> None:
        self.windows, self.end, self.first = windows, end, first
        self._began = self._shown = time.monotonic()
        self._bar = self._make_bar() if shows_bar() else None
        if self._bar:
            self._bar.start()
            self._task = self._bar.add_task("", total=windows, speed="", residual="")

    def _make_bar(self) -> Progress:
        columns = (
            TextColumn("{task.completed}/{task.total}"),
            BarColumn(),
            TextColumn("{task.fields[speed]}"),
            TimeRemainingColumn(),
            TextColumn("{task.fields[residual]}"),
        )
        return Progress(*columns, refresh_per_second=4)

    def show(self, window: int, residual: float) -> None:
        """Show the windows done, the speed, the time left and the residual."""
        now = time.monotonic()
        speed = (window - self.first) / max(now - self._began, 1e-9)
        if self._bar:
            texts = {"speed": f"{speed:.3g} windows/s", "residual": f"momentum {residual:.0e}"}
            self._bar.update(self._task, completed=window, **texts)  # type: ignore[arg-type]
        elif now - self._shown >= LINE_INTERVAL or window in (1, self.windows):
            self._shown = now
            left = (self.windows - window) / speed
            print(
                f"window {window}/{self.windows}, t = {window * self.end / self.windows:.4g} s, "
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
