"""Which particles of bodies with the neighbours of the start may touch."""

import numpy as np
from scipy.spatial import cKDTree

from quintet.components.shared.search.verlet_list import furthest, slack
from quintet.components.sph_solid.kernels.pairs import Forces
from quintet.components.sph_solid.kernels.touching import push_apart, push_off_plane
from quintet.components.sph_solid.neighbours import SolidLists
from quintet.components.sph_solid.state import Array, Rows, State, Whole

SKIN = 0.5  # spacings


class Touching:
    """Contact between particles that were no neighbours at the start, and with planes of symmetry.

    Pairs are listed from places that are not saved: whichever are listed, those that touch are
    the same, and are summed in the same order.
    """

    def __init__(self, spacing: float) -> None:
        self.spacing = spacing
        self.pairs: Whole = np.zeros((0, 2), np.int64)
        self.listed: Array = np.zeros((0, 3))  # (n, 3) m, places when pairs were listed

    def make(self, state: State, lists: SolidLists) -> None:
        """Take the neighbours of the start."""
        self.support, self.start, self.group = lists.support, state.reference, lists.group(state)
        self.listed = np.full_like(state.reference, np.inf)
        self.ranks, self.contact = lists.ranks, lists.ranks.contact()
        self.planes = []
        for plane in lists.images.planes:
            depth = plane.inward * (state.reference[:, plane.axis] - plane.position)
            self.planes.append((plane, np.flatnonzero(2.0 * depth >= self.support)))

    def add(self, rows: Rows, density: Array, forces: Forces) -> None:
        """Add forces of contact, of densities (n + images,) kg/m3 at the start."""
        count = len(self.start)
        place = rows.place[:count, :3]
        is_old = float(not slack(SKIN * self.spacing, furthest(place, self.listed)) >= 0.0)
        if self.ranks.greatest(np.array([is_old]))[0]:
            self._list(place)
        columns = rows.place[:count], rows.motion[:count], density[:count, None]
        place, motion, densities = self.contact.extend(*columns)
        push_apart(self.pairs, place, motion, densities[:, 0], self.spacing, forces)
        for plane, mine in self.planes:
            push_off_plane(
                mine, plane.axis, plane.position, plane.inward, rows.place, rows.motion, density,
                self.spacing, forces,
            )  # fmt: skip

    def energy(self, state: State, density: Array, share: Array) -> float:
        """Energy [J] that contact stores in particles of all ranks, each with a share (n,) of it.

        Densities (n,) kg/m3 are those at the start; two particles of a pair store half each.
        """
        place, count = state.position, state.particles
        self._list(place)
        stiff = density * state.sound**2
        columns = np.column_stack([place, stiff, state.volume, share])
        (extended,) = self.contact.extend(columns)
        i, j = self.pairs.T
        x, y, z = (extended[i, :3] - extended[j, :3]).T
        depth = np.maximum(1.0 - np.sqrt(x * x + y * y + z * z) / self.spacing, 0.0)
        stiffs, volumes, shares = extended[:, 3], extended[:, 4], extended[:, 5]
        volume = np.sqrt(volumes[i] * volumes[j])
        energy = 0.125 * (shares[i] + shares[j]) * (stiffs[i] + stiffs[j]) * volume * depth * depth
        # Of each particle, in the order of its pairs, which is the same on any number of ranks.
        of_both = np.bincount(self.pairs.ravel(), np.repeat(0.5 * energy, 2), len(extended))
        stored = of_both[:count].astype(np.float64)  # of no pairs it counts integers
        for plane, rows in self.planes:
            apart = 2.0 * plane.inward * (place[rows, plane.axis] - plane.position)
            depth = np.maximum(1.0 - apart / self.spacing, 0.0)
            stored[rows] += 0.25 * share[rows] * stiff[rows] * state.volume[rows] * depth**2
        return float(self.ranks.sums(state, [stored])[0])

    def _list(self, place: Array) -> None:
        self.listed = place.copy()
        # What is not finite touches nothing; the step will say so.
        wrong = float(not np.isfinite(place).all())
        is_wrong = self.ranks.greatest(np.array([wrong]))[0] > 0.0
        empty = np.zeros((0, 2), np.int64)
        self.pairs = empty if is_wrong else self._pairs(place, (1.0 + SKIN) * self.spacing)

    def _pairs(self, place: Array, reach: float) -> Whole:
        """Rows of pairs (p, 2) nearer than a reach [m], that were no neighbours, in their order."""
        points, row = self.contact.find(np.ascontiguousarray(place), reach)
        pairs = cKDTree(points).query_pairs(reach, output_type="ndarray").astype(np.int64)
        pairs = row[pairs[np.lexsort((pairs[:, 1], pairs[:, 0]))]]
        start, group = self.contact.extend(self.start, self.group[:, None].astype(np.float64))
        apart = start[pairs[:, 0]] - start[pairs[:, 1]]
        were_far = (apart * apart).sum(axis=1) >= self.support * self.support
        other = group[pairs[:, 0], 0] != group[pairs[:, 1], 0]
        some = (pairs < len(self.start)).any(axis=1)  # not two copies
        return np.ascontiguousarray(pairs[(were_far | other) & some])
