"""Sums over pairs of particles, from the lists of what is near."""

from typing import Protocol

from quintet.components.shared.threads import Team
from quintet.components.sph_solid.kernels.pairs import Forces, accelerations, velocity_gradients
from quintet.components.sph_solid.laws import PairLaw
from quintet.components.sph_solid.neighbours import SolidLists
from quintet.components.sph_solid.state import Rows, State


class PairSums(Protocol):
    """What a step asks of pairs: of particles, or of rings about an axis."""

    def make(self, state: State, lists: SolidLists) -> None:
        """Take lists that were just made."""

    def write_gradients(self, rows: Rows, law: PairLaw) -> None:
        """Gradients of velocity."""

    def write_accelerations(self, rows: Rows, law: PairLaw, forces: Forces) -> float:
        """Accelerations and heating; return the step [s] that all bear."""


class ParticleSums:
    """Sums over pairs of particles, and of their images."""

    def __init__(self, team: Team) -> None:
        self.team = team

    def make(self, state: State, lists: SolidLists) -> None:
        """Take lists that were just made."""
        self.lists = lists.arrays

    def write_gradients(self, rows: Rows, law: PairLaw) -> None:
        """Gradients of velocity."""
        self.team.run(
            velocity_gradients, len(rows.gradient), rows.place, rows.motion, self.lists, law,
            rows.gradient, rows.correction,
        )  # fmt: skip

    def write_accelerations(self, rows: Rows, law: PairLaw, forces: Forces) -> float:
        """Accelerations and heating; return the step [s] that all bear."""
        found = self.team.run(
            accelerations, len(rows.gradient), rows.place, rows.motion, rows.stress, self.lists,
            law, forces,
        )  # fmt: skip
        return min(slowest for slowest, _ in found)


def pair_sums(is_axisymmetric: bool, length: float, team: Team) -> PairSums:
    """Sums over particles, or over rings."""
    if is_axisymmetric:
        # Rings are left out of scenes that have none.
        from quintet.components.sph_solid.rings import Rings

        return Rings(length, team)
    return ParticleSums(team)
