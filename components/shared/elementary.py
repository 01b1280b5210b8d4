"""Logarithm, exponential and power of which the compiler makes vectors: no branches, no calls.

Within 1e-13 of the exact values, relative to them (the logarithm: or to 1).
"""

import numpy as np
from numba import njit

from quintet.components.shared.float_bits import bits_of, number_of
from quintet.components.shared.numba_options import FAST_LANEWISE

LN2 = 0.6931471805599453
LARGEST = 700.0  # whose exponential is still finite
ROOT_HALF = 0x3FE6A09E667F3BCD  # bits of √½
LEAST = 1e-300


@njit(**FAST_LANEWISE)
def logarithm(x):  # type: ignore[no-untyped-def]
    """Ln x, that of 1e-300 of what is below it.

    x = 2ᵏ m with m from √½ to √2; ln m = 2 artanh s, s = (m - 1)/(m + 1), by its series to s¹⁷.
    """
    bits = bits_of(max(x, LEAST))
    exponent = (bits - ROOT_HALF) >> 52
    m = number_of(bits - (exponent << 52))
    s = (m - 1.0) / (m + 1.0)
    z = s * s
    series = 1 / 11 + z * (1 / 13 + z * (1 / 15 + z * (1 / 17)))
    series = 1 / 3 + z * (1 / 5 + z * (1 / 7 + z * (1 / 9 + z * series)))
    return exponent * LN2 + 2.0 * s * (1.0 + z * series)


@njit(**FAST_LANEWISE)
def exponential(x):  # type: ignore[no-untyped-def]
    """Exp x, of x from -700 to 700: 2ᵏ exp r with |r| ≤ ½ ln 2, by its series to r¹²."""
    bounded = min(max(x, -LARGEST), LARGEST)
    whole = np.floor(bounded * (1.0 / LN2) + 0.5)
    r = bounded - whole * LN2
    series = 1 / 362880 + r * (1 / 3628800 + r * (1 / 39916800 + r * (1 / 479001600)))
    series = 1 / 5040 + r * (1 / 40320 + r * series)
    series = 1 / 24 + r * (1 / 120 + r * (1 / 720 + r * series))
    series = 1.0 + r * (1.0 + r * (0.5 + r * (1 / 6 + r * series)))
    return series * number_of((np.int64(whole) + 1023) << 52)


@njit(**FAST_LANEWISE)
def logarithm_of_few_digits(x):  # type: ignore[no-untyped-def]
    """As `logarithm`, within 2e-6: its series to s⁵."""
    bits = bits_of(max(x, LEAST))
    exponent = (bits - ROOT_HALF) >> 52
    m = number_of(bits - (exponent << 52))
    s = (m - 1.0) / (m + 1.0)
    z = s * s
    return exponent * LN2 + 2.0 * s * (1.0 + z * (1 / 3 + z * (1 / 5)))


@njit(**FAST_LANEWISE)
def exponential_of_few_digits(x):  # type: ignore[no-untyped-def]
    """As `exponential`, within 4e-6: its series to r⁵."""
    bounded = min(max(x, -LARGEST), LARGEST)
    whole = np.floor(bounded * (1.0 / LN2) + 0.5)
    r = bounded - whole * LN2
    series = 1.0 + r * (1.0 + r * (0.5 + r * (1 / 6 + r * (1 / 24 + r * (1 / 120)))))
    return series * number_of((np.int64(whole) + 1023) << 52)


@njit(**FAST_LANEWISE)
def power(x, y):  # type: ignore[no-untyped-def]
    """Return x to the power y, of x from 0 on."""
    return exponential(y * logarithm(x))
