"""Observed orders of convergence, from errors or from values over a refined size.

Roache, J. Fluids Eng. 116 (1994) 405, for the order from three sizes in constant ratio.
"""

import math
from collections.abc import Sequence

import numpy as np

SAME_RATIO = 1e-3  # relative: refinement ratios within which two count as equal


def least_squares(sizes: Sequence[float], errors: Sequence[float]) -> float | None:
    """Slope of log error over log size; None for fewer than two sizes or an error of 0."""
    if len(set(sizes)) < 2 or not all(0.0 < error < math.inf for error in errors):
        return None
    return float(np.polyfit(np.log(sizes), np.log(errors), 1)[0])


def richardson(sizes: Sequence[float], values: Sequence[float]) -> float | None:
    """Order p of f(h) = f₀ + C hᵖ from the three finest sizes in constant ratio.

    p = ln((f₃ - f₂) / (f₂ - f₁)) / ln r; None where the values do not converge monotonically.
    """
    finest = sorted(zip(sizes, values, strict=True))[:3]
    if len(finest) < 3:
        return None
    (h1, f1), (h2, f2), (h3, f3) = finest
    if h1 == h2 or abs(h3 * h1 / h2**2 - 1.0) > SAME_RATIO or f2 == f1:
        return None
    change = (f3 - f2) / (f2 - f1)
    return math.log(change) / math.log(h2 / h1) if 0.0 < change < math.inf else None
