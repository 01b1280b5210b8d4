"""Sums over large fields: block by block, so that one thread makes them, however many there are.

A library of linear algebra shares out long products among threads. That changes their rounding
with the number of cores, and its threads then wait on the very cores that the solvers need.
"""

import math
from collections.abc import Iterator

import numpy as np

from quintet.interfaces.component import Array

BLOCK = 8192  # numbers; products of so many are not shared out
ONES = np.ones(BLOCK)


def column_sums(array: Array) -> list[float]:
    """Sum over the items; one number per component of the field."""
    rows = array if array.ndim == 2 else array.reshape(len(array), math.prod(array.shape[1:]))
    # A product with ones sums columns several times faster than a reduction along rows.
    if rows.size <= BLOCK:
        ones = ONES[: len(rows)]
        # ``dot`` takes half the time, with the same bits except of one row and of rows with gaps.
        is_same = rows.flags.c_contiguous and len(rows) > 1
        return (ones.dot(rows) if is_same else ones @ rows).tolist()
    total = np.zeros(rows.shape[1])
    for part in _blocks(len(rows), rows.shape[1]):
        block = rows[part]
        total += ONES[: len(block)] @ block
    return total.tolist()


def size(array: Array) -> float:
    """Sum of the magnitudes: what a residual is to be compared with."""
    return float(np.abs(array).sum())


def product(first: Array, second: Array) -> float:
    """Sum of the products of all numbers of two fields of one shape."""
    a, b = first.reshape(-1), second.reshape(-1)
    return sum(float(a[part] @ b[part]) for part in _blocks(len(a), 1))


def dot(first: Array, second: Array) -> float:
    """Inner product of two fields of one shape, by pairwise summation in a fixed order.

    For what decides an exchange: no library of linear algebra has a part in it, so that the bits
    depend neither on its build nor on its threads.
    """
    return float(np.add.reduce(np.multiply(first, second).reshape(-1)))


def norm(array: Array) -> float:
    """Euclidean norm of all numbers of a field, summed in the same fixed order."""
    return math.sqrt(dot(array, array))


def moment(position: Array, force: Array) -> Array:
    """Sum of position x force over the items, both (n, 3)."""
    outer = np.zeros((3, 3))
    for part in _blocks(len(force), 3):
        outer += position[part].T @ force[part]
    turned = outer - outer.T
    return np.array([turned[1, 2], turned[2, 0], turned[0, 1]])


def finite(array: Array) -> bool:
    """Tell whether every number is finite."""
    if array.dtype.kind != "f":
        return True
    if array.size <= BLOCK:  # a search for a zero byte is twice as fast as ``all`` of so few
        return b"\0" not in np.isfinite(array).tobytes()
    return bool(np.isfinite(array).all())


def _blocks(rows: int, columns: int) -> Iterator[slice]:
    step = max(1, BLOCK // max(1, columns))
    return (slice(begin, begin + step) for begin in range(0, rows, step))
