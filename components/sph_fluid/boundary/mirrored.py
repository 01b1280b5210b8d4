"""Walls whose density is that of the fluid before them; imported only by a scene that asks.

Modified dynamic boundary condition: English et al., Comput. Part. Mech. 9 (2022) 911. The
density at the mirror point of a boundary particle, and its gradient there, are fitted to the
fluid around that point and carried on to the particle, so that the fluid feels its own pressure
go on into the wall and comes as near to it as to itself (`kernels/mirrored_density.py`). Links may
choose the contact potential for the samples that they bring.
"""

import math
from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from quintet.components.shared.search.neighbours import Lists
from quintet.components.shared.search.verlet_list import longest
from quintet.components.shared.threads import Team
from quintet.components.sph_fluid.boundary.kernels.mirrored_density import (
    BY_POTENTIAL,
    NOT_LISTED,
    extrapolate_density,
    mirror_velocity,
)
from quintet.components.sph_fluid.boundary.parts import standing
from quintet.components.sph_fluid.boundary.samples import Samples
from quintet.components.sph_fluid.boundary.symmetry_planes import SymmetryPlanes
from quintet.components.sph_fluid.constants import NO_POTENTIAL, constants
from quintet.components.sph_fluid.motion.frame import Frame
from quintet.components.sph_fluid.params import SphFluidParams
from quintet.components.sph_fluid.state import Array, State, Whole
from quintet.interfaces.component import Fields
from quintet.interfaces.errors import PortError

if TYPE_CHECKING:  # compiled where a link asks for it
    from quintet.components.sph_fluid.boundary.contact_potential import ContactStiffness


class MirroredBoundary:
    """Walls and samples whose density is mirrored."""

    reads_images = True

    def __init__(
        self,
        params: SphFluidParams,
        samples: Samples,
        make_stiffness: Callable[[], "ContactStiffness"],
        frame: Frame,
    ) -> None:
        self.params, self.samples, self._make_stiffness = params, samples, make_stiffness
        self.frame = frame
        self.contact, self.stable_dt = NO_POTENTIAL, math.inf
        self.mask: Array = np.zeros(0)
        self.by_potential: Whole = np.zeros(0, np.int64)  # (k,) samples under the potential

    def start(self, state: State) -> None:
        """Mirror the walls."""
        _, state.mirror_point = standing(self.params)

    def join(self, state: State, static: Fields) -> None:
        """Make room for mirror points; find which samples the contact potential is chosen for."""
        count = len(self.samples.volume)
        state.mirror_point = np.concatenate([state.mirror_point, np.zeros((count, 3))])
        self.by_potential = samples_by_potential(static)
        if len(self.by_potential):
            self.stiffness = self._make_stiffness()
            self.contact = self.stiffness.numbers._replace(partial=True)

    def follow_samples(self, state: State, fields: Fields, first: int = 0) -> None:
        """Follow mirror points; set the stiffness of the potential where samples are now."""
        rows, numbers = self.samples.rows_of(first, len(fields["surface.mirror"]))
        state.mirror_point[rows - state.fluid] = fields["surface.mirror"][numbers]
        if len(self.by_potential):
            rows, body = self.samples.row[self.by_potential], self.samples.body[self.by_potential]
            self.stable_dt = self.stiffness.write(state, rows, body)

    def load(self, state: State) -> None:
        """Find the step limit of the potential again."""
        if len(self.by_potential):
            self.stable_dt = self.stiffness.limit(state, self.samples.row[self.by_potential])

    def rows_with_density_rate(self, state: State) -> int:
        """Rows of the fluid."""
        return state.fluid

    def displacement(self, state: State) -> float:
        """Furthest [m] that a sample's mirror point is from where the lists were made."""
        if not len(self.samples.row):
            return 0.0
        sample_rows = self.samples.row - state.fluid
        before = state.reference[state.particles :]
        return longest(state.mirror_point.take(sample_rows, 0) - before.take(sample_rows, 0))

    def query_points(self, state: State) -> tuple[Array | None, Whole]:
        """Mirror points; samples, which the fluid pushes, look from where they are as well."""
        points, row = state.reference[: state.particles], self.samples.row
        sources = np.concatenate([state.reference[len(points) :], points[row]])
        return sources, len(points) + np.arange(len(row))

    def resize(self, state: State, symmetry: SymmetryPlanes) -> None:
        """Mark rows under the potential, of a state with new lists."""
        if len(self.by_potential):
            self.mask = np.zeros(len(state.position_density))
            self.mask[self.samples.row[self.by_potential]] = 1.0
            symmetry.write_values(self.mask, state.particles)

    def write_pressure(self, state: State, lists: Lists, team: Team) -> None:
        """Write density as if the fluid went on into walls and samples."""
        listed = np.full(len(state.mirror_point), NOT_LISTED)
        sample_rows = self.samples.row - state.fluid
        listed[sample_rows] = self.samples.listed
        listed[sample_rows[self.by_potential]] = BY_POTENTIAL
        arrays = (
            listed,
            state.mirror_point,
            state.position_density,
            state.velocity_pressure,
            lists,
        )
        gravity, params = math.hypot(*self.frame.rest_acceleration), self.params
        rest_gradient = params.density * gravity / params.sound_speed**2  # kg/m4
        numbers = (rest_gradient, constants(params))
        team.run(extrapolate_density, len(listed), state.fluid, *arrays, *numbers)

    def apparent_velocity(self, state: State, lists: Lists, team: Team) -> Array:
        """Velocities that bring the fluid to rest at walls and samples, unless it slips there."""
        if self.params.boundary.wall_viscosity_factor == 0.0:
            return state.velocity_pressure
        mirrored = state.velocity_pressure.copy()
        arrays = (state.mirror_point, state.position_density, state.velocity_pressure, lists)
        rows, numbers = len(state.mirror_point), (constants(self.params), mirrored)
        team.run(mirror_velocity, rows, state.fluid, *arrays, *numbers)
        return mirrored

    def energy(self, state: State, lists: Lists, team: Team) -> float:
        """Energy [J] of the contact potential, and of the repulsion, where there is one."""
        if not len(self.by_potential):
            return 0.0
        return self.stiffness.energy(state, lists, team, self.mask)


def samples_by_potential(static: Fields) -> Whole:
    """Samples (k,) for which links chose the contact potential."""
    count = len(static["surface.volume"])
    contact = static.get("surface.contact", np.zeros(count))
    if len(contact) != count:
        raise PortError(
            f"surface.contact must be said of all {count} samples or of none; found "
            f"{len(contact)}. Let every link that brings samples say it."
        )
    return np.flatnonzero(contact)
