"""Bisection of a range between a value that satisfies a predicate and one that does not."""

import math
from collections.abc import Callable, Iterable

NEAR_ZERO = 1e-6  # of the first range: where the last one still holds 0, it is no wider than this


def middle(first: float, other: float, log: bool) -> float:
    """Arithmetic or geometric mean."""
    return math.sqrt(first * other) if log else 0.5 * (first + other)


def bisect(
    known: Iterable[float], holds: Callable[[float], bool], log: bool, accuracy: float
) -> tuple[float, float] | None:
    """Bisect the range between the last value that holds and the first that does not.

    Parameters
    ----------
    known : iterable of float
        Values evaluated before, from the end that should hold; both ends are among them.
    holds : callable
        The predicate; for known values it must be cheap.
    accuracy : float
        Width of the final range, relative to its middle. A limit at 0 has no relative width: a
        range that still holds 0 is bisected down to `NEAR_ZERO` of the first.

    Returns
    -------
    (float, float) or None
        The last value that holds and the first that does not; None where the first known value
        does not hold, or all do.
    """
    values = list(known)
    good = bad = math.nan
    for value in values:
        if not holds(value):
            bad = value
            break
        good = value
    if math.isnan(good) or math.isnan(bad):
        return None
    narrow = NEAR_ZERO * abs(values[-1] - values[0])
    while abs(bad - good) > accuracy * abs(middle(good, bad, log)):
        if good * bad <= 0.0 and abs(bad - good) <= narrow:
            break
        value = middle(good, bad, log)
        if value in (good, bad):  # nothing lies between
            break
        if holds(value):
            good = value
        else:
            bad = value
    return good, bad
