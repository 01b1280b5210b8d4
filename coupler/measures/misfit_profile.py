"""The interval of a calibrated number: where the misfit stays near to its least.

The misfit of the runs, over the values that they had, is a curve of straight lines. The interval is
from the lowest to the highest value at which it is at most its least plus a rise: a chaotic flow's
misfit has several lows, all of which count. An end at which the curve does not pass that level
before the runs end is open: the interval goes on there, nobody knows how far.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from quintet.interfaces.component import Array


@dataclass(frozen=True, slots=True)
class Interval:
    """An interval of a calibrated number."""

    low: float
    high: float
    open_below: bool
    open_above: bool


def misfit_interval(
    values: Sequence[float], misfits: Sequence[float], level: float, interpolate: bool = True
) -> Interval:
    """Interval of values at which the misfit is at most a level.

    Parameters
    ----------
    values, misfits : sequences of n floats
        Of every run, in any order; one misfit or more is at most the level.
    level : float
    interpolate : bool
        Whether the ends lie between runs. Where other numbers vary too there is no curve between
        two runs, and the ends are values of runs.
    """
    order = np.argsort(values, kind="stable")
    x, y = np.array(values, float)[order], np.array(misfits, float)[order]
    inside = np.flatnonzero(y <= level)
    first, last = int(inside[0]), int(inside[-1])
    low, high = float(x[first]), float(x[last])
    if interpolate and first > 0:
        low = _crossing(x, y, first - 1, first, level)
    if interpolate and last < len(x) - 1:
        high = _crossing(x, y, last, last + 1, level)
    return Interval(low, high, first == 0, last == len(x) - 1)


def _crossing(x: Array, y: Array, left: int, right: int, level: float) -> float:
    """Where the straight line between two runs passes the level."""
    share = (level - y[left]) / (y[right] - y[left])
    return float(x[left] + share * (x[right] - x[left]))
