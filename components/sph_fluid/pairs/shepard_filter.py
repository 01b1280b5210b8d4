"""The Shepard filter of the density; imported only by a scene that switches it on."""

import numpy as np
from numba import njit

from quintet.components.shared.numba_options import FAST
from quintet.components.shared.search.neighbours import Lists
from quintet.components.shared.smoothing.smoothing import kernel
from quintet.components.shared.threads import Team
from quintet.components.sph_fluid.kernels import write_pressure
from quintet.components.sph_fluid.laws import Constants
from quintet.components.sph_fluid.pairs.constants import constants
from quintet.components.sph_fluid.params import SphFluidParams
from quintet.components.sph_fluid.state import Array, State


class ShepardFilter:
    """A filter that is applied every so many steps."""

    def __init__(self, params: SphFluidParams) -> None:
        self.every, self.constants = params.shepard_every, constants(params)

    def apply(self, state: State, lists: Lists, team: Team) -> None:
        """Filter the fluid's density where it is time, and press anew."""
        if state.steps % self.every != self.every - 1:
            return
        density, rows = np.empty(state.fluid), slice(state.fluid)
        arrays = (state.position_density, lists, self.constants, density)
        team.run(filter_density, state.fluid, *arrays)
        state.position_density[rows, 3] = density
        write_pressure(self.constants, state.position_density[rows], state.velocity_pressure[rows])


@njit(**FAST)
def filter_density(
    first: int, last: int, position: Array, lists: Lists, constants: Constants, density: Array
) -> None:
    """Write Σ_j m_j W_ij / Σ_j (m_j/ρ_j) W_ij [kg/m3] over the fluid, j = i included.

    References
    ----------
    Panizzo, PhD thesis, L'Aquila (2004).
    """
    begin, middle, _, neighbour = lists
    for i in range(first, last):
        x, y, z = position[i, 0], position[i, 1], position[i, 2]
        weights, volumes = 0.0, 0.0
        for k in range(np.uint64(begin[i]), np.uint64(middle[i])):
            j = np.uint64(neighbour[k])
            dx, dy, dz = x - position[j, 0], y - position[j, 1], z - position[j, 2]
            weight = kernel(dx * dx + dy * dy + dz * dz, constants.smoothing)
            weights += weight
            volumes += weight / position[j, 3]
        density[i] = weights / volumes
