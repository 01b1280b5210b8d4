"""The progress of a run on the screen."""

import importlib.util
import math
import sys
import time
from collections import deque
from collections.abc import Mapping
from dataclasses import dataclass, field

from rich.console import Console, Group
from rich.live import Live
from rich.progress import BarColumn, Progress, TextColumn
from rich.text import Text

LINE_INTERVAL = 5.0  # s between two lines of progress where there is no terminal
PACE = 20.0  # s of wall time over which speeds are taken
SPACING = 0.25  # s between two readings that are kept for that
SOONEST = 1.0  # s of readings before there is a speed


@dataclass(frozen=True, slots=True)
class Reading:
    """How far a run has come, at the end of a window."""

    windows: int
    time: float  # s, simulated
    residual: float | None = None  # of momentum; None in runs without links
    compute: Mapping[str, float] = field(default_factory=dict)  # s that each component computed
    repetitions: int | None = None  # of windows; None where none are repeated


class Pace:
    """How fast a run goes, over its last seconds.

    The first window is left out: in it components may still compile.
    """

    def __init__(self) -> None:
        self._kept: deque[tuple[float, Reading]] = deque()  # wall time [s]

    def add(self, reading: Reading, now: float) -> None:
        """Add a reading at a wall time [s]."""
        readings = self._kept
        if len(readings) > 1 and readings[-1][0] - readings[-2][0] < SPACING:
            readings.pop()
        readings.append((now, reading))
        while len(readings) > 2 and readings[1][0] < now - PACE:
            readings.popleft()

    @property
    def seconds(self) -> float:
        """Wall time that the readings span [s]; 0 while it is too short to tell a speed."""
        span = self._kept[-1][0] - self._kept[0][0] if self._kept else 0.0
        return span if span >= SOONEST else 0.0

    @property
    def windows(self) -> float:
        """Windows per second."""
        return self._last.windows / self.seconds - self._first.windows / self.seconds

    def left(self, end: float) -> float:
        """Wall time until a simulated time [s]; infinite where nothing moves."""
        gone = self._last.time - self._first.time
        return (end - self._last.time) * self.seconds / gone if gone > 0.0 else math.inf

    def shares(self) -> dict[str, float]:
        """Share of the time that each component computed, and did not wait for others."""
        before, seconds = self._first.compute, self.seconds
        return {
            name: (spent - before.get(name, 0.0)) / seconds
            for name, spent in self._last.compute.items()
        }

    def repetitions(self) -> float | None:
        """How often windows were repeated, on average; None where they are not."""
        if self._last.repetitions is None:
            return None
        windows = self._last.windows - self._first.windows
        return (self._last.repetitions - (self._first.repetitions or 0)) / max(windows, 1)

    @property
    def _first(self) -> Reading:
        return self._kept[0][1]

    @property
    def _last(self) -> Reading:
        return self._kept[-1][1]


class ProgressReport:
    """Simulated time, time left, speed, balance, repetitions, residual: a bar, or lines."""

    def __init__(self, end: float) -> None:
        self.end, self.pace, self.windows = end, Pace(), 0
        self._shown = -math.inf
        self._live: Live | None = None
        if shows_bar():
            columns = (
                TextColumn("{task.fields[at]}"),
                BarColumn(),
                TextColumn("{task.fields[to]}"),
            )
            self._bar, self._details = Progress(*columns), Text()
            self._task = self._bar.add_task("", total=end, at="", to="")
            self._live = Live(Group(self._bar, self._details), refresh_per_second=4)
            self._live.start()

    def show(self, reading: Reading) -> None:
        """Show how far the run has come at the end of a window."""
        now = time.monotonic()
        self.pace.add(reading, now)
        self.windows += 1
        ends = reading.time >= self.end
        if self._live:
            self._bar.update(
                self._task,
                completed=reading.time,
                at=f"t = {reading.time:.4g} of {self.end:.4g} s",
                to=time_left(self.pace, self.end),
            )
            self._details.plain = ", ".join(details(reading, self.pace))
        elif now - self._shown >= LINE_INTERVAL or self.windows == 1 or ends:
            self._shown = now
            parts = [f"t = {reading.time:.4g} of {self.end:.4g} s", time_left(self.pace, self.end)]
            print(", ".join(filter(None, [*parts, *details(reading, self.pace)])), flush=True)

    def close(self) -> None:
        """Leave the terminal as the bar is."""
        if self._live:
            self._live.stop()
            self._live = None


def time_left(pace: Pace, end: float) -> str:
    """Wall time until the end of a run; "" while nobody can tell."""
    return in_words(pace.left(end) if pace.seconds else math.inf)


def in_words(seconds: float) -> str:
    """Say how much wall time is left [s]; "" if it is not finite."""
    if not math.isfinite(seconds):
        return ""
    if seconds < 100.0:
        return f"{seconds:.0f} s left"
    minutes = round(seconds / 60.0)
    return f"{minutes // 60} h {minutes % 60} min left" if minutes >= 100 else f"{minutes} min left"


def details(reading: Reading, pace: Pace) -> list[str]:
    """Windows, their speed, who computes while others wait, repetitions, residual."""
    parts = [f"window {reading.windows}"]
    if pace.seconds:
        parts += [f"{pace.windows:.3g} windows/s"]
        parts += [f"{name} computes {share:.0%}" for name, share in pace.shares().items()]
        repeated = pace.repetitions()
        parts += [] if repeated is None else [f"windows repeated {repeated:.1f} times"]
    residual = reading.residual
    return parts if residual is None else [*parts, f"momentum residual {residual:.0e}"]


def shows_bar() -> bool:
    """Whether a bar can be drawn: in a terminal, or in a notebook that has widgets."""
    notebook = Console().is_jupyter and importlib.util.find_spec("ipywidgets") is not None
    return sys.stdout.isatty() or notebook
