"""The cubic-spline smoothing kernel, free of branches.

Monaghan, Annu. Rev. Astron. Astrophys. 30 (1992) 543:

W(r) = (α/4)[(2-q)₊³ - 4(1-q)₊³] with q = r/h, and α = 10/(7πh²) in two, 1/(πh³) in three
dimensions; W = 0 for q ≥ 2.
"""

import math

import numpy as np
from numba import njit

SUPPORT = 2.0  # radius of the kernel over the smoothing length

# Whole numbers this small leave a number of single precision single; 2.0 would make it double.
ZERO, ONE, TWO, FOUR = np.int8(0), np.int8(1), np.int8(2), np.int8(4)


def normalisation(dimensions: int, smoothing: float) -> float:
    """Return α for a smoothing length h [m], so that ∫W dV = 1."""
    return {2: 10.0 / (7.0 * math.pi), 3: 1.0 / math.pi}[dimensions] / smoothing**dimensions


@njit(inline="always")
def shape(q):  # type: ignore[no-untyped-def]
    """W over α/4."""
    outer, inner = max(TWO - q, ZERO), max(ONE - q, ZERO)
    return outer * outer * outer - FOUR * inner * inner * inner


@njit(inline="always")
def slope(q):  # type: ignore[no-untyped-def]
    """dW/dr over -3α/(4h)."""
    outer, inner = max(TWO - q, ZERO), max(ONE - q, ZERO)
    return outer * outer - FOUR * inner * inner
