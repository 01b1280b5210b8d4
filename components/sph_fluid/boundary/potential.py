"""Walls and samples whose pressure a contact potential stands for; imported where one asks."""

import numpy as np

from quintet.components.shared.search.neighbours import Lists
from quintet.components.shared.threads import Team
from quintet.components.sph_fluid.boundary.contact_potential import ContactStiffness
from quintet.components.sph_fluid.boundary.samples import Samples
from quintet.components.sph_fluid.boundary.symmetry_planes import SymmetryPlanes
from quintet.components.sph_fluid.params import SphFluidParams
from quintet.components.sph_fluid.state import Array, State, Whole
from quintet.interfaces.component import Fields


class PotentialBoundary:
    """A boundary without density or pressure of its own."""

    reads_images = False

    def __init__(self, params: SphFluidParams, samples: Samples) -> None:
        self.samples, self.stiffness = samples, ContactStiffness(params)
        self.contact, self.mask = self.stiffness.numbers, np.zeros(0)
        self.by_potential: Whole = np.zeros(0, np.int64)

    def start(self, state: State) -> None:
        """Set the stiffness of all walls."""
        rows = np.arange(state.fluid, state.particles)
        self.stable_dt = self.stiffness.write(state, rows)

    def join(self, state: State, static: Fields) -> None:
        """Find that all samples are under it; they are stiff once they are placed."""
        self.by_potential = np.arange(len(self.samples.volume))

    def follow_samples(self, state: State, fields: Fields, first: int = 0) -> None:
        """Set the stiffness of samples where they are."""
        self.stiffness.write(state, self.samples.row, self.samples.body)
        self.load(state)

    def load(self, state: State) -> None:
        """Find the step limit of walls and samples."""
        rows = np.arange(state.fluid, state.particles)
        self.stable_dt = self.stiffness.limit(state, rows)

    def rows_with_density_rate(self, state: State) -> int:
        """Rows of the fluid."""
        return state.fluid

    def displacement(self, state: State) -> float:
        """Samples look from where they are."""
        return 0.0

    def query_points(self, state: State) -> tuple[Array | None, Whole]:
        """Samples, which the fluid pushes, look from where they are; walls need not."""
        row = self.samples.row
        return state.reference[row], state.fluid + np.arange(len(row))

    def resize(self, state: State, symmetry: SymmetryPlanes) -> None:
        """Nothing to do: the potential acts at every row."""

    def write_pressure(self, state: State, lists: Lists, team: Team) -> None:
        """Nothing to do: stiffness stands in place of pressure."""

    def apparent_velocity(self, state: State, lists: Lists, team: Team) -> Array:
        """Velocities as they are."""
        return state.velocity_pressure

    def energy(self, state: State, lists: Lists, team: Team) -> float:
        """Energy [J] of the potential and of the repulsion."""
        return self.stiffness.energy(state, lists, team)
