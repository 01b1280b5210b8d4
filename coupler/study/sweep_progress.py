"""Progress of a sweep on the screen: a bar in a terminal, else lines."""

import math
import time
from typing import Any

from rich.live import Live
from rich.progress import BarColumn, Progress, TextColumn

from quintet.coupler.run.progress import LINE_INTERVAL, in_words, shows_bar


class SweepProgress:
    """Runs that are done, of how many; failures by name; time left.

    The time left is taken from the runs of this start: those found complete took none.
    """

    def __init__(self, total: int) -> None:
        self.total, self.done, self.kept, self.failed = total, 0, 0, 0
        self._began, self._shown = time.monotonic(), -math.inf
        self._live: Live | None = None
        if shows_bar():
            self._bar = Progress(BarColumn(), TextColumn("{task.description}"))
            self._task = self._bar.add_task("", total=total)
            self._live = Live(self._bar, refresh_per_second=4)
            self._live.start()

    def show(self, row: dict[str, Any]) -> None:
        """Show that one run has ended, or was found complete."""
        self.done += 1
        self.kept += row["kept"]
        if row["status"] != "done":
            self.failed += 1
            self._say(f"{row['status']}: {row['label']}: {row['cause']}")
        now = time.monotonic()
        if self._live:
            self._bar.update(self._task, completed=self.done, description=self.sentence(now))
        elif now - self._shown >= LINE_INTERVAL or self.done == self.total:
            self._shown = now
            print(self.sentence(now), flush=True)

    def sentence(self, now: float) -> str:
        """Say how far the sweep has come at a time of the clock [s]."""
        ran = self.done - self.kept
        left = (self.total - self.done) * (now - self._began) / ran if ran else math.inf
        words = [f"{self.done} of {self.total} runs"]
        words += [f"{self.kept} found complete"] if self.kept else []
        words += [f"{self.failed} not done"] if self.failed else []
        return ", ".join(filter(None, [*words, in_words(left) if self.done < self.total else ""]))

    def _say(self, text: str) -> None:
        if self._live:
            self._live.console.print(text, markup=False, highlight=False)
        else:
            print(text, flush=True)

    def close(self) -> None:
        """Leave the terminal as the bar is."""
        if self._live:
            self._live.stop()
            self._live = None
