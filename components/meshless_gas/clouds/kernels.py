"""The k nearest points, by a tree that halves them along the axis of their widest spread."""

from typing import Any

import numpy as np
from numba import njit

from quintet.components.shared.numba_options import EXACT, INNER

LEAF = 8  # points that are compared one by one


DEEPEST = 128  # ranges that wait


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
    first: int,
    last: int,
    points: Any,
    order: Any,
    axis: Any,
    parted: Any,
    targets: Any,
    near: Any,
    squares: Any,
) -> None:
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
