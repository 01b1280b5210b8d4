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
