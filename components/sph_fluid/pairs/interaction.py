"""Passes over pairs of particles: their arguments and their results."""

import math

import numpy as np

from quintet.components.shared.search.neighbours import Lists
from quintet.components.shared.threads import Team
from quintet.components.sph_fluid.boundary.method import BoundaryMethod, Films
from quintet.components.sph_fluid.boundary.samples import Samples
from quintet.components.sph_fluid.boundary.symmetry_planes import SymmetryPlanes
from quintet.components.sph_fluid.boundary.walls import wall_volume
from quintet.components.sph_fluid.constants import pair_law
from quintet.components.sph_fluid.kernels import (
    BoundaryRows,
    Rates,
    pair_rates,
)
from quintet.components.sph_fluid.motion.frame import Frame
from quintet.components.sph_fluid.pairs.kernels import move_by, sample_forces
from quintet.components.sph_fluid.pairs.precision import Precision
from quintet.components.sph_fluid.params import SphFluidParams
from quintet.components.sph_fluid.ranks.method import Ranks
from quintet.components.sph_fluid.setup.mass import EVEN
from quintet.components.sph_fluid.state import Array, State

UNEVEN = 0.05  # of a particle's volume: by so much a wall particle may differ


class Interaction:
    """Passes over the pairs of one fluid."""

    def __init__(
        self,
        params: SphFluidParams,
        boundary: BoundaryMethod,
        symmetry: SymmetryPlanes,
        precision: Precision,
        samples: Samples,
        frame: Frame,
    ) -> None:
        self.params, self.boundary, self.symmetry = params, boundary, symmetry
        self.frame = frame
        self.precision, self.samples = precision, samples
        self.rates = Rates(np.empty((0, 4)), np.empty((0, 3)), np.empty(0))
        self.volume: Array = np.zeros(0)  # (n,) 1, of boundary rows; (0,) if all are alike
        self._prepare()

    def _prepare(self) -> None:
        own_volume = True if len(self.volume) else None
        self.law = self.precision.law(pair_law(self.params, self.boundary.contact, own_volume))

    def resize(self, state: State) -> None:
        """Make room for the results of a state with new lists."""
        self.volume = relative_volume(self.samples, state, self.params)
        if len(self.volume):
            self.symmetry.write_values(self.volume, state.particles)
        self.precision.resize(state, self.params.density)
        drifting = state.fluid if self.params.xsph > 0.0 else 0
        self.rates = Rates(
            np.empty_like(state.position_density), np.empty((drifting, 3)), state.minus_rho_div_u
        )
        self._prepare()

    def compute(self, state: State, lists: Lists, team: Team) -> None:
        """Write accelerations and rates of density, of the state as it is."""
        boundary = self.precision.boundary(self._boundary_rows(state, lists, team))
        particles = self.precision.particles(state, team)
        self.pair_arguments = (particles, boundary, lists, self.frame.law(self.law))
        rates = self.rates._replace(minus_rho_div_u=state.minus_rho_div_u)
        rows = self.boundary.rows_with_density_rate(state)
        arguments = (state.fluid, *self.pair_arguments, self.params.gravity, rates)
        extremes = team.run(pair_rates, rows, *arguments)
        largest = math.sqrt(max(greatest for greatest, _ in extremes))
        state.largest_acceleration = self.frame.accelerate(state, rates.rate, largest, team)
        state.largest_approach = max(fastest for _, fastest in extremes)

    def _boundary_rows(self, state: State, lists: Lists, team: Team) -> BoundaryRows:
        """Velocities, volumes and mask of boundary rows in the present state."""
        velocity: Array = np.zeros((0, 4))
        if self.params.viscosity.kinematic > 0.0:
            velocity = self.boundary.apparent_velocity(state, lists, team)
            self.symmetry.write_vectors(velocity, state.particles)
        return BoundaryRows(velocity, self.volume, self.boundary.mask)

    def apply_forces(
        self, state: State, lists: Lists, dt: float, team: Team, films: Films, ranks: Ranks
    ) -> None:
        """Push the samples as they pushed the fluid; move the fluid with its neighbours (XSPH)."""
        self.push_samples(state, team)
        if len(self.samples.volume):
            ranks.gather_forces(state, self.samples.number)
        films.advance(state, lists, dt)
        self.frame.count_work(state, dt)
        self.move_with_neighbours(state, dt, team)

    def push_samples(self, state: State, team: Team) -> None:
        """Push the samples as they pushed the fluid in the last pass."""
        row = self.samples.row
        if len(row):
            rows = (self.samples.number, row, self.samples.listed)
            team.run(sample_forces, len(row), *rows, *self.pair_arguments, state.force)

    def move_with_neighbours(self, state: State, dt: float, team: Team) -> None:
        """XSPH: move with the neighbours' mean velocity."""
        if self.params.xsph > 0.0:
            time, velocity = self.params.xsph * dt, self.rates.xsph_velocity
            team.run(move_by, state.fluid, time, velocity, state.position_density)


def relative_volume(samples: Samples, state: State, params: SphFluidParams) -> Array:
    """Volumes (n,) of all rows over that of a particle of the fluid; (0,) if all are alike.

    Where the spacing does not divide a body, its samples stand closer, or less close, than the
    fluid's particles; as heavy as those they would displace more, or less, than the body does.
    The same holds of the walls of a fluid whose own edges it divides so badly that it matters.
    """
    share, wall = samples.volume / params.particle_volume, relative_wall_volume(params)
    if np.abs(share - 1.0).max(initial=abs(wall - 1.0)) < EVEN:
        return np.zeros(0)
    volumes = np.ones(len(state.position_density))
    volumes[state.fluid : state.particles] = wall
    volumes[samples.row] = share[samples.number]
    return volumes


def relative_wall_volume(params: SphFluidParams) -> float:
    """Volume of a wall particle over that of one of the fluid; 1 if they hardly differ."""
    particle = params.particle_volume
    wall = wall_volume(params) / particle
    is_even = abs(wall - 1.0) < UNEVEN or particle == params.spacing**params.dimensions
    return 1.0 if is_even else wall
