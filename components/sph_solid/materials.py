"""The materials of all particles: their laws, and stresses over a step."""

import numpy as np

from quintet.components.shared.materials.solid import Solid
from quintet.components.shared.threads import Team
from quintet.components.sph_solid.kernels.material import (
    Points,
    advance,
    write_artificial,
    write_stresses,
)
from quintet.components.sph_solid.laws import PairLaw
from quintet.components.sph_solid.state import Array, Rows, State


class Materials:
    """Laws of the materials, and which particles have each.

    Parameters
    ----------
    laws : list of Solid
        One for each material.
    team : Team
    """

    def __init__(self, laws: list[Solid], team: Team) -> None:
        self.laws, self.team = laws, team
        self.density = np.array([law.density for law in laws])  # kg/m3, at the start

    def take(self, state: State) -> None:
        """Find the particles of each material, after their order has changed."""
        self.rows = [np.flatnonzero(state.material == k) for k in range(len(self.laws))]
        self.points = Points(
            state.deviator, state.density_ratio, state.pressure, state.energy, state.strain,
            state.temperature, state.damage, state.failed, state.sound, state.heating,
        )  # fmt: skip

    def mass(self, state: State) -> Array:
        """Mass (n,) kg of each particle."""
        return np.asarray(state.volume * self.density[state.material])

    def advance(self, rows: Rows, dt: float) -> None:
        """Advance stresses and energies by a step of dt [s]."""
        for law, particles in zip(self.laws, self.rows, strict=True):
            self.team.run(
                advance, len(particles), particles, self.points, rows.gradient, rows.correction,
                law, dt,
            )  # fmt: skip

    def write_stresses(self, state: State, rows: Rows, law: PairLaw) -> None:
        """Write the rows of stress of all particles."""
        count = state.particles
        self.team.run(
            write_stresses, count, self.density, state.material, self.points, rows.correction,
            rows.stress,
        )  # fmt: skip
        if law.artificial is not None:
            self.team.run(write_artificial, count, law.artificial, rows.stress)
