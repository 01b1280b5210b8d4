"""Observed orders of convergence, from errors or from values over a refined size.

Roache, J. Fluids Eng. 116 (1994) 405, for the uncertainty of the limit; Celik et al., J. Fluids
Eng. 130 (2008) 078001, for the order from three sizes in any ratio.
"""

import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from scipy.optimize import brentq, minimize_scalar
from scipy.special import stdtrit

CONFIDENCE = 0.95  # of the interval of an order
SAFETY = 1.25  # factor of Roache's grid convergence index, where the order is observed
LOWEST, HIGHEST = 1e-2, 20.0  # orders that are searched
END = 1e-3  # an order as near to one of them is none: the fit would be better beyond


@dataclass(frozen=True, slots=True)
class Order:
    """Fit of error = constant (size^order - finest^order).

    Attributes
    ----------
    order : float
    low, high : float or None
        Ends of the confidence interval; None for fewer than three sizes.
    constant : float
        In the unit of the error over size^order.
    """

    order: float
    low: float | None
    high: float | None
    constant: float

    def at(self, size: float) -> float:
        """Error at a size, against the limit of size 0."""
        return self.constant * size**self.order


@dataclass(frozen=True, slots=True)
class Limit:
    """Richardson's extrapolation: value(size) = limit + constant size^order.

    Attributes
    ----------
    value : float
        The limit of size 0.
    uncertainty : float
        Of the limit, as that of Roache's grid convergence index.
    order, constant : float
    """

    value: float
    uncertainty: float
    order: float
    constant: float

    def at(self, size: float) -> float:
        """Difference from the limit at a size, with its sign."""
        return self.constant * size**self.order


def as_table(fit: Order | Limit | None) -> dict[str, Any] | None:
    """Return a fit for programs."""
    return None if fit is None else asdict(fit)


def observed_order(
    sizes: Sequence[float], errors: Sequence[float], finest: float = 0.0
) -> Order | None:
    """Fit the order of errors over sizes by least squares of their logarithms.

    The interval is Student's, of 95 % confidence, of the slope, with two degrees of freedom less
    than there are sizes.

    Parameters
    ----------
    sizes, errors : sequence of float
        In any order; the errors in one unit.
    finest : float
        Size of the run that the errors are taken against; 0 if they are against a reference.

    Returns
    -------
    Order or None
        None for fewer than two sizes, or an error of 0; against a finest run also where no order
        from `LOWEST` to `HIGHEST` fits best.
    """
    if len(set(sizes)) < 2 or min(sizes) <= finest or not all(0.0 < e < math.inf for e in errors):
        return None
    h, logs = np.asarray(sizes, float), np.log(errors)

    def misfit(p: float) -> float:
        return float(np.var(logs - _log_powers(h, p, finest)))

    if finest == 0.0:
        order = float(np.polyfit(np.log(h), logs, 1)[0])
    else:
        order = float(minimize_scalar(misfit, bounds=(LOWEST, HIGHEST), method="bounded").x)
        if not LOWEST + END < order < HIGHEST - END:
            return None
    constant = math.exp(float(np.mean(logs - _log_powers(h, order, finest))))
    freedom = len(h) - 2
    if freedom < 1:
        return Order(order, None, None, constant)
    slopes = _slopes(h, order, finest)
    spread = float(np.sum((slopes - slopes.mean()) ** 2))
    if spread == 0.0:
        return Order(order, None, None, constant)
    deviation = math.sqrt(len(h) * misfit(order) / freedom / spread)
    half = float(stdtrit(freedom, 0.5 + 0.5 * CONFIDENCE)) * deviation
    return Order(order, order - half, order + half, constant)


def _log_powers(sizes: Any, order: float, finest: float) -> Any:
    """Return ln(h^p - h₀^p)."""
    if finest == 0.0:
        return order * np.log(sizes)
    return np.log(sizes**order - finest**order)


def _slopes(sizes: Any, order: float, finest: float) -> Any:
    """Return d ln(h^p - h₀^p) / dp."""
    if finest == 0.0:
        return np.log(sizes)
    coarse, fine = sizes**order, finest**order
    return (coarse * np.log(sizes) - fine * math.log(finest)) / (coarse - fine)


def richardson(sizes: Sequence[float], values: Sequence[float]) -> Limit | None:
    """Extrapolate the values of the three finest sizes to size 0.

    With f(h) = f₀ + C hᵖ the order solves (f₃ - f₂) / (f₂ - f₁) = (h₃ᵖ - h₂ᵖ) / (h₂ᵖ - h₁ᵖ). None
    where there are fewer than three sizes, or where their values do not converge monotonically.
    """
    finest = sorted(zip(sizes, values, strict=True))[:3]
    if len(finest) < 3:
        return None
    (h1, f1), (h2, f2), (h3, f3) = finest
    if h1 == h2 or h2 == h3 or f2 == f1 or not math.isfinite(f1 + f2 + f3):
        return None
    change = (f3 - f2) / (f2 - f1)
    r21, r31 = h2 / h1, h3 / h1

    def excess(p: float) -> float:
        return (r31**p - r21**p) / (r21**p - 1.0) - change

    if excess(LOWEST) > 0.0 or excess(HIGHEST) < 0.0:  # grows with p
        return None
    order = float(brentq(excess, LOWEST, HIGHEST))
    constant = (f2 - f1) / (h2**order - h1**order)
    last = constant * h1**order
    return Limit(f1 - last, SAFETY * abs(last), order, constant)
