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
        self.planes = []
        for plane in lists.images.planes:
            depth = plane.inward * (state.reference[:, plane.axis] - plane.position)
            self.planes.append((plane, np.flatnonzero(2.0 * depth >= self.support)))

    def add(self, rows: Rows, density: Array, forces: Forces) -> None:
        """Add forces of contact, of densities (n + images,) kg/m3 at the start."""
        place = rows.place[: len(self.start), :3]
        if not slack(SKIN * self.spacing, furthest(place, self.listed)) >= 0.0:
            self._list(place)
        push_apart(self.pairs, rows.place, rows.motion, density, self.spacing, forces)
        for plane, mine in self.planes:
            push_off_plane(
                mine, plane.axis, plane.position, plane.inward, rows.place, rows.motion, density,
                self.spacing, forces,
            )  # fmt: skip

    def energy(self, state: State, density: Array, share: Array) -> float:
        """Energy [J] that contact stores in particles, each with a share (n,) of its own part.

        Densities (n,) kg/m3 are those at the start; two particles of a pair store half each.
        """
        place, stiff = state.position, density * state.sound**2
        i, j = self._pairs(place, 1.0).T
        depth = 1.0 - np.linalg.norm(place[i] - place[j], axis=1) / self.spacing
        volume = np.sqrt(state.volume[i] * state.volume[j])
        shares = 0.5 * (share[i] + share[j])
        stored = 0.25 * float((shares * (stiff[i] + stiff[j]) * volume * depth**2).sum())
        for plane, rows in self.planes:
            apart = 2.0 * plane.inward * (place[rows, plane.axis] - plane.position)
            depth = np.maximum(1.0 - apart / self.spacing, 0.0)
            energies = share[rows] * stiff[rows] * state.volume[rows] * depth**2
            stored += 0.25 * float(energies.sum())
        return stored

    def _list(self, place: Array) -> None:
        self.listed = place.copy()
        # What is not finite touches nothing; the step will say so.
        empty = np.zeros((0, 2), np.int64)
        self.pairs = self._pairs(place, 1.0 + SKIN) if np.isfinite(place).all() else empty

    def _pairs(self, place: Array, reach: float) -> Whole:
        """Pairs (p, 2) nearer than so many spacings, that were no neighbours, in their order."""
        tree = cKDTree(place)
        pairs = tree.query_pairs(reach * self.spacing, output_type="ndarray").astype(np.int64)
        apart = self.start[pairs[:, 0]] - self.start[pairs[:, 1]]
        were_far = (apart * apart).sum(axis=1) >= self.support * self.support
        pairs = pairs[were_far | (self.group[pairs[:, 0]] != self.group[pairs[:, 1]])]
        return np.ascontiguousarray(pairs[np.lexsort((pairs[:, 1], pairs[:, 0]))])
