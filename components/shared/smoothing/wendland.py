"""Wendland's smoothing kernel of class C2, of the same support as the cubic spline.

Wendland, Adv. Comput. Math. 4 (1995) 389:

W(r) = α (1-q/2)₊⁴ (2q+1) with q = r/h, and α = 7/(4πh²) in two, 21/(16πh³) in three dimensions.

Its Fourier transform is positive, so that particles do not come together in pairs (Dehnen & Aly,
Mon. Not. R. Astron. Soc. 425 (2012) 1068), and a lattice of them stays one.
"""

import math

from numba import njit

from quintet.components.shared.smoothing.cubic_spline import ONE, TWO, ZERO


def normalisation(dimensions: int, smoothing: float) -> float:
    """Return α for a smoothing length h [m], so that ∫W dV = 1."""
    return {2: 7.0 / (4.0 * math.pi), 3: 21.0 / (16.0 * math.pi)}[
        dimensions
    ] / smoothing**dimensions


@njit(inline="always")
def shape(q):  # type: ignore[no-untyped-def]
    """W over α/16."""
    rest = max(TWO - q, ZERO)
    return rest * rest * rest * rest * (TWO * q + ONE)


@njit(inline="always")
def slope(q):  # type: ignore[no-untyped-def]
    """(dW/dr)/r over -5α/(8h²)."""
    rest = max(TWO - q, ZERO)
    return rest * rest * rest
