"""Period and decay of an oscillation, by the damped harmonic that fits a curve best.

y = c + e^{-γt}(a cos ωt + b sin ωt) in least squares: over a grid of ω without decay first, then
by Gauss-Newton steps in ω and γ, with the other three solved for in each (Golub & Pereyra, SIAM
J. Numer. Anal. 10 (1973) 413).
"""

import math
from typing import NamedTuple

import numpy as np

from quintet.coupler.measures.time_series import Curve
from quintet.interfaces.component import Array

PARTS = 8  # of a cycle over the whole curve: steps of the grid
SHORT = 0.9  # of a cycle that the curve must hold
FEWEST = 4  # values in the shortest cycle looked for
STEPS = 100
TOLERANCE = 1e-10


class Harmonic(NamedTuple):
    """The fit; nan where none was found."""

    period: float  # s
    decay: float  # 1/s, γ: of the amplitude


NONE = Harmonic(math.nan, math.nan)


def fit(curve: Curve) -> Harmonic:
    """Fit a curve that holds a cycle, or many."""
    times, values = curve.times - curve.times[0], curve.values
    span = float(times[-1])
    if len(times) < 2 * FEWEST or not np.ptp(values) > 0.0:
        return NONE
    cycles = np.arange(PARTS, PARTS * (len(times) // FEWEST) + 1) / PARTS
    turns = 2.0 * math.pi * cycles / span
    turn, decay = float(min(turns, key=lambda one: _misfit(times, values, one, 0.0))), 0.0
    for _ in range(STEPS):
        change = _newton(times, values, turn, decay)
        turn, decay = turn + change[0], decay + change[1]
        if not (turn > SHORT * turns[0] and abs(decay) < turn):  # also true of nan
            return NONE
        if max(map(abs, change)) < TOLERANCE * turn:
            return Harmonic(2.0 * math.pi / turn, decay)
    return NONE


def _columns(times: Array, turn: float, decay: float) -> Array:
    """What c, a and b are the factors of; (m, 3)."""
    fading = np.exp(-decay * times)
    ones = np.ones_like(times)
    return np.stack([ones, fading * np.cos(turn * times), fading * np.sin(turn * times)], axis=1)


def _misfit(times: Array, values: Array, turn: float, decay: float) -> float:
    columns = _columns(times, turn, decay)
    off = values - columns @ np.linalg.lstsq(columns, values, rcond=None)[0]
    return float(off @ off)


def _newton(times: Array, values: Array, turn: float, decay: float) -> tuple[float, float]:
    """Change of ω and γ by one Gauss-Newton step."""
    columns = _columns(times, turn, decay)
    factors = np.linalg.lstsq(columns, values, rcond=None)[0]
    _, cosine, sine = columns.T
    _, a, b = factors
    slopes = [times * (b * cosine - a * sine), -times * (a * cosine + b * sine)]
    both = np.column_stack([columns, *slopes])
    change = np.linalg.lstsq(both, values - columns @ factors, rcond=None)[0]
    return float(change[3]), float(change[4])
