"""Pairs of spheres of any sizes that overlap, by cells as wide as each size class needs."""

from collections.abc import Iterator
from itertools import product

import numpy as np

from quintet.interfaces.component import Array

CELLS = 2**20  # along an axis, at most: three of their numbers make one
BATCH = 1_000_000  # pairs that are looked at at a time
NEIGHBOURS = np.array(list(product((-1, 0, 1), repeat=3)))


def near_pairs(middle: Array, radius: Array) -> Iterator[tuple[Array, Array]]:
    """Pairs of spheres that overlap, each once, the first numbers and the second; (m,) twice.

    Spheres fall into classes of radii within a factor of two. Those of a class are put into cells
    of twice its largest radius, and searched by all that are not larger.

    Parameters
    ----------
    middle : (n, 3) float array, m
    radius : (n,) float array, m
    """
    size = np.floor(np.log2(radius / radius.min(initial=np.inf))) if len(radius) else radius
    for kind in np.unique(size)[::-1]:
        targets, seekers = np.flatnonzero(size == kind), np.flatnonzero(size <= kind)
        low, high = middle[seekers].min(axis=0), middle[seekers].max(axis=0)
        width = np.maximum(2.0 * radius[targets].max(), (high - low) / (CELLS - 3))
        cell = ((middle - low) / width).astype(np.int64) + 1
        key = _key(cell[targets])
        order = np.argsort(key, kind="stable")
        targets, key = targets[order], key[order]
        for step in NEIGHBOURS:
            sought = _key(cell[seekers] + step)
            begin, end = (np.searchsorted(key, sought, side) for side in ("left", "right"))
            for i, place in _expanded(begin, end):
                yield from _near(seekers[i], targets[place], middle, radius, size)


def _key(cell: Array) -> Array:
    return np.asarray((cell[:, 0] * CELLS + cell[:, 1]) * CELLS + cell[:, 2])


def _expanded(begin: Array, end: Array) -> Iterator[tuple[Array, Array]]:
    """All (row, place) with begin[row] <= place < end[row], some at a time."""
    count = end - begin
    upto = np.cumsum(count)
    row = 0
    while row < len(count):
        before = upto[row] - count[row]
        last = max(row + 1, int(np.searchsorted(upto, before + BATCH, "right")))
        rows = np.repeat(np.arange(row, last), count[row:last])
        place = np.arange(len(rows)) - (upto[rows] - count[rows] - before) + begin[rows]
        if len(rows):
            yield rows, place
        row = last


def _near(
    i: Array, j: Array, middle: Array, radius: Array, size: Array
) -> Iterator[tuple[Array, Array]]:
    once = (size[i] < size[j]) | (i < j)  # those of one class find each other twice
    i, j = i[once], j[once]
    near = np.linalg.norm(middle[i] - middle[j], axis=1) < radius[i] + radius[j]
    if near.any():
        yield i[near], j[near]
