"""The Shepard filter of the density; imported only by a scene that switches it on."""

import numpy as np

from quintet.components.shared.search.neighbours import Lists
from quintet.components.shared.threads import Team
from quintet.components.sph_fluid.constants import constants
from quintet.components.sph_fluid.kernels import write_pressure
from quintet.components.sph_fluid.pairs.kernels import filter_density
from quintet.components.sph_fluid.params import SphFluidParams
from quintet.components.sph_fluid.state import State


class ShepardFilter:
    """A filter that is applied every so many steps."""

    def __init__(self, params: SphFluidParams) -> None:
        self.every, self.constants = params.shepard_every, constants(params)

    def is_due(self, state: State) -> bool:
        """Whether the coming step begins with a filtered density."""
        return state.steps % self.every == self.every - 1

    def apply(self, state: State, lists: Lists, team: Team) -> None:
        """Filter the fluid's density, and compute pressures again; buffers keep theirs."""
        density, rows = np.empty(state.fluid), slice(state.fluid)
        arrays = (state.position_density, lists, self.constants, density)
        team.run(filter_density, state.fluid, *arrays)
        if len(state.role):
            density = np.where(state.role == 0, density, state.position_density[rows, 3])
        state.position_density[rows, 3] = density
        write_pressure(self.constants, state.position_density[rows], state.velocity_pressure[rows])
