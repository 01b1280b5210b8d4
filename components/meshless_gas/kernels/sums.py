"""Sums over nodes in a fixed order, whoever made what is summed."""

from typing import Any

from numba import njit

from quintet.components.shared.numba_options import EXACT


@njit(**EXACT)
def add_errors(
    rows: Any, volumes: Any, primitive: Any, exact: Any, summed: Any, largest: Any
) -> None:
    """Add what states miss of an exact solution, times their volumes; find the largest.

    Parameters
    ----------
    volumes : (n,) m3
    exact : (m, 5)
        At `rows`.
    summed, largest : (5,)
        Added to, and raised.
    """
    for row in range(rows.shape[0]):
        i = rows[row]
        for q in range(5):
            off = abs(primitive[i, q] - exact[row, q])
            summed[q] += volumes[i] * off
            largest[q] = max(largest[q], off)
