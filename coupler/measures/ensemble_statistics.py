"""Statistics of the values and curves of an ensemble of runs."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from quintet.coupler.measures.time_series import Curve
from quintet.interfaces.component import Array

QUANTILES = (0.05, 0.25, 0.5, 0.75, 0.95)
BAND = (0.05, 0.95)  # quantiles between which a reference is said to lie inside
CONFIDENCE = 0.95
GRID = 400  # times of the band of curves


@dataclass(frozen=True, slots=True)
class Statistics:
    """What is known of a quantity by the runs of an ensemble.

    Attributes
    ----------
    count : int
        Runs that have a value.
    mean : float
    deviation : float or None
        Sample standard deviation (divisor n - 1); None of fewer than two runs.
    interval : two floats or None
        Confidence interval (95 %) of the mean, by Student's t; None of fewer than two runs.
    quantiles : tuple of floats
        At `QUANTILES`, by linear interpolation.
    """

    count: int
    mean: float
    deviation: float | None
    interval: tuple[float, float] | None
    quantiles: tuple[float, ...]

    @property
    def band(self) -> tuple[float, float]:
        """Quantiles of 5 % and 95 %."""
        return self.quantiles[0], self.quantiles[-1]

    def inside(self, reference: float) -> float | None:
        """1 where a reference lies within the band, else 0; None of one run: it has no band."""
        low, high = self.band
        return float(low <= reference <= high) if self.count > 1 else None


def statistics(values: Sequence[float]) -> Statistics | None:
    """Statistics of the values of all runs that have one; None where no run has."""
    if not len(values):
        return None
    mean = float(np.mean(values))
    quantiles = tuple(float(q) for q in np.quantile(values, QUANTILES))
    if len(values) < 2:
        return Statistics(1, mean, None, None, quantiles)
    deviation = float(np.std(values, ddof=1))
    half = student(len(values) - 1) * deviation / float(np.sqrt(len(values)))
    return Statistics(len(values), mean, deviation, (mean - half, mean + half), quantiles)


def student(freedom: int) -> float:
    """Two-sided quantile of Student's t distribution at the confidence."""
    # Scenes are read, and run, without it.
    from scipy.special import stdtrit

    return float(stdtrit(freedom, 0.5 * (1.0 + CONFIDENCE)))


@dataclass(frozen=True, slots=True)
class Band:
    """Quantiles of the curves of all runs, at common times."""

    times: Array  # (m,) s
    low: Array  # (m,), 5 %
    median: Array  # (m,)
    high: Array  # (m,), 95 %
    count: int  # curves

    def share_inside(self, reference: Curve) -> float | None:
        """Share of the reference's points within the band.

        None where their times do not meet, and of one curve: it has no band.
        """
        times, values = reference
        seen = (times >= self.times[0]) & (times <= self.times[-1])
        if not seen.any() or self.count < 2:
            return None
        low, high = (np.interp(times[seen], self.times, side) for side in (self.low, self.high))
        return float(np.mean((values[seen] >= low) & (values[seen] <= high)))


def band(curves: Sequence[Curve]) -> Band | None:
    """Median and band of curves over the time that all of them have; None where there is none."""
    curves = [curve for curve in curves if len(curve.times) and np.isfinite(curve.times).all()]
    if not curves:
        return None
    begin = max(float(curve.times[0]) for curve in curves)
    end = min(float(curve.times[-1]) for curve in curves)
    if not begin < end:
        return None
    times = np.linspace(begin, end, GRID)
    values = np.array([np.interp(times, *curve) for curve in curves])
    low, median, high = np.quantile(values, (BAND[0], 0.5, BAND[1]), axis=0)
    return Band(times, low, median, high, len(curves))
