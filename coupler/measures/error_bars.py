"""Error bars from the errors of sampled windows: of a single window, and of a value of the run.

Bar of a window: the k-th smallest of N sampled errors, whatever their distribution. Of N + 1 errors
in random order the last is below it with probability k / (N + 1) (Wilks, Ann. Math. Stat. 12 (1941)
91); of samples that are evenly spread, with (k - 1/2) / N. Samples of one window in each stratum
lie between, and so does k. Fewer samples than that needs are taken for normally distributed about
zero.

Bar of a value: the sampled errors go on to the value's time as in `error_growth`, each for all
windows of its stratum; their sum is the expected error, their scatter its standard deviation.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from statistics import NormalDist

import numpy as np

from quintet.coupler.coupling.judgement.error_growth import DIFFERENCES
from quintet.coupler.measures.time_series import Curve
from quintet.interfaces.component import Array

CONFIDENCE = 0.9
# The scatter of the expected error, over that of samples in random order: their places in the
# strata have low discrepancy. This and SYSTEMATIC are chosen on scenes with exact answers.
SCATTER = 0.3
SYSTEMATIC = 0.02  # of the expected error: what is left of it by the orders that are neglected
# Student's t, two-sided 90 %, of 1 to 6 samples whose mean is known.
STUDENT = (6.314, 2.920, 2.353, 2.132, 2.015, 1.943)


@dataclass(frozen=True, slots=True)
class ErrorCurve:
    """Error of a curve at its rows: expected, and its standard deviation, (rows,) each."""

    expected: Array
    deviation: Array


@dataclass(frozen=True, slots=True)
class Samples:
    """Sampled windows, and for one quantity what `WindowError` has of each."""

    windows: Sequence[int]
    weights: Sequence[Sequence[float]]
    rests: Sequence[float]
    drifts: Sequence[float]


def window_bar(errors: Sequence[float]) -> float:
    """Bound of the magnitude of a window's error, with the probability CONFIDENCE.

    Parameters
    ----------
    errors : sequence of floats
        Those of the sampled windows, in the unit of the quantity.
    """
    count = len(errors)
    if not count:
        return math.nan
    sizes = sorted(abs(error) for error in errors)
    # The mean of both laws, (N + 1) p and N p + 1/2.
    rank = CONFIDENCE * count + 0.5 * (CONFIDENCE + 0.5)
    if rank > count:
        rms = math.sqrt(sum(size**2 for size in sizes) / count)
        return STUDENT[count - 1] * rms
    below = int(rank)
    step = sizes[min(below, count - 1)] - sizes[below - 1]
    return sizes[below - 1] + (rank - below) * step


def error_curve(samples: Samples, every: int, curve: Curve, first: int = 0) -> ErrorCurve:
    """Error that all windows so far made of a curve of single values, at each of its rows.

    Parameters
    ----------
    samples : Samples
        Of the quantity.
    every : int
        Windows of a stratum.
    curve : Curve
        Values at the windows' ends.
    first : int
        Windows that were done at its first row.
    """
    rows, windows = len(curve.values), np.array(samples.windows)
    done = np.arange(first, first + rows)
    carried = np.array(samples.weights) @ _differences(curve.values)  # (samples, rows)
    at = np.clip(windows - first, 0, rows - 1)
    since = np.maximum(curve.times - curve.times[at, None], 0.0)  # s
    stays = np.array(samples.rests)[:, None] + np.array(samples.drifts)[:, None] * since
    return _summed(windows, _windows_stood_for(windows, every, done), carried + stays)


def error_at_end(samples: Samples, every: int, done: int, values: Array) -> tuple[float, float]:
    """Expected error of a field at the run's end, and its deviation: root mean squares.

    Parameters
    ----------
    samples : Samples
        Of the field; their rests are magnitudes.
    every : int
        Windows of a stratum.
    done : int
        Windows of the run.
    values : (DIFFERENCES + 1, k) array
        The field at the ends of the last windows.
    """
    windows = np.array(samples.windows)
    carried = np.array(samples.weights) @ _differences(values)[:, -1]  # (samples, k)
    stood_for = _windows_stood_for(windows, every, np.array([done]))
    total = _summed(windows, np.repeat(stood_for, carried.shape[1], axis=1), carried)
    rest = done * np.mean(np.square(samples.rests))  # of independent errors
    expected, variance = (float(np.mean(part**2)) for part in (total.expected, total.deviation))
    return math.sqrt(expected), math.sqrt(variance + rest)


def _summed(windows: Array, stood_for: Array, carried: Array) -> ErrorCurve:
    """Sum the samples' errors, (samples, rows), each for the windows that it stands for.

    With one sample in each stratum its variance is from neighbouring strata (collapsed strata,
    Cochran, Sampling Techniques, 1977, section 5A.12).
    """
    expected = (stood_for * carried).sum(axis=0)
    usual = windows > 1  # the first window stands for itself
    counts, errors = stood_for[usual], carried[usual]
    seen = (counts > 0.0).sum(axis=0)
    pairs = np.maximum(seen - 1.0, 1.0)
    scatter = (counts[1:] ** 2 * np.diff(errors, axis=0) ** 2).sum(axis=0) / 2.0
    unknown = np.where(seen > 1, 0.0, expected**2)
    variance = SCATTER**2 * scatter * seen / pairs + unknown + (SYSTEMATIC * expected) ** 2
    return ErrorCurve(expected, np.sqrt(variance))


def _differences(values: Array) -> Array:
    """Forward differences of all orders at each row; of the last rows, of the last that has all."""
    count = max(0, len(values) - DIFFERENCES)
    if not count:
        return np.zeros((DIFFERENCES, *values.shape))
    orders, rows = [], values
    for _ in range(DIFFERENCES):
        rows = np.diff(rows, axis=0)
        last = np.repeat(rows[count - 1 : count], DIFFERENCES, axis=0)
        orders.append(np.concatenate([rows[:count], last]))
    return np.array(orders)


def _windows_stood_for(windows: Array, every: int, done: Array) -> Array:
    """How many of the windows done each sample stands for, (samples, rows)."""
    ends = every * (np.maximum(0, windows - 2) // every + 1) + 1
    ends[-1] = max(int(done[-1]), int(ends[-1]))
    ends[windows == 1] = 1
    starts = np.concatenate([[0], ends[:-1]])
    return np.clip(done - starts[:, None], 0, (ends - starts)[:, None]).astype(float)


def bar_about(expected: float, deviation: float) -> float:
    """Bound of the magnitude of a normally distributed error, with the probability CONFIDENCE.

    It is nan where one of the two numbers is.
    """
    size = abs(expected)
    if math.isnan(size + deviation):
        return math.nan
    if not deviation > 0.0:
        return size
    normal = NormalDist(size, deviation)
    low, high = 0.0, size + 4.0 * deviation
    for _ in range(60):
        middle = 0.5 * (low + high)
        inside = normal.cdf(middle) - normal.cdf(-middle)
        low, high = (low, middle) if inside > CONFIDENCE else (middle, high)
    return high
