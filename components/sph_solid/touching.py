"""Which particles of bodies with the neighbours of the start may touch."""

import numpy as np
from scipy.spatial import cKDTree

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
        moved = place - self.listed
        if not (moved * moved).sum(axis=1).max(initial=0.0) <= (0.5 * SKIN * self.spacing) ** 2:
            self._list(place)
        push_apart(self.pairs, rows.place, rows.motion, density, self.spacing, forces)
        for plane, mine in self.planes:
            push_off_plane(
                mine, plane.axis, plane.position, plane.inward, rows.place, rows.motion, density,
                self.spacing, forces,
            )  # fmt: skip

    def _list(self, place: Array) -> None:
        self.listed = place.copy()
        self.pairs = np.zeros((0, 2), np.int64)
        if not np.isfinite(place).all():
            return  # the step will say so
        reach = (1.0 + SKIN) * self.spacing
        pairs = cKDTree(place).query_pairs(reach, output_type="ndarray").astype(np.int64)
        apart = self.start[pairs[:, 0]] - self.start[pairs[:, 1]]
        were_far = (apart * apart).sum(axis=1) >= self.support * self.support
        pairs = pairs[were_far | (self.group[pairs[:, 0]] != self.group[pairs[:, 1]])]
        self.pairs = np.ascontiguousarray(pairs[np.lexsort((pairs[:, 1], pairs[:, 0]))])
