"""Dynamic boundary particles: they obey the equations of the fluid, but move as they are told.

Crespo, Gómez-Gesteira & Dalrymple, CMC 5 (2007) 173.
"""

import math

import numpy as np

from quintet.components.shared.search.neighbours import Lists
from quintet.components.shared.threads import Team
from quintet.components.sph_fluid.boundary.samples import Samples
from quintet.components.sph_fluid.boundary.symmetry_planes import SymmetryPlanes
from quintet.components.sph_fluid.constants import NO_POTENTIAL
from quintet.components.sph_fluid.state import Array, State, Whole
from quintet.interfaces.component import Fields


class DynamicBoundary:
    """Walls and samples whose density obeys the equation of continuity."""

    contact = NO_POTENTIAL
    stable_dt = math.inf
    reads_images = False

    def __init__(self, samples: Samples) -> None:
        self.samples, self.mask = samples, np.zeros(0)
        self.by_potential: Whole = np.zeros(0, np.int64)

    def start(self, state: State) -> None:
        """Nothing to do: walls have their densities."""

    def join(self, state: State, static: Fields) -> None:
        """Nothing to do: samples have their densities."""

    def follow_samples(self, state: State, fields: Fields, first: int = 0) -> None:
        """Nothing to do: samples look from where they are."""

    def load(self, state: State) -> None:
        """Nothing to do: all is in the state."""

    def rows_with_density_rate(self, state: State) -> int:
        """All rows."""
        return state.particles

    def displacement(self, state: State) -> float:
        """Particles look from where they are."""
        return 0.0

    def query_points(self, state: State) -> tuple[Array | None, Whole]:
        """Particles look from where they are."""
        return None, self.samples.row

    def resize(self, state: State, symmetry: SymmetryPlanes) -> None:
        """Nothing to do: nothing is kept beside the state."""

    def write_pressure(self, state: State, lists: Lists, team: Team) -> None:
        """Nothing to do: densities were advanced."""

    def apparent_velocity(self, state: State, lists: Lists, team: Team) -> Array:
        """Velocities as they are."""
        return state.velocity_pressure

    def energy(self, state: State, lists: Lists, team: Team) -> float:
        """None: it stores no energy but that of its density."""
        return 0.0
