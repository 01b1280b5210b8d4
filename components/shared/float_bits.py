"""Numbers as integers of the same bits, for the greatest of many.

Numbers from 0 on are in the order of their bits, and the compiler makes vectors of the greatest of
integers, but not of that of floats: a loop over pairs that asks for it would be half as fast.
"""

import numpy as np
from numba import types
from numba.extending import overload


def bits_of(number):  # type: ignore[no-untyped-def]
    """Bits of a number, as an integer as wide."""


def number_of(bits):  # type: ignore[no-untyped-def]
    """Number that has these bits."""


@overload(bits_of, inline="always")
def _bits_of(number):  # type: ignore[no-untyped-def]
    if number == types.float32:
        return lambda number: np.float32(number).view(np.int32)
    return lambda number: np.float64(number).view(np.int64)


@overload(number_of, inline="always")
def _number_of(bits):  # type: ignore[no-untyped-def]
    if bits == types.int32:
        return lambda bits: np.int32(bits).view(np.float32)
    return lambda bits: np.int64(bits).view(np.float64)
