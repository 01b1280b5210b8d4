"""Lists of the pairs of a rank's spheres, with copies of those of other ranks that are near.

A rank has copies of all spheres within reach of the box around its own.
"""

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from quintet.components.particle_dynamics.spheres.ranks.several import SeveralRanks
from quintet.components.particle_dynamics.spheres.sweeps import Moving
from quintet.components.shared.domain.exchange import send_rows, share
from quintet.components.shared.domain.halo import Halo
from quintet.components.shared.search.cells import corners
from quintet.components.shared.search.sphere_pairs import SKIN, Pairs, pairs_near
from quintet.components.shared.search.verlet_list import furthest, slack
from quintet.interfaces.component import Array

Whole = NDArray[np.int64]
WIDER = 1.0 + 1e-9  # times a reach, for what is rounded


class Lists:
    """Own spheres and copies, own ones first; all ranks call every method alike.

    Parameters
    ----------
    ranks : SeveralRanks
    largest : float, m
        Radius of the largest sphere of all.
    """

    def __init__(self, ranks: SeveralRanks, largest: float) -> None:
        self._ranks = ranks
        self.skin, self._width = 2.0 * SKIN * largest, 2.0 * (1.0 + SKIN) * largest  # m
        self.moved = np.inf  # m, furthest that a sphere is from where it was listed
        self.were_made = False  # since that was last looked at
        nobody = [np.zeros(0, np.int64)] * ranks.communicator.size
        self._set_copies(np.zeros((0, 6)), nobody, nobody)
        self.pairs = Pairs(np.zeros(len(ranks.ids) + 1, np.int64), np.zeros(0, np.int64))
        self.forget()

    def forget(self) -> None:
        """Make new lists when they are next needed."""
        self._listed = np.full((len(self._ranks.ids), 3), np.inf)  # m, where spheres were listed

    @property
    def copies(self) -> int:
        """Number of copies."""
        return len(self._copies)

    @property
    def ids(self) -> Whole:
        """Numbers (n,) of own spheres and copies."""
        return np.concatenate([self._ranks.ids, self._copies[:, 5].astype(np.int64)])

    @property
    def radius(self) -> Array:
        """Radii (n,) m of own spheres and copies."""
        return np.concatenate([self._ranks.spheres.radius, self._copies[:, 3]])

    def update(self, position: Array) -> None:
        """Make lists again if own spheres at positions (m, 3) m, or others, have moved too far."""
        self.moved = self._ranks.greatest(furthest(position, self._listed))
        if not slack(self.skin, self.moved) > 0.0:
            self.make(position)

    def make(self, position: Array) -> None:
        """Copy what is near own spheres at positions (m, 3) m, and list pairs."""
        ranks = self._ranks
        communicator, spheres = ranks.communicator, ranks.spheres
        low, high = corners(position)
        boxes = share(communicator, np.concatenate([low - self._width * WIDER,
                                                    high + self._width * WIDER]))  # fmt: skip
        sent = [_within(position, box) for box in boxes]
        sent[communicator.rank] = np.zeros(0, np.int64)
        rows = np.column_stack([position, spheres.radius, spheres.mass, ranks.ids])
        coming = send_rows(communicator, [rows[part] for part in sent])
        ends = np.cumsum([0, *map(len, coming)])
        self._set_copies(np.concatenate(coming), sent, [np.arange(a, b) for a, b in pairwise(ends)])
        points = np.concatenate([position, self._copies[:, :3]])
        room = Pairs(np.zeros(len(points) + 1, np.int64), self.pairs.other)
        self.pairs = pairs_near(points, self.radius, self._width, self.skin, room)
        # Pairs of copies are the business of others.
        self.pairs.begin[len(position) :] = self.pairs.begin[len(position)]
        self._listed, self.moved, self.were_made = position.copy(), 0.0, True

    def _set_copies(self, copies: Array, sent: list[Whole], received: list[Whole]) -> None:
        self._copies = copies  # (c, 6) m, m, kg and 1: position, radius, mass, number
        communicator = self._ranks.communicator
        self._positions = Halo(communicator, sent, received, (3,))
        self._motion = Halo(communicator, sent, received, (3, 3, 3, 1))

    def with_copies(self, position: Array) -> Array:
        """Positions (n, 3) m of own spheres (m, 3) m, and of copies."""
        copies = np.empty((self.copies, 3))
        self._positions.begin(position)
        self._positions.finish(copies)
        return np.concatenate([position, copies])

    def moving(self, acceleration: Array) -> Moving:
        """Own spheres, with accelerations (m, 3) m/s2, and copies."""
        spheres, state = self._ranks.spheres, self._ranks.state
        launched = state.launched.astype(np.float64)[:, None]
        sent = state.position, state.velocity, acceleration, launched
        copies = [np.empty((self.copies, array.shape[1])) for array in sent]
        self._motion.begin(*sent)
        self._motion.finish(*copies)
        rows = [np.concatenate(pair) for pair in zip(sent, copies, strict=True)]
        mass = np.concatenate([spheres.mass, self._copies[:, 4]])
        return Moving(rows[0], rows[1], rows[2], self.radius, mass, rows[3][:, 0] != 0.0)


def _within(points: Array, box: Array) -> Whole:
    """Rows of points (n, 3) m in a box (6,) m."""
    inside = np.ones(len(points), bool)
    for axis in range(3):
        along = points[:, axis]
        inside &= (along > box[axis]) & (along < box[3 + axis])
    return np.flatnonzero(inside)
