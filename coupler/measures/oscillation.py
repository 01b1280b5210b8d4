"""Period and decay rate of an oscillation, from a least-squares fit of a damped harmonic.

y = c + e^{-γt}(a cos ωt + b sin ωt) in least squares: over a grid of ω without decay first, then
by Gauss-Newton steps in ω and γ, with the other three solved for in each (Golub & Pereyra, SIAM
J. Numer. Anal. 10 (1973) 413).
"""

import math
from typing import NamedTuple

import numpy as np

from quintet.coupler.measures.time_series import Curve
from quintet.interfaces.component import Array

GRID = 8  # values of ω on the grid for each cycle over the whole curve
SHORT = 0.9  # of a cycle that the curve must hold
FEWEST = 4  # values in the shortest cycle looked for
MOST = 2000  # values that the grid looks at: of a longer curve, means of neighbours
ITERATIONS = 100
TOLERANCE = 1e-10


class Harmonic(NamedTuple):
    """A damped harmonic; nan where no fit was found."""

    period: float  # s
    decay: float  # 1/s, γ: of the amplitude
    begin: float = math.nan  # s, from where its time counts
    mean: float = math.nan  # c, as a and b in the unit of the curve
    cosine: float = math.nan  # a
    sine: float = math.nan  # b

    def values(self, times: Array) -> Array:
        """Values (n,) at times (n,) s."""
        passed = times - self.begin
        columns = _columns(passed, 2.0 * math.pi / self.period, self.decay)
        return np.asarray(columns @ [self.mean, self.cosine, self.sine])


NONE = Harmonic(math.nan, math.nan)


def fit(curve: Curve) -> Harmonic:
    """Fit a damped harmonic to a curve of at least one cycle."""
    times, values = curve.times - curve.times[0], curve.values
    span = float(times[-1])
    if len(times) < 2 * FEWEST or not np.ptp(values) > 0.0:
        return NONE
    some = _thinned(times), _thinned(values)
    cycles = np.arange(GRID, GRID * (len(some[0]) // FEWEST) + 1) / GRID
    omegas = 2.0 * math.pi * cycles / span
    omega = float(min(omegas, key=lambda trial: _misfit(*some, trial, 0.0)))
    decay = 0.0
    for _ in range(ITERATIONS):
        change = _newton(times, values, omega, decay)
        omega, decay = omega + change[0], decay + change[1]
        if not (omega > SHORT * omegas[0] and abs(decay) < omega):  # also true of nan
            return NONE
        if max(map(abs, change)) < TOLERANCE * omega:
            factors = np.linalg.lstsq(_columns(times, omega, decay), values, rcond=None)[0]
            return Harmonic(
                2.0 * math.pi / omega, decay, float(curve.times[0]), *map(float, factors)
            )
    return NONE


def _thinned(values: Array) -> Array:
    """Means (m,) of as many neighbours (n,) as leave no more than MOST of them."""
    each = -(-len(values) // MOST)
    whole = len(values) // each
    return np.asarray(values[: each * whole].reshape(whole, each).mean(axis=1))


def _columns(times: Array, omega: float, decay: float) -> Array:
    """Basis functions (m, 3) of which c, a and b are the coefficients."""
    envelope = np.exp(-decay * times)
    ones = np.ones_like(times)
    return np.stack(
        [ones, envelope * np.cos(omega * times), envelope * np.sin(omega * times)], axis=1
    )


def _misfit(times: Array, values: Array, omega: float, decay: float) -> float:
    columns = _columns(times, omega, decay)
    residual = values - columns @ np.linalg.lstsq(columns, values, rcond=None)[0]
    return float(residual @ residual)


def _newton(times: Array, values: Array, omega: float, decay: float) -> tuple[float, float]:
    """Change of ω and γ by one Gauss-Newton step."""
    columns = _columns(times, omega, decay)
    factors = np.linalg.lstsq(columns, values, rcond=None)[0]
    _, cosine, sine = columns.T
    _, a, b = factors
    slopes = [times * (b * cosine - a * sine), -times * (a * cosine + b * sine)]
    both = np.column_stack([columns, *slopes])
    change = np.linalg.lstsq(both, values - columns @ factors, rcond=None)[0]
    return float(change[3]), float(change[4])
