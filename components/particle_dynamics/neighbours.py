"""Neighbour lists of a lattice: each pair once, across periodic sides too."""

import numpy as np
from numba import njit

from quintet.components.particle_dynamics.kernels.forces import Pairs, Whole
from quintet.components.shared.numba_options import EXACT
from quintet.components.shared.search.cells import grid_around, sorted_into
from quintet.components.shared.search.neighbours import Lists, neighbours_within
from quintet.components.shared.threads import Team
from quintet.interfaces.component import Array

TEAM = Team(1)


def pairs_within(reach: float, position: Array, lowest: Array, period: Array | None) -> Pairs:
    """List all pairs that are nearer than a reach.

    Parameters
    ----------
    reach : float, m
    position : (n, 3) float array, m
    lowest : (3,) float array, m
        Where periodic sides begin.
    period : (6,) float array, m and 1/m, or None
        Lengths of periodic sides and their inverses, 0 of open ones.
    """
    points, source = position, np.arange(len(position))
    images: Array = np.empty((0, 3))
    if period is not None:
        sides = period[:3]
        points = position - sides * np.floor((position - lowest) * period[3:])
        images, source = _images(points, reach, lowest, sides)
    order = sorted_into(points, grid_around(points, reach))[2]
    if len(images):
        # Sorted by the cells of the first group, which is the only one that looks for them.
        mine = sorted_into(images, grid_around(points, reach))[2]
        images, source = images[mine], source[mine]
    count = len(points)
    found = neighbours_within(reach, np.concatenate([points[order], images]), count, TEAM)
    place = np.empty(count, np.int64)
    place[order] = np.arange(count)
    begin: Whole = np.zeros(count + 1, np.int64)
    room = int((found.end - found.begin).sum())
    neighbour = np.empty(room, np.int32)
    written = _write_pairs(found.arrays, place, order, source, begin, neighbour)
    return Pairs(begin, neighbour[:written].copy())


def _images(points: Array, reach: float, lowest: Array, sides: Array) -> tuple[Array, Whole]:
    """Images (m, 3) m of points near periodic sides, and of which points."""
    places, source = points, np.arange(len(points))
    for axis in range(3):
        if sides[axis] == 0.0:
            continue
        low = places[:, axis] < lowest[axis] + reach
        high = places[:, axis] > lowest[axis] + sides[axis] - reach
        shift = np.zeros(3)
        shift[axis] = sides[axis]
        places = np.concatenate([places, places[low] + shift, places[high] - shift])
        source = np.concatenate([source, source[low], source[high]])
    return places[len(points) :], source[len(points) :]


@njit(**EXACT)
def _write_pairs(
    lists: Lists, place: Whole, order: Whole, source: Whole, begin: Whole, neighbour: Whole
) -> int:
    """Write each pair of full lists once, in the order of the points; return how many."""
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
