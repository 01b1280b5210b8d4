"""How long the windows of a coupling are: fixed, or following the state.

Time is counted in whole ticks, never summed. Where no window depends on the state a tick is one
window of the run. Else it is the smallest step of a double at the end of the run, so that every
time of the run, and its end, is a whole number of them exactly.

A window that follows the state shortens at once and lengthens at most twofold, after `CALM`
windows that allowed it; its length has four significant bits (at most an eighth of the step is
lost). Lengths that alternate feed energy into staggered schemes without bound, so few changes
matter more than long windows (Skeel, BIT 33 (1993) 172, on variable steps of Störmer's method).
"""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

from quintet.interfaces.errors import StepError

BITS = 4  # significant ones of a length that follows the state
CALM = 64  # windows that allow a longer one before it is made longer
SUBCYCLES = 64  # steps of the fastest component in a window, at most, where none is demanded
ROUNDING = 1e-9  # of a window, by which times may differ
STRETCH = 0.01  # share by which windows may be longer than asked, to divide a run evenly
BLIND = 100  # windows of a run in which no component says how far it may step


@dataclass(slots=True)
class Windows:
    """The windows of one coupling, of the run or of a group within a window of the run.

    Parameters
    ----------
    tick : float, s
        Unit of all times.
    end : int, ticks
        Where the last window ends.
    length : float, s
        Of a fixed window; of one that follows the state the longest; inf: as the state allows.
    follows : bool
        Whether windows follow the state.
    stops : sequence of int, ticks
        A window ends at every multiple of these.
    marks : tuple of int, ticks
        A window ends at each of these.
    """

    tick: float
    end: int
    length: float = math.inf
    follows: bool = False
    stops: Sequence[int] = ()
    marks: tuple[int, ...] = ()
    now: int = 0
    done: int = 0  # windows
    current: int = 0  # ticks, length that follows the state; 0 before the first window
    calm: int = 0  # windows in a row that allowed a longer one
    length_now: int = 0  # ticks, the window that was begun
    _fixed: int = field(default=0)  # number of fixed windows
    _first: int = field(default=0)  # windows before these

    @property
    def time(self) -> float:
        """Simulated time [s]."""
        return self.now * self.tick

    @property
    def finished(self) -> bool:
        """Whether the last window is done."""
        return self.now >= self.end

    @property
    def time_after(self) -> float:
        """Simulated time at the end of the window that was begun [s]."""
        return (self.now + self.length_now) * self.tick

    def begin(self) -> None:
        """Begin again, within the next window of the coupling around a group."""
        self.now, self._fixed, self._first = 0, 0, self.done

    def divide(self, whole: float, length: float) -> None:
        """Divide a whole time [s] into the fewest equal windows of at most a length [s]."""
        self.tick = whole_windows(whole, length)
        count = round(whole / self.tick)
        self.end, self.length, self._fixed = count, length, count
        self.now, self._first = 0, self.done

    def next(self, stable: float) -> int:
        """Length of the next window [ticks], where the state allows so much [s]."""
        self.length_now = self._next(stable)
        return self.length_now

    def _next(self, stable: float) -> int:
        if not self.follows:
            return self._next_fixed()
        if not stable > 0.0:
            raise StepError(f"the stable step must be positive; it is {stable}. Look at the state.")
        self._follow(self._allowed(stable))
        left = min(self._left())
        if left >= 2 * self.current:
            return self.current
        # The rest before a stop in two equal parts: no sliver of a window follows a whole one.
        return left if left <= self.current * (1.0 + ROUNDING) else -(-left // 2)

    def _allowed(self, stable: float) -> int:
        """Longest window [ticks]: the one asked for, or as many ticks as are stable."""
        whole = self.end * self.tick
        if self.length <= min(stable, whole):
            return round(whole_windows(whole, self.length) / self.tick)
        # Not cut to the end: a group whose windows could be longer makes no sliver before it.
        return rounded(stable, self.tick) if math.isfinite(stable) else self.end

    def _next_fixed(self) -> int:
        if not self._fixed:
            self._fixed = count_windows(self.end * self.tick, self.length)
        upto = self.end * (self.done - self._first + 1) // self._fixed
        return upto - self.now

    def _follow(self, allowed: int) -> None:
        if not self.current or allowed < self.current:
            self.current, self.calm = allowed, 0
        elif allowed > self.current:
            self.calm += 1
            if self.calm >= CALM:
                self.current, self.calm = min(2 * self.current, allowed), 0
        else:
            self.calm = 0

    def _left(self) -> Iterable[int]:
        yield self.end - self.now
        for stop in self.stops:
            yield stop - self.now % stop
        for mark in self.marks:
            if mark > self.now:
                yield mark - self.now

    def advance(self, ticks: int) -> None:
        """Take note of a window that is done."""
        self.now += ticks
        self.done += 1

    def save(self) -> list[int]:
        """All that changes, for a snapshot."""
        return [self.now, self.done, self.current, self.calm]

    def load(self, saved: Sequence[int]) -> None:
        """Come back to what was saved."""
        self.now, self.done, self.current, self.calm = (int(number) for number in saved)


def whole_windows(whole: float, length: float) -> float:
    """Length [s] of the fewest equal windows of at most a length [s] in a whole time [s]."""
    return whole / max(1, math.ceil(whole / length - ROUNDING))


def rounded(seconds: float, tick: float) -> int:
    """Longest time [ticks] of four significant bits within so many seconds."""
    ticks = int(seconds / tick)
    if ticks < 1:
        raise StepError(
            f"the stable step must be at least {tick:.3g} s, the resolution of time in this run; "
            f"it is {seconds:.3g} s. Look at the state."
        )
    drop = max(0, ticks.bit_length() - BITS)
    return ticks >> drop << drop


def count_windows(end: float, length: float) -> int:
    """Count the equal windows of a length [s], or up to `STRETCH` longer, until an end [s]."""
    nearest = max(1, round(end / length))
    return nearest if end / nearest <= (1.0 + STRETCH) * length else math.ceil(end / length)


def run_windows(end: float, length: float, follows: bool, exact: bool) -> Windows:
    """Windows of a whole run to `end` [s]; with `exact` ticks where any part follows the state."""
    if follows or exact:
        tick = math.ulp(end)
        return Windows(tick, round(end / tick), length, follows)
    windows = count_windows(end, length)
    return Windows(end / windows, windows, end / windows)


def auto_length(stable: Iterable[float], equal: Iterable[float]) -> tuple[float, str]:
    """Longest window [s] that joined components allow, and why.

    Parameters
    ----------
    stable : iterable of float, s
        Largest step of each joined component.
    equal : iterable of float, s
        The same of those whose links demand equal steps.
    """
    if demanded := list(equal):
        return min(demanded), "the smallest stable step of the components that must step equally"
    steps = [step for step in stable if math.isfinite(step)]
    if not steps:
        return math.inf, f"a {BLIND}th of the run, for no component limits its step"
    if max(steps) > SUBCYCLES * min(steps):
        return SUBCYCLES * min(steps), f"{SUBCYCLES} times the smallest stable step"
    return max(steps), "the largest stable step of the linked components"


def in_ticks(seconds: float, tick: float) -> int:
    """Whole ticks of a time, at least one."""
    return max(1, round(seconds / tick))
