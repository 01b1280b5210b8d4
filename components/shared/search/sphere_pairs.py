"""Pairs of spheres that are near each other, found by cells, kept until spheres have moved.

Cells have keys, so that spheres may be as far apart as they like. A list holds pairs whose surfaces
are nearer than a skin; as impacts look at the pairs that overlap, and these stand in the same order
in any list that has them, a list is no state: made again it changes no bit.
"""

from typing import NamedTuple

import numpy as np
from numba import njit

from quintet.components.shared.numba_options import EXACT
from quintet.components.shared.search.cells import (
    BITS,
    LAYER,
    ROW,
    Whole,
    keys_of,
    number_along,
    row_of_keys,
)
from quintet.components.shared.search.verlet_list import furthest, slack
from quintet.interfaces.component import Array

SKIN = 0.5  # of the largest diameter
GROWTH = 2  # of the memory that was too small


class Pairs(NamedTuple):
    """For each sphere those near it with a higher number, in their order."""

    begin: Whole  # (n + 1,)
    other: Whole  # (any,)


@njit(**EXACT)
def list_pairs(
    position: Array, radius: Array, order: Whole, keys: Whole, width: float, skin: float,
    begin: Whole, other: Whole,
) -> int:  # fmt: skip
    """List pairs whose surfaces are nearer than a skin.

    Parameters
    ----------
    position, radius : (n, 3) and (n,) float array, m
    order, keys : (n,) int array
        Numbers of the spheres by the key of their cell, and these keys, ascending.
    width, skin : float, m
        Width of the cells, at least the largest diameter and the skin.
    begin, other : (n + 1,) and (m,) int array
        Written: as in `Pairs`.

    Returns
    -------
    int
        How many pairs there are; what is beyond m is not written.
    """
    k = 0
    for i in range(position.shape[0]):
        begin[i] = k
        x, y, z = position[i, 0], position[i, 1], position[i, 2]
        middle = number_along(z, width) << 2 * BITS
        middle += (number_along(y, width) << BITS) + number_along(x, width)
        for layer in range(-1, 2):
            for row in range(-1, 2):
                key = middle + layer * LAYER + row * ROW
                first, last = row_of_keys(keys, key - 1, key + 1)
                for place in range(first, last):
                    j = order[place]
                    if j <= i:
                        continue
                    dx, dy, dz = x - position[j, 0], y - position[j, 1], z - position[j, 2]
                    reach = radius[i] + radius[j] + skin
                    if dx * dx + dy * dy + dz * dz >= reach * reach:
                        continue
                    if k < other.shape[0]:
                        # Sorted as it is put in: there are few.
                        at = k
                        while at > begin[i] and other[at - 1] > j:
                            other[at] = other[at - 1]
                            at -= 1
                        other[at] = j
                    k += 1
    begin[position.shape[0]] = k
    return k


def pairs_near(position: Array, radius: Array, width: float, skin: float, room: Pairs) -> Pairs:
    """List pairs whose surfaces are nearer than a skin.

    Parameters
    ----------
    position, radius : (n, 3) and (n,) float array, m
    width, skin : float, m
        As of `list_pairs`.
    room : Pairs
        Of as many spheres; written, and returned if it is large enough.
    """
    keys = keys_of(position, np.arange(len(position)), width)
    order = np.argsort(keys, kind="stable")
    arguments = position, radius, order, keys[order], width, skin
    count = list_pairs(*arguments, *room)
    if count > len(room.other):
        room = room._replace(other=np.zeros(GROWTH * count, np.int64))
        list_pairs(*arguments, *room)
    return room


class NearPairs:
    """The pairs of one set of spheres, listed again when they have moved by half of the skin."""

    def __init__(self, radius: Array) -> None:
        self.radius, largest = radius, 2.0 * float(radius.max())
        self.skin, self.width = SKIN * largest, (1.0 + SKIN) * largest  # m
        self.listed = np.full((len(radius), 3), np.inf)  # m, where they were when listed
        self.pairs = Pairs(np.zeros(len(radius) + 1, np.int64), np.zeros(0, np.int64))

    def at(self, position: Array) -> Pairs:
        """All pairs that overlap at positions (n, 3) m, and some that do not."""
        if not slack(self.skin, furthest(position, self.listed)) > 0.0:
            self._list(position)
        return self.pairs

    def _list(self, position: Array) -> None:
        self.pairs = pairs_near(position, self.radius, self.width, self.skin, self.pairs)
        self.listed[:] = position
