"""Orthogonal recursive bisection: cells shared out so that each rank has as much work.

Berger & Bokhari, IEEE Trans. Comput. C-36 (1987) 570.
"""

import numpy as np
from numpy.typing import NDArray

from quintet.interfaces.component import Array
from quintet.interfaces.errors import SceneError

Whole = NDArray[np.int64]


def bisect(cells: Whole, weights: Array, ranks: int) -> Whole:
    """Share cells out by cuts across the longest extent, each part of about equal weight.

    A cut runs between two cells in the order of their places along the axis, then along the
    others, so that parts differ by one cell at most. Every rank computes the same from the same
    cells, whatever their order.

    Parameters
    ----------
    cells : (c, 3) int array
        Places of the cells on a lattice that is anchored to the world; each once.
    weights : (c,) float array
        Work of each, in any unit; not negative.
    ranks : int

    Returns
    -------
    (c,) int array
        The rank that owns each cell. Every rank has at least one.

    Raises
    ------
    SceneError
        If there are fewer cells than ranks.
    """
    if len(cells) < ranks:
        raise SceneError(
            f"ranks: each must have at least one cell of particles; there are {len(cells)} cells "
            f"for {ranks} ranks. Take at most {len(cells)}."
        )
    owner = np.zeros(len(cells), np.int64)
    parts = [(np.arange(len(cells)), 0, ranks)]
    while parts:
        rows, first, count = parts.pop()
        owner[rows] = first
        if count > 1:
            few = count // 2
            order = rows[_along_longest(cells[rows])]
            cut = _cut(weights[order], few, count)
            parts += [(order[:cut], first, few), (order[cut:], first + few, count - few)]
    return owner


def _along_longest(cells: Whole) -> Whole:
    """Order of cells along the axis of their longest extent, then along the others."""
    extent = cells.max(axis=0) - cells.min(axis=0)
    last, middle, first = np.argsort(extent, kind="stable").tolist()
    return np.lexsort((cells[:, last], cells[:, middle], cells[:, first]))


def _cut(weights: Array, few: int, count: int) -> int:
    """How many of the first cells have about few/count of the weight; each part has enough."""
    sums = np.cumsum(weights)
    share = sums[-1] * (few / count)
    cut = int(np.searchsorted(sums, share))
    # The cell across which the share ends goes to the side that it is more on.
    if cut < len(sums) and sums[cut] - share <= share - (sums[cut - 1] if cut else 0.0):
        cut += 1
    return min(max(cut, few), len(weights) - (count - few))
