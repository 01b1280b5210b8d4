"""Linear least squares over few long columns, with a filter of those that say nothing new.

The sums are numpy's pairwise ones, in a fixed order: LAPACK's change with its threads, and the
exchange with them.

Literature: Björck (1967), BIT 7, 1, for the modified Gram-Schmidt process with the right-hand
side as a last column; Haelterman, Bogaers, Scheufele, Uekermann and Mehl (2016), Comput. Struct.
171, 9, for the filter (their QR2).
"""

from collections.abc import Sequence

import numpy as np

from quintet.interfaces.component import Array
from quintet.interfaces.sums import dot, norm

BLOCK = 8192  # numbers that are worked on at once; what is made between stays in the cache


def filtered_least_squares(columns: Array, target: Array, limit: float) -> tuple[Array, Array]:
    """Coefficients c that make the norm of Σ c_j column_j - target smallest.

    Parameters
    ----------
    columns : (k, n) float array, 1
        One column per row, the most trusted first.
    target : (n,) float array, 1
    limit : float, 1
        A column of which those before it leave less than this share is left out (QR2).

    Returns
    -------
    (k,) float array of coefficients, 0 where left out; (k,) bool array, which were kept

    References
    ----------
    Haelterman et al. (2016), Comput. Struct. 171, 9.
    """
    count, length = columns.shape
    rest = np.concatenate([columns, target[None]])  # (k + 1, n): all that is left, target last
    triangle = np.zeros((count, count + 1))  # R, and in its last column Qᵀ target
    is_used = np.zeros(count, dtype=bool)
    block = max(1, BLOCK // max(1, length))
    spare = np.empty((min(block, count), length))
    for j in range(count):
        left = norm(rest[j])
        if not left > limit * norm(columns[j]):
            continue
        is_used[j], triangle[j, j] = True, left
        direction = rest[j] / left
        for first in range(j + 1, count + 1, block):
            some = rest[first : first + block]
            part = spare[: len(some)]
            along = np.add.reduce(np.multiply(some, direction, out=part), axis=1)
            triangle[j, first : first + block] = along
            some -= np.multiply(along[:, None], direction, out=part)
    return _substitute_back(triangle, is_used), is_used


def _substitute_back(triangle: Array, is_used: Array) -> Array:
    """Solve R c = Qᵀ target over the columns that were kept."""
    solution = np.zeros(len(is_used))
    for j in np.flatnonzero(is_used)[::-1]:
        known = dot(triangle[j, j + 1 : -1], solution[j + 1 :])
        solution[j] = (triangle[j, -1] - known) / triangle[j, j]
    return solution


def combination(coefficients: Array, columns: Sequence[Array]) -> Array:
    """Σ c_j column_j (n,), of columns (n,) in their order."""
    total = np.zeros_like(columns[0])
    for coefficient, column in zip(coefficients, columns, strict=True):
        total += coefficient * column
    return total
