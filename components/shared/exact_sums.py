"""Sums whose bits do not depend on the order of their terms, nor on who adds which.

Each term is cut into parts that are multiples of a power of two, so large that sums of such parts
are without rounding. Three parts hold more of a term than its last bit is worth in the sum.

Rump, Ogita & Oishi, SIAM J. Sci. Comput. 31 (2008) 189, ExtractVector; Demmel & Nguyen, IEEE
Trans. Comput. 64 (2015) 2060.
"""

import math
from collections.abc import Sequence

import numpy as np
from numba import njit

from quintet.components.shared.numba_options import EXACT
from quintet.interfaces.component import Array

PARTS = 3
MANTISSA = 53  # bits


def bounds(columns: Sequence[Array]) -> Array:
    """Largest absolute value (k,) of each of k columns (n,); 0 of none."""
    return np.array([np.abs(column).max(initial=0.0) for column in columns])


def sum_parts(columns: Sequence[Array], greatest: Array, count: int) -> Array:
    """Sums (k, 3) of the parts of columns, exact; those of several groups of rows may be added.

    Parameters
    ----------
    columns : sequence of k (n,) float arrays
    greatest : (k,) float array
        Largest absolute value of each column, of all groups.
    count : int
        Rows of all groups, or more.
    """
    sums = np.zeros((len(columns), PARTS))
    bits = math.ceil(math.log2(count + 2))
    for column, bound, of_column in zip(columns, greatest.tolist(), sums, strict=True):
        exponent = bits + math.frexp(bound)[1]
        steps = [exponent + part * (bits - MANTISSA) for part in range(PARTS)]
        if steps[0] > 1023:  # too large for a sum, or not finite
            of_column[:] = math.nan
            continue
        first, second, third = (math.ldexp(1.0, step) for step in steps)
        add_parts(np.ascontiguousarray(column), first, second, third, of_column)
    return sums


def total(parts: Array) -> Array:
    """Sums (k,) of columns, from those of their parts (k, 3)."""
    return np.asarray((parts[:, 2] + parts[:, 1]) + parts[:, 0])


# As written: the optimiser must not simplify (x + s) - s.
@njit(**EXACT)
def add_parts(column: Array, first: float, second: float, third: float, sums: Array) -> None:
    """Add the parts of numbers (n,) to three sums; adding a large number cuts each part off."""
    high, middle, low = sums[0], sums[1], sums[2]
    for i in range(column.shape[0]):
        x = column[i]
        part = (x + first) - first
        high += part
        x -= part
        part = (x + second) - second
        middle += part
        low += ((x - part) + third) - third
    sums[0], sums[1], sums[2] = high, middle, low
