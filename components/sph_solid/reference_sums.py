"""Sums over the neighbours of the start (total Lagrangian); only where a scene asks."""

import numpy as np

from quintet.components.shared.threads import Team
from quintet.components.sph_solid.kernels.pairs import Forces
from quintet.components.sph_solid.kernels.reference import (
    reference_accelerations,
    reference_gradients,
    write_nominal_stresses,
)
from quintet.components.sph_solid.laws import PairLaw
from quintet.components.sph_solid.neighbours import SolidLists
from quintet.components.sph_solid.state import Array, Rows, State
from quintet.components.sph_solid.touching import Touching


class ReferenceSums:
    """Sums over pairs that are neighbours for good.

    Parameters
    ----------
    penalty : float
        α of the force against motion that the deformation of neither particle sees.
    spacing : float, m
        At which particles touch that are no neighbours.
    team : Team
    """

    def __init__(self, penalty: float, spacing: float, team: Team) -> None:
        self.penalty, self.team = penalty, team
        self.touching = Touching(spacing)
        self.heats: Array | None = np.zeros((0, 3))
        self.nominal: Array = np.zeros((0, 12))
        self.deformed: Array = np.zeros((0, 12))

    def make(self, state: State, lists: SolidLists) -> None:
        """Take lists of where particles were at the start."""
        self.lists, self.start, self.images = lists.arrays, lists.points, lists.images
        self.nominal = np.zeros((len(self.start), 12))
        self.deformed = np.zeros((len(self.start), 12))
        self.heats = np.zeros((state.particles, 3))
        self.touching.make(state, lists)

    def contact_energy(self, state: State, density: Array, share: Array) -> float:
        """Energy [J] stored in contact, of each particle a share (n,); see `Touching.energy`."""
        return self.touching.energy(state, density, share)

    def write_gradients(self, rows: Rows, law: PairLaw) -> None:
        """Write gradients of velocity."""
        self.team.run(
            reference_gradients, len(rows.gradient), self.start, rows.place, rows.motion,
            self.lists, law, rows.gradient, rows.correction,
        )  # fmt: skip

    def write_accelerations(self, rows: Rows, law: PairLaw, forces: Forces) -> float:
        """Write accelerations and heating; return the greatest stable step [s]."""
        count = len(rows.gradient)
        self.team.run(
            write_nominal_stresses, count, self.start, rows.place, rows.stress, self.lists, law,
            self.nominal, self.deformed,
        )  # fmt: skip
        self.images.write_tensors(self.nominal, count)
        self.images.write_tensors(self.deformed, count)
        shares = self.team.run(
            reference_accelerations, count, self.start, rows.place, rows.motion, self.nominal,
            self.deformed, self.lists, law, self.penalty, forces, self.heats,
        )  # fmt: skip
        assert self.heats is not None
        touch = Forces(self.heats, forces.heating)
        self.touching.add(rows, self.nominal[:, 10], touch)
        np.add(forces.acceleration, self.heats, out=forces.acceleration)
        return min(slowest for slowest, _ in shares)
