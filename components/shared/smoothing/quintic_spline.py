"""The quintic-spline smoothing kernel, of the same support as the cubic spline, free of branches.

Schoenberg, Q. Appl. Math. 4 (1946) 45; Morris, Fox & Zhu, J. Comput. Phys. 136 (1997) 214:

W(r) = (α/32)[(6-3q)₊⁵ - 6(4-3q)₊⁵ + 15(2-3q)₊⁵] with q = r/h, and α = 63/(1912πh²) in two,
9/(320πh³) in three dimensions; W = 0 for q ≥ 2. Their own smoothing length is 2h/3.

With h of one and a half spacings its knots lie a spacing apart, and sums over a square or cubic
lattice hardly change where the lattice is sheared: particles in rows resist shear under pressure
least of all kernels here, with a thirtieth of the modulus that they have with Wendland's.
"""

import math

import numpy as np
from numba import njit

from quintet.components.shared.smoothing.cubic_spline import TWO, ZERO

THREE, FOUR, SIX, FIFTEEN = np.int8(3), np.int8(4), np.int8(6), np.int8(15)


def normalisation(dimensions: int, smoothing: float) -> float:
    """Return α for a smoothing length h [m], so that ∫W dV = 1."""
    return {2: 63.0 / (1912.0 * math.pi), 3: 9.0 / (320.0 * math.pi)}[
        dimensions
    ] / smoothing**dimensions


@njit(inline="always")
def shape(q):  # type: ignore[no-untyped-def]
    """W over α/32."""
    outer, middle, inner = pieces(q)
    outer2, middle2, inner2 = outer * outer, middle * middle, inner * inner
    sum_of_two = outer2 * outer2 * outer - SIX * (middle2 * middle2 * middle)
    return sum_of_two + FIFTEEN * (inner2 * inner2 * inner)


@njit(inline="always")
def slope(q):  # type: ignore[no-untyped-def]
    """dW/dr over -15α/(32h)."""
    outer, middle, inner = pieces(q)
    outer2, middle2, inner2 = outer * outer, middle * middle, inner * inner
    return outer2 * outer2 - SIX * (middle2 * middle2) + FIFTEEN * (inner2 * inner2)


@njit(inline="always")
def pieces(q):  # type: ignore[no-untyped-def]
    """(6-3q)₊, (4-3q)₊ and (2-3q)₊."""
    scaled = THREE * q
    return max(SIX - scaled, ZERO), max(FOUR - scaled, ZERO), max(TWO - scaled, ZERO)
