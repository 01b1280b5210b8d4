"""Rows of neighbours, copied side by side before a loop runs over them.

Processors load vectors of what stands in a row many times faster than they gather them from rows
all over memory: with whole rows copied first, and rows of a length that the compiler knows, pairs
take four fifths of the time, and two thirds in single precision. A list is filled up to whole
vectors with a row that is out of reach, so that no pairs are left over for a loop without them.
Rooms are made inline: the length of a row is not known beyond a call. Rows are copied by a
function of its own, compiled once for all loops. They have any number of columns, best a multiple
of four; how many is taken from the filling.
"""

import numpy as np
from numba import njit, types
from numba.extending import overload

from quintet.components.shared.numba_options import LANEWISE
from quintet.components.shared.smoothing.cubic_spline import FOUR

PAIRS = 8  # that a processor computes at once: numbers in its longest vectors
REST = PAIRS - 1


@njit(inline="always")
def longest_list(first, last, begin, end):  # type: ignore[no-untyped-def]
    """Length of the longest of lists [first, last)."""
    longest = 0
    for i in range(first, last):
        longest = max(longest, end[i] - begin[i])
    return longest


@njit(inline="always")
def empty_rows(count, width, dtype):  # type: ignore[no-untyped-def]
    """Make room for so many neighbours, filled up; (any, width)."""
    return np.empty((count + REST, width), dtype)


@njit(inline="always")
def out_of_reach(x, smoothing_length):  # type: ignore[no-untyped-def]
    """Coordinate [m] of what stands beyond the support of a kernel at x."""
    return x + FOUR * smoothing_length


@njit(**LANEWISE)
def pack_rows(begin, end, neighbour, source, filling, target):  # type: ignore[no-untyped-def]
    """Copy rows (n, width) of neighbours [begin, end); return how many they are, filled up.

    `filling` has a number for each column.
    """
    first = np.uint64(begin)
    count = np.uint64(end) - first
    full = (count + np.uint64(REST)) & ~np.uint64(REST)
    width = len(filling)
    fours = width - width % 4
    for k in range(count):
        j = np.uint64(neighbour[first + k])
        for d in range(0, fours, 4):
            # Four are read before one is written, so that they are copied as one vector.
            a, b, c, e = source[j, d], source[j, d + 1], source[j, d + 2], source[j, d + 3]
            target[k, d], target[k, d + 1], target[k, d + 2], target[k, d + 3] = a, b, c, e
        for d in range(fours, width):
            target[k, d] = source[j, d]
    for k in range(count, full):
        for d in range(width):
            target[k, d] = filling[d]
    return full


def pack_values(begin, end, neighbour, source, target):  # type: ignore[no-untyped-def]
    """Copy numbers (n,) of neighbours [begin, end), and return them; None if there are none."""


@overload(pack_values, inline="always")
def _pack_values(begin, end, neighbour, source, target):  # type: ignore[no-untyped-def]
    if isinstance(source, types.NoneType):
        return lambda begin, end, neighbour, source, target: None

    def copy(begin, end, neighbour, source, target):  # type: ignore[no-untyped-def]
        for k in range(end - begin):
            target[k] = source[neighbour[begin + k]]
        return target

    return copy
