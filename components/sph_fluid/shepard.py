"""The Shepard filter; imported only by a scene that switches it on."""

import numpy as np
from numba import njit

from quintet.components.shared.numba_options import FAST
from quintet.components.shared.search.neighbours import Lists
from quintet.components.shared.smoothing.smoothing import kernel
from quintet.components.shared.threads import Team
from quintet.components.sph_fluid.kernels import press
from quintet.components.sph_fluid.laws import Fluid
from quintet.components.sph_fluid.state import Array, State


def smooth(state: State, near: Lists, fluid: Fluid, team: Team) -> None:
    """Filter the fluid's density, and press all anew."""
    density = np.empty(state.fluid)
    team.run(shepard, state.fluid, state.place, near, fluid, density)
    state.place[: state.fluid, 3] = density
    press(fluid, state.place[: state.fluid], state.motion[: state.fluid])


@njit(**FAST)
def shepard(first: int, last: int, place: Array, near: Lists, fluid: Fluid, density: Array) -> None:
    """Write Σ_j m_j W_ij / Σ_j (m_j/ρ_j) W_ij over the fluid, j = i included; Panizzo 2004."""
    begin, middle, _, neighbour = near
    for i in range(first, last):
        x, y, z = place[i, 0], place[i, 1], place[i, 2]
        weights, volumes = 0.0, 0.0
        for k in range(np.uint64(begin[i]), np.uint64(middle[i])):
            j = np.uint64(neighbour[k])
            dx, dy, dz = x - place[j, 0], y - place[j, 1], z - place[j, 2]
            weight = kernel(dx * dx + dy * dy + dz * dz, fluid.smoothing)
            weights += weight
            volumes += weight / place[j, 3]
        density[i] = weights / volumes
