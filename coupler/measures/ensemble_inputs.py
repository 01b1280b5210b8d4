"""What the spread of an ensemble comes from: linear regression on the numbers that were drawn.

Every value is a constant, a slope times each input, and a remainder, by least squares. The
remainder is what the inputs do not explain linearly: chance, and curvature. Inputs are drawn
independently, so each one's share of the variance is the square of its slope times its own
variance. See Saltelli et al., Global Sensitivity Analysis (2008), section 1.2.5, and for the value
of an input at which a reference is met Draper & Smith, Applied Regression Analysis (1998), section
3.2 (Fieller).
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from quintet.coupler.measures.ensemble_statistics import student
from quintet.interfaces.component import Array

FREEDOM = 3  # fewest degrees of freedom of the remainder; not fewer than there are inputs


@dataclass(frozen=True, slots=True)
class InputEffect:
    """Effect of one uncertain input on one quantity.

    Attributes
    ----------
    name : str
        Of the input.
    slope : float
        Change of the quantity with the input.
    interval : tuple of floats
        Confidence interval (95 %) of the slope.
    share : float
        Of the variance of the quantity.
    met_at : float or None
        Value of the input, the others at their means, at which the mean is the reference; None
        where there is no reference value, or the interval of the slope contains 0.
    met_between : tuple of floats or None
        Values of the input at which the band of 95 % of a further run contains the reference.
    """

    name: str
    slope: float
    interval: tuple[float, float]
    share: float
    met_at: float | None = None
    met_between: tuple[float, float] | None = None


@dataclass(frozen=True, slots=True)
class Origins:
    """What the spread of one quantity comes from.

    Attributes
    ----------
    effects : list of InputEffect
    remainder : float
        Standard deviation of what the inputs do not explain.
    remainder_share : float
        Its share of the variance.
    """

    effects: list[InputEffect]
    remainder: float
    remainder_share: float


def origins(
    inputs: Mapping[str, Sequence[float]], values: Sequence[float], reference: float | None
) -> Origins | None:
    """Explain the values of a quantity by the inputs of the runs.

    Parameters
    ----------
    inputs : mapping of sequences of n floats
        By name, the numbers of the runs.
    values : sequence of n floats
    reference : float or None
        Of the quantity; None where it is no value that runs can have, as of a distance.

    Returns
    -------
    Origins or None
        None where there are too few runs, or all have the same value or input.
    """
    count, freedom = len(values), len(values) - len(inputs) - 1
    if freedom < max(FREEDOM, len(inputs)) or not inputs:
        return None
    quantity, numbers = np.array(values, float), np.array(list(inputs.values()), float).T
    varied = numbers - numbers.mean(axis=0)
    deviations = varied.std(axis=0, ddof=1)
    total = float(quantity.var(ddof=1))
    if not total > 0.0 or not (deviations > 0.0).all():
        return None
    # In units of their deviations, so that inputs of any size are weighed alike.
    scaled = varied / deviations
    inverse = np.linalg.pinv(scaled.T @ scaled)
    slopes = inverse @ scaled.T @ (quantity - quantity.mean())
    rest = quantity - quantity.mean() - scaled @ slopes
    variance = float(rest @ rest) / freedom
    spreads = np.sqrt(variance * np.diag(inverse))
    effects = []
    for number, name in enumerate(inputs):
        slope, spread = float(slopes[number]), float(spreads[number])
        line = _Line(slope, spread, variance * (1.0 + 1.0 / count), freedom)
        share = slope**2 / total
        effects.append(_effect(name, line, numbers[:, number], share, quantity, reference))
    return Origins(effects, variance**0.5, min(variance / total, 1.0))


@dataclass(frozen=True, slots=True)
class _Line:
    """Dependence of the quantity on one input, in units of the input's deviation."""

    slope: float
    spread: float  # standard error of the slope
    variance: float  # of a further run about the line, at the mean of the input
    freedom: int

    def ends(self) -> tuple[float, float]:
        half = student(self.freedom) * self.spread
        return self.slope - half, self.slope + half

    def crossing(self, distance: float) -> tuple[float, float] | None:
        """Where the band of further runs contains a value at a distance from the mean (Fieller)."""
        quantile = student(self.freedom)
        square = self.slope**2 - (quantile * self.spread) ** 2
        if square <= 0.0:
            return None
        middle = distance * self.slope
        constant = distance**2 - quantile**2 * self.variance
        root = float(np.sqrt(max(middle**2 - square * constant, 0.0)))
        return (middle - root) / square, (middle + root) / square


def _effect(
    name: str, line: _Line, numbers: Array, share: float, quantity: Array, reference: float | None
) -> InputEffect:
    """Return the effect of an input in its own unit."""
    mean, deviation = float(numbers.mean()), float(numbers.std(ddof=1))
    low, high = (end / deviation for end in line.ends())
    met_at = met_between = None
    if reference is not None:
        distance = reference - float(quantity.mean())
        if crossing := line.crossing(distance):
            met_at = mean + deviation * distance / line.slope
            met_between = (mean + deviation * crossing[0], mean + deviation * crossing[1])
    return InputEffect(name, line.slope / deviation, (low, high), share, met_at, met_between)
