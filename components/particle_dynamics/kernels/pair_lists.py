"""Pairs of a lattice from the neighbour lists of its points and of their periodic images."""

import numpy as np
from numba import njit
from numpy.typing import NDArray

from quintet.components.particle_dynamics.state import Whole
from quintet.components.shared.numba_options import EXACT
from quintet.components.shared.search.neighbours import Lists


@njit(**EXACT)
def write_pairs(
    lists: Lists, place: Whole, order: Whole, source: Whole, begin: Whole, neighbour: Whole
) -> int:
    """Write each pair of full lists once, in the order of the points; count the pairs."""
    count = place.shape[0]
    k = 0
    for i in range(count):
        row = place[i]
        for m in range(lists.begin[row], lists.middle[row]):
            j = lists.neighbour[m]
            if j > row:
                neighbour[k] = order[j]
                k += 1
        for m in range(lists.middle[row], lists.end[row]):
            j = source[lists.neighbour[m] - count]
            if j > i:
                neighbour[k] = j
                k += 1
        begin[i + 1] = k
    return k


@njit(**EXACT)
def keep_pairs_of(
    is_chosen: NDArray[np.bool_], begin: Whole, neighbour: NDArray[np.int32],
    is_near: NDArray[np.bool_],
) -> int:  # fmt: skip
    """Remove the pairs of which neither point is chosen; mark the points of the others, count."""
    k, first = 0, begin[0]
    for i in range(is_chosen.shape[0]):
        last = begin[i + 1]
        for m in range(first, last):
            j = neighbour[m]
            if is_chosen[i] or is_chosen[j]:
                neighbour[k] = j
                k += 1
                is_near[i] = True
                is_near[j] = True
        first = last
        begin[i + 1] = k
    return k


@njit(**EXACT)
def count_others(
    begin: Whole, neighbour: NDArray[np.int32], lower: Whole, others: Whole
) -> None:  # fmt: skip
    """Count the points that list each point: those of lower number, and all."""
    for i in range(lower.shape[0]):
        for m in range(begin[i], begin[i + 1]):
            j = neighbour[m]
            lower[j] += int(i < j)
            others[j] += 1


@njit(**EXACT)
def write_full_lists(
    begin: Whole, neighbour: NDArray[np.int32], lower: Whole, row_stride: int, item_stride: int,
    near: NDArray[np.int32],
) -> None:  # fmt: skip
    """Write all neighbours of each point in the order in which `sum_forces` adds their forces.

    Parameters
    ----------
    begin, neighbour
        Of `Pairs`, which have each pair once.
    lower : (n,) int array
        Number of points of lower number that list each point; these stand first, then the points
        that it lists itself, then those of higher number.
    row_stride, item_stride : int
        Neighbour k of point i is written to i row_stride + k item_stride.
    near : (any,) int32 array
        Written.
    """
    count = lower.shape[0]
    of_lower = np.zeros(count, np.int64)
    of_higher = np.empty(count, np.int64)
    for i in range(count):
        of_higher[i] = lower[i] + begin[i + 1] - begin[i]
    for i in range(count):
        for m in range(begin[i], begin[i + 1]):
            j = neighbour[m]
            k = lower[i] + m - begin[i]
            near[i * row_stride + k * item_stride] = j
            if i < j:
                near[j * row_stride + of_lower[j] * item_stride] = i
                of_lower[j] += 1
            else:
                near[j * row_stride + of_higher[j] * item_stride] = i
                of_higher[j] += 1
