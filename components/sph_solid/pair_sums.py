"""Sums over pairs of particles, from the lists of what is near."""

from typing import Protocol

from quintet.components.shared.threads import Team
from quintet.components.sph_solid.kernels.pairs import Forces, accelerations, velocity_gradients
from quintet.components.sph_solid.laws import PairLaw
from quintet.components.sph_solid.method import method
from quintet.components.sph_solid.neighbours import SolidLists
from quintet.components.sph_solid.params import SphSolidParams
from quintet.components.sph_solid.state import Array, Rows, State

PENALTY = 1.0  # α of Ganzenmüller's force against motion that no deformation sees


class PairSums(Protocol):
    """What a step asks of pairs: of particles, or of rings about an axis.

    `heats` (n, 3) m/s2 is what conservative forces beside stresses accelerate by; None without.
    """

    heats: Array | None

    def contact_energy(self, state: State, density: Array) -> float:
        """Energy [J] that is stored in contact, of densities (n,) kg/m3 at the start."""

    def make(self, state: State, lists: SolidLists) -> None:
        """Take lists that were just made."""

    def write_gradients(self, rows: Rows, law: PairLaw) -> None:
        """Gradients of velocity."""

    def write_accelerations(self, rows: Rows, law: PairLaw, forces: Forces) -> float:
        """Accelerations and heating; return the step [s] that all bear."""


class ParticleSums:
    """Sums over pairs of particles, and of their images."""

    heats: Array | None = None

    def contact_energy(self, state: State, density: Array) -> float:
        """None: all pairs are alike."""
        return 0.0

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


def pair_sums(params: SphSolidParams, team: Team) -> PairSums:
    """Sums over particles, over rings, or over the neighbours of the start."""
    if params.axisymmetric:
        # Rings are left out of scenes that have none.
        from quintet.components.sph_solid.rings import Rings

        return Rings(params.length, team)
    if method(params).total_lagrangian:
        # So are sums over the neighbours of the start.
        from quintet.components.sph_solid.reference_sums import ReferenceSums

        return ReferenceSums(PENALTY, params.spacing, team)
    return ParticleSums(team)
