"""Neighbour lists of a lattice: each pair once, also across periodic sides."""

import math

import numpy as np

from quintet.components.particle_dynamics.kernels.forces import Pairs
from quintet.components.particle_dynamics.kernels.motion import EARLY
from quintet.components.particle_dynamics.kernels.pair_lists import write_pairs
from quintet.components.particle_dynamics.state import Whole
from quintet.components.shared.search.cells import corners, grid_between, sorted_into
from quintet.components.shared.search.neighbours import neighbours_within
from quintet.components.shared.search.verlet_list import furthest, slack
from quintet.components.shared.threads import Team
from quintet.interfaces.component import Array

TEAM = Team(1)
SKIN = 0.1  # of the cut-off


class Neighbours:
    """Lists of all pairs within the cut-off and a skin.

    Parameters
    ----------
    cutoff2 : float, m2
        Square of the cut-off.
    lowest : (3,) float array, m
    period : (6,) float array, m and 1/m, or None
        As in `pairs_within`.
    """

    def __init__(self, cutoff2: float, lowest: Array, period: Array | None) -> None:
        self.skin = SKIN * math.sqrt(cutoff2)  # m
        self.reach = math.sqrt(cutoff2) + self.skin
        self.lowest, self.period = lowest, period
        self.pairs = Pairs(np.zeros(1, np.int64), np.zeros(0, np.int32))

    def rebuild(self, position: Array) -> None:
        """List the pairs of points at positions (n, 3) m."""
        self.pairs = pairs_within(self.reach, position, self.lowest, self.period)

    def needs_rebuild(self, position: Array, listed: Array) -> bool:
        """Whether unlisted points may interact soon; `listed` are positions of the last rebuild."""
        return slack(EARLY * self.skin, furthest(position, listed)) < 0.0


def pairs_within(
    reach: float,
    position: Array,
    lowest: Array,
    period: Array | None,
    bounds: tuple[Array, Array] | None = None,
) -> Pairs:
    """List all pairs within a reach.

    Parameters
    ----------
    reach : float, m
    position : (n, 3) float array, m
    lowest : (3,) float array, m
        Where periodic sides begin.
    period : (6,) float array, m and 1/m, or None
        Lengths of periodic sides and their inverses, 0 of open ones.
    bounds : two (3,) float arrays, m
        Corners of a box that holds the points, by which they are sorted; by default of the least.
    """
    points = wrapped(position, lowest, period)
    across, source = images(points, reach, lowest, period)
    low, high = bounds or corners(points)
    grid = grid_between(low, high, reach)
    order = sorted_into(points, grid)[2]
    if len(across):
        # Sorted by the cells of the first group, which alone searches for them.
        rising = sorted_into(across, grid)[2]
        across, source = across[rising], source[rising]
    count = len(points)
    everything = np.concatenate([points[order], across])
    lists = neighbours_within(reach, everything, count, TEAM, grid=grid)
    place = np.empty(count, np.int64)
    place[order] = np.arange(count)
    begin: Whole = np.zeros(count + 1, np.int64)
    room = int((lists.end - lists.begin).sum())
    neighbour = np.empty(room, np.int32)
    written = write_pairs(lists.arrays, place, order, source, begin, neighbour)
    return Pairs(begin, neighbour[:written].copy())


def wrapped(position: Array, lowest: Array, period: Array | None) -> Array:
    """Points (n, 3) m between the periodic sides."""
    if period is None:
        return position
    return np.asarray(position - period[:3] * np.floor((position - lowest) * period[3:]))


def images(points: Array, reach: float, lowest: Array, period: Array | None) -> tuple[Array, Whole]:
    """Images (m, 3) m of points near periodic sides, and the numbers (m,) of these points."""
    places, source = points, np.arange(len(points))
    sides = np.zeros(3) if period is None else period[:3]
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
