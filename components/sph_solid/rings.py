"""Rings about the z axis, each seen from the plane as cuts of itself; only where a scene asks."""

import numpy as np

from quintet.components.shared.threads import Team
from quintet.components.sph_solid.kernels.pairs import Forces
from quintet.components.sph_solid.kernels.rotated import (
    CLOSE,
    Doubles,
    cuts,
    list_doubles,
    ring_accelerations,
    ring_gradients,
    turns,
)
from quintet.components.sph_solid.laws import PairLaw
from quintet.components.sph_solid.neighbours import SolidLists
from quintet.components.sph_solid.state import Array, Rows, State

ROOM = 80  # cuts that there is room for near each ring, at first


class Rings:
    """Sums over pairs of rings."""

    heats: Array | None = None

    def contact_energy(self, state: State, density: Array) -> float:
        """None: all pairs are alike."""
        return 0.0

    def __init__(self, length: float, team: Team) -> None:
        self.length, self.team = length, team
        self.most, self.room = 0, ROOM  # cuts in the table, and near a ring
        none, empty = np.zeros(0, np.int64), np.zeros(0, np.int32)
        self.doubles = Doubles(none, none, empty, empty, turns(0))

    def make(self, state: State, lists: SolidLists) -> None:
        """List cuts of the rings that are near in the plane."""
        numbers = cuts(lists.points[:, 0], self.length)
        most, count = int(numbers.max()), state.particles
        if most > self.most:
            self.most = 2 * most
            self.doubles = self.doubles._replace(turn=turns(self.most))
        begin, end = np.empty(count, np.int64), np.empty(count, np.int64)
        while True:
            size = self.room * count
            if len(self.doubles.ring) < size:
                empty = np.empty(size, np.int32), np.empty(size, np.int32)
                self.doubles = self.doubles._replace(ring=empty[0], row=empty[1])
            self.doubles = self.doubles._replace(begin=begin, end=end)
            found = self.team.run(
                list_doubles, count, lists.points, numbers, state.reach, CLOSE * self.length,
                lists.arrays, self.room, self.doubles,
            )  # fmt: skip
            if max(found) <= self.room:
                return
            self.room = 2 * max(found)

    def write_gradients(self, rows: Rows, law: PairLaw) -> None:
        """Gradients of velocity."""
        self.team.run(
            ring_gradients, len(rows.gradient), rows.place, rows.motion, self.doubles, law,
            rows.gradient, rows.correction,
        )  # fmt: skip

    def write_accelerations(self, rows: Rows, law: PairLaw, forces: Forces) -> float:
        """Accelerations and heating; return the step [s] that all bear."""
        found = self.team.run(
            ring_accelerations, len(rows.gradient), rows.place, rows.motion, rows.stress,
            self.doubles, law, forces,
        )  # fmt: skip
        return min(slowest for slowest, _ in found)
