"""Where something is over time, smooth enough for forces: by a cubic spline, or harmonic.

A place is a displacement along x, y and z [m] and an angle [rad] about a fixed axis. Velocities and
accelerations are continuous inside the time that a trajectory covers.
"""

import math
from typing import NamedTuple, Protocol

import numpy as np

from quintet.interfaces.component import Array

ROUNDING = 1e-9  # of the end: what sums of steps may lie beyond it
SHARES = 8  # parts that each interval of a course is cut into


class Instant(NamedTuple):
    """Place at one time, and its rates; (4,) each: along x, y and z in m, and an angle in rad."""

    place: Array
    rate: Array  # per s
    second: Array  # per s2


class Trajectory(Protocol):
    """A place over time."""

    end: float  # s, until which it is known

    def at(self, time: float) -> Instant:
        """Place, velocity and acceleration at a time [s] from 0 to `end`."""

    def course(self) -> Array:
        """Places (n, 4) from time 0 to `end` in order, with the extremes along each axis."""


def growth(time: float, ramp: float) -> tuple[float, float, float]:
    """Share r of a motion that grows within a ramp [s]: 1, and its derivatives, 1/s and 1/s2.

    r = 10τ³ - 15τ⁴ + 6τ⁵ with τ = time/ramp, whose first two derivatives vanish at both ends.
    """
    if time >= ramp:
        return 1.0, 0.0, 0.0
    x = time / ramp
    r = x * x * x * (10.0 + x * (6.0 * x - 15.0))
    dr = 30.0 * x * x * (1.0 - x) ** 2 / ramp
    return r, dr, 60.0 * x * (1.0 - x) * (1.0 - 2.0 * x) / ramp**2


class Harmonic:
    """Amplitudes (4,) times r(t) sin(2πt/period), r of `growth` within `ramp` [s]."""

    end = math.inf

    def __init__(self, amplitude: Array, period: float, ramp: float) -> None:
        self.amplitude, self.frequency, self.ramp = amplitude, 2.0 * math.pi / period, ramp

    def at(self, time: float) -> Instant:
        """Place, velocity and acceleration at a time [s]."""
        omega = self.frequency
        s, c = math.sin(omega * time), math.cos(omega * time)
        r, dr, ddr = growth(time, self.ramp)
        a = self.amplitude
        return Instant(
            a * (r * s),
            a * (dr * s + r * omega * c),
            a * (ddr * s + 2.0 * dr * omega * c - r * omega * omega * s),
        )

    def course(self) -> Array:
        """Places (n, 4) of a whole swing: a straight line."""
        return np.linspace(-1.0, 1.0, 8 * SHARES + 1)[:, np.newaxis] * self.amplitude


class Spline:
    """The cubic spline through places (n, 4) at times (n,) s, n ≥ 2.

    At both ends it has the slope of the parabola through the three nearest rows, of two rows that
    of the line; where the two outermost rows are equal it rests at that end. Inside, first and
    second derivatives are continuous (de Boor, A Practical Guide to Splines (1978), ch. IV).
    """

    def __init__(self, times: Array, places: Array) -> None:
        self.times, self.places, self.end = times, places, float(times[-1])
        self.slopes = _slopes(times, places)

    def at(self, time: float) -> Instant:
        """Place, velocity and acceleration at a time [s]; beyond the ends those at the end."""
        time = min(max(time, float(self.times[0])), self.end)
        k = int(np.searchsorted(self.times, time, side="right")) - 1
        k = min(max(k, 0), len(self.times) - 2)
        h = float(self.times[k + 1] - self.times[k])
        x = time - float(self.times[k])
        y, secant = self.places[k], (self.places[k + 1] - self.places[k]) / h
        first, last = self.slopes[k], self.slopes[k + 1]
        b, c = (3.0 * secant - 2.0 * first - last) / h, (first + last - 2.0 * secant) / (h * h)
        return Instant(
            y + x * (first + x * (b + x * c)),
            first + x * (2.0 * b + 3.0 * x * c),
            2.0 * b + 6.0 * x * c,
        )

    def course(self) -> Array:
        """Places (n, 4) in all intervals from time 0 on, and where each cubic turns back."""
        steps = np.diff(self.times)[:, np.newaxis]  # (n - 1, 1) s
        begin = np.clip(-self.times[:-1, np.newaxis], 0.0, steps)  # time 0, in its interval
        secants, slopes = np.diff(self.places, axis=0) / steps, self.slopes
        b = (3.0 * secants - 2.0 * slopes[:-1] - slopes[1:]) / steps
        c = (slopes[:-1] + slopes[1:] - 2.0 * secants) / (steps * steps)
        # Roots of the derivative, slope + 2 b x + 3 c x², without cancellation.
        with np.errstate(divide="ignore", invalid="ignore"):
            q = -(b + np.copysign(np.sqrt(b * b - 3.0 * c * slopes[:-1]), b))
            roots = [q / (3.0 * c), slopes[:-1] / q]
        shares = [begin + share * (steps - begin) for share in np.linspace(0.0, 1.0, SHARES + 1)]
        columns = [np.broadcast_to(x, b.shape) for x in shares]
        for root in roots:
            columns += [
                np.where((root > begin) & (root < steps), root, begin)[:, [k]] + 0.0 * b
                for k in range(b.shape[1])
            ]
        x = np.sort(np.stack(columns), axis=0)  # (k, n - 1, 4) s, the same time for all axes
        places = self.places[:-1] + x * (slopes[:-1] + x * (b + x * c))
        in_order = places[:, begin[:, 0] < steps[:, 0]].transpose(1, 0, 2)
        return np.asarray(in_order.reshape(-1, b.shape[1]))


def _slopes(times: Array, places: Array) -> Array:
    """First derivatives (n, k) of the spline at its rows, by the tridiagonal equations for them."""
    steps = np.diff(times)  # (n - 1,) s
    secants = np.diff(places, axis=0) / steps[:, np.newaxis]
    count = len(times)
    slopes = np.empty_like(places)
    if count == 2:
        slopes[:] = secants[0]
        return slopes
    slopes[0] = _end_slope(steps[0], steps[1], secants[0], secants[1])
    slopes[-1] = _end_slope(steps[-1], steps[-2], secants[-1], secants[-2])
    for end in (0, -1):
        if not secants[end].any():  # two equal rows: at rest
            slopes[end] = 0.0
    factor = np.zeros(count)  # Thomas's algorithm, downwards and back
    for k in range(1, count - 1):
        before, after = steps[k - 1], steps[k]
        right = 3.0 * (after * secants[k - 1] + before * secants[k])
        pivot = 2.0 * (before + after) - after * factor[k - 1]
        factor[k] = before / pivot
        slopes[k] = (right - after * slopes[k - 1]) / pivot
    for k in range(count - 2, 0, -1):
        slopes[k] -= factor[k] * slopes[k + 1]
    return slopes


def _end_slope(step: float, next_step: float, secant: Array, next_secant: Array) -> Array:
    """Slope at the end of the parabola through three rows, by the two secants between them."""
    return np.asarray(secant + (secant - next_secant) * step / (step + next_step))
