"""The nearest points of places: of a few by all distances, of many by a tree.

The tree halves points along the axis of their widest spread: spacings differ by a thousand within
a cloud, so cells of one width do not serve. Ties go to the smaller number: which points are found
does not depend on the tree.
"""

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

from quintet.components.shared.numba_options import EXACT, INNER
from quintet.components.shared.threads import Team
from quintet.interfaces.component import Array

LEAF = 8  # points that are compared one by one
DEEPEST = 128  # ranges that wait


def nearest_rows(points: Array, places: Iterable[Sequence[float] | Array]) -> NDArray[np.int64]:
    """Rows (m,) of the points (n, 3) m nearest to places (m, 3) m; of equals the first."""
    rows = [int(((points - place) ** 2).sum(axis=1).argmin()) for place in places]
    return np.array(rows, np.int64)


def nearest(
    points: Array, among: NDArray[np.int64], targets: Array, count: int, team: Team
) -> tuple[NDArray[np.int64], Array]:
    """Find the nearest points of some targets; a point at the very place of a target is one too.

    Parameters
    ----------
    points : (n, 3) m
    among : (m,)
        Rows that may be found; at least `count`.
    targets : (t, 3) m
    count : int
    team : Team
        Threads.

    Returns
    -------
    (t, count) : rows, the nearest first
    (t, count) m2 : squares of the distances
    """
    order = among.astype(np.int64)
    axis, parted = np.zeros(len(order), np.int8), np.zeros(len(order))
    build(points, order, axis, parted)
    near = np.empty((len(targets), count), np.int64)
    squares = np.empty((len(targets), count))
    team.run(search, len(targets), points, order, axis, parted, targets, near, squares)
    return near, squares


@njit(**EXACT)
def build(points: Any, order: Any, axis: Any, parted: Any) -> None:
    """Sort rows so that the middle of each range parts it, along `axis` at `parted` [m]."""
    low, high = np.empty(DEEPEST, np.int64), np.empty(DEEPEST, np.int64)
    low[0], high[0], waiting = 0, order.shape[0], 1
    while waiting > 0:
        waiting -= 1
        first, last = low[waiting], high[waiting]
        if last - first <= LEAF:
            continue
        widest, width = 0, -1.0
        for d in range(3):
            least = most = points[order[first], d]
            for k in range(first + 1, last):
                x = points[order[k], d]
                least, most = min(least, x), max(most, x)
            if most - least > width:
                widest, width = d, most - least
        middle = (first + last) // 2
        part(points, order, first, last, middle, widest)
        axis[middle], parted[middle] = widest, points[order[middle], widest]
        low[waiting], high[waiting] = first, middle
        low[waiting + 1], high[waiting + 1] = middle, last
        waiting += 2


@njit(**INNER)
def part(points: Any, order: Any, first: int, last: int, middle: int, d: int) -> None:
    """Bring to `middle` the row that sorting along an axis would bring there; smaller ones below.

    Hoare, Commun. ACM 4 (1961) 321.
    """
    a, b = first, last - 1
    while a < b:
        pivot = points[order[(a + b) // 2], d]
        i, j = a, b
        while i <= j:
            while points[order[i], d] < pivot:
                i += 1
            while points[order[j], d] > pivot:
                j -= 1
            if i <= j:
                order[i], order[j] = order[j], order[i]
                i += 1
                j -= 1
        if middle <= j:
            b = j
        elif middle >= i:
            a = i
        else:
            return


@njit(**EXACT)
def search(
    first: int, last: int, points: Any, order: Any, axis: Any, parted: Any, targets: Any,
    near: Any, squares: Any,
) -> None:  # fmt: skip
    """Write the nearest points of targets."""
    low, high = np.empty(DEEPEST, np.int64), np.empty(DEEPEST, np.int64)
    bound = np.empty(DEEPEST)
    count = near.shape[1]
    for t in range(first, last):
        x, y, z = targets[t, 0], targets[t, 1], targets[t, 2]
        have = 0
        low[0], high[0], bound[0], waiting = 0, order.shape[0], 0.0, 1
        while waiting > 0:
            waiting -= 1
            begin, end, away = low[waiting], high[waiting], bound[waiting]
            if have == count and away > squares[t, count - 1]:
                continue
            if end - begin <= LEAF:
                for k in range(begin, end):
                    j = order[k]
                    a, b, c = points[j, 0] - x, points[j, 1] - y, points[j, 2] - z
                    have = put(near[t], squares[t], have, j, a * a + b * b + c * c)
                continue
            middle = (begin + end) // 2
            d = axis[middle]
            beyond = targets[t, d] - parted[middle]
            far = max(away, beyond * beyond)
            # The nearer half last, so that it is looked at first.
            low[waiting], high[waiting], bound[waiting] = begin, middle, far
            low[waiting + 1], high[waiting + 1], bound[waiting + 1] = middle, end, far
            if beyond < 0.0:
                low[waiting], high[waiting] = middle, end
                low[waiting + 1], high[waiting + 1] = begin, middle
            bound[waiting + 1] = away
            waiting += 2


@njit(**INNER)
def put(near: Any, squares: Any, have: int, j: int, square: float) -> int:
    """Put a point among the nearest, sorted by distance and then by number; return how many."""
    count = near.shape[0]
    place = have if have < count else count - 1
    if have == count and not (
        square < squares[place] or (square == squares[place] and j < near[place])
    ):
        return have
    while place > 0 and (
        square < squares[place - 1] or (square == squares[place - 1] and j < near[place - 1])
    ):
        squares[place], near[place] = squares[place - 1], near[place - 1]
        place -= 1
    squares[place], near[place] = square, j
    return min(have + 1, count)
