"""Rows of neighbours, copied side by side before a loop runs over them.

Processors load vectors of what stands in a row many times faster than they gather them from rows
all over memory: with whole rows copied first, and rows of a length that the compiler knows, pairs
take four fifths of the time, and two thirds in single precision. A list is filled up to whole
vectors with what is out of reach, so that no pairs are left over for a loop without them. All is
inlined: the length of a row is not known beyond a call.
"""

import numpy as np
from numba import njit, types
from numba.extending import overload

from quintet.components.shared.cubic_spline import FOUR

WIDTH = 8  # pairs that a processor computes at once: numbers in its longest vectors
REST = WIDTH - 1


@njit(inline="always")
def longest(first, last, begin, end):  # type: ignore[no-untyped-def]
    """Length of the longest of lists [first, last)."""
    found = 0
    for i in range(first, last):
        found = max(found, end[i] - begin[i])
    return found


@njit(inline="always")
def room(count, dtype):  # type: ignore[no-untyped-def]
    """Make room for so many neighbours, filled up; (any, 4)."""
    return np.empty((count + REST, 4), dtype)


@njit(inline="always")
def away(x, fluid):  # type: ignore[no-untyped-def]
    """Coordinate of what stands out of reach of x."""
    return x + FOUR * fluid.smoothing


@njit(inline="always")
def gather(begin, end, neighbour, source, filling, target):  # type: ignore[no-untyped-def]
    """Copy rows of `source` that are neighbours [begin, end); return how many, filled up."""
    first = np.uint64(begin)
    count = np.uint64(end) - first
    full = (count + np.uint64(REST)) & ~np.uint64(REST)
    for k in range(count):
        j = np.uint64(neighbour[first + k])
        # All are read before one is written, so that they are copied as one vector.
        a, b, c, d = source[j, 0], source[j, 1], source[j, 2], source[j, 3]
        target[k, 0], target[k, 1], target[k, 2], target[k, 3] = a, b, c, d
    for k in range(count, full):
        target[k, 0], target[k, 1], target[k, 2], target[k, 3] = filling
    return full


def pick(begin, end, neighbour, source, target):  # type: ignore[no-untyped-def]
    """Copy numbers of neighbours [begin, end), and return them; None if there are none."""


@overload(pick, inline="always")
def _pick(begin, end, neighbour, source, target):  # type: ignore[no-untyped-def]
    if isinstance(source, types.NoneType):
        return lambda begin, end, neighbour, source, target: None

    def copy(begin, end, neighbour, source, target):  # type: ignore[no-untyped-def]
        for k in range(end - begin):
            target[k] = source[neighbour[begin + k]]
        return target

    return copy
