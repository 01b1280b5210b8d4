"""Sums over pairs of particles, from the lists of what is near."""

from collections.abc import Callable
from typing import Protocol

from quintet.components.shared.search.neighbours import Lists
from quintet.components.shared.threads import Team
from quintet.components.sph_solid.kernels.azimuthal_images import AzimuthalImages
from quintet.components.sph_solid.kernels.pairs import Forces, accelerations, velocity_gradients
from quintet.components.sph_solid.laws import PairLaw
from quintet.components.sph_solid.neighbours import SolidLists
from quintet.components.sph_solid.state import Array, Rows, State


class PairSums(Protocol):
    """Sums over pairs that a step needs.

    `heats` (n, 3) m/s2 are accelerations by forces that heat (viscosity, penalty, contact) and that
    act beside those of stresses; None where no such forces are summed by themselves.
    """

    heats: Array | None

    def contact_energy(self, state: State, density: Array, share: Array) -> float:
        """Energy [J] stored in contact, of each particle a share (n,); see `Touching.energy`."""

    def make(self, state: State, lists: SolidLists) -> None:
        """Take lists that were just made."""

    def write_gradients(self, rows: Rows, law: PairLaw) -> None:
        """Write gradients of velocity."""

    def write_accelerations(self, rows: Rows, law: PairLaw, forces: Forces) -> float:
        """Write accelerations and heating; return the greatest stable step [s]."""


class CurrentSums:
    """Sums over particles that are near now.

    Parameters
    ----------
    neighbours
        Makes what kernels take from the lists: the lists, or azimuthal images of rings.
    team
    """

    heats: Array | None = None

    def __init__(
        self, neighbours: Callable[[State, SolidLists], Lists | AzimuthalImages], team: Team
    ) -> None:
        self.neighbours, self.team = neighbours, team

    def contact_energy(self, state: State, density: Array, share: Array) -> float:
        """None: stresses alone act in contact."""
        return 0.0

    def make(self, state: State, lists: SolidLists) -> None:
        """Take lists that were just made."""
        self.lists = self.neighbours(state, lists)

    def write_gradients(self, rows: Rows, law: PairLaw) -> None:
        """Write gradients of velocity."""
        self.team.run(
            velocity_gradients, len(rows.gradient), rows.place, rows.motion, self.lists, law,
            rows.gradient, rows.correction,
        )  # fmt: skip

    def write_accelerations(self, rows: Rows, law: PairLaw, forces: Forces) -> float:
        """Write accelerations and heating; return the greatest stable step [s]."""
        shares = self.team.run(
            accelerations, len(rows.gradient), rows.place, rows.motion, rows.stress, self.lists,
            law, forces,
        )  # fmt: skip
        return min(slowest for slowest, _ in shares)
