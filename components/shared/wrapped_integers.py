"""Whole numbers of 64 bits that wrap around, as random numbers need them.

They are counted from -2^63 to 2^63 - 1, as a device has them.
"""

import numpy as np
from numba import njit

from quintet.components.shared.numba_options import INNER

WRAPPED = INNER | {"inline": "always"}


def as_signed(bits: int) -> int:
    """Whole number with these 64 bits."""
    return bits - (1 << 64) if bits >> 63 else bits


@njit(**WRAPPED)
def wrapped_sum(first: int, second: int) -> int:
    """Sum of which the lowest 64 bits are left."""
    return int(np.int64(np.uint64(first) + np.uint64(second)))


@njit(**WRAPPED)
def wrapped_product(first: int, second: int) -> int:
    """Product of which the lowest 64 bits are left."""
    return int(np.int64(np.uint64(first) * np.uint64(second)))


@njit(**WRAPPED)
def shifted_down(number: int, digits: int) -> int:
    """Bits shifted down by so many digits, with zeros above them."""
    return int(np.int64(np.uint64(number) >> np.uint64(digits)))
