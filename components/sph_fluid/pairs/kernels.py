"""Loops of the acoustic damper and of the Shepard filter."""

import numpy as np
from numba import njit

from quintet.components.shared.numba_options import FAST
from quintet.components.shared.search.neighbours import Lists
from quintet.components.shared.smoothing.smoothing import kernel
from quintet.components.sph_fluid.laws import Constants, pressure_term
from quintet.components.sph_fluid.state import Array

NO_FLUID = 1e-2  # Σ V W below which there is no fluid around a mirror point


@njit(**FAST)
def write_damped_pressure(
    first: int, last: int, strength: float, minus_rho_div_u: Array, position: Array,
    velocity: Array, constants: Constants,
) -> None:  # fmt: skip
    """Write p/ρ² of rows [first, last) as if strength [m2/s] · -ρ∇·u [kg/(m3 s)] were pressure.

    References
    ----------
    Sun et al., J. Comput. Phys. 483 (2023) 112056.
    """
    for i in range(first, last):
        density = position[i, 3]
        more = strength * minus_rho_div_u[i] / (density * density)
        velocity[i, 3] = pressure_term(density, constants) + more


@njit(**FAST)
def add_mirrored_damping(
    first: int, last: int, split: int, mirror_point: Array, position: Array, velocity: Array,
    lists: Lists, constants: Constants,
) -> None:  # fmt: skip
    """Add the damper's mean part around their mirror points to p/ρ² of boundary rows."""
    begin, _, end, neighbour = lists
    for b in range(first, last):
        i = split + b
        x, y, z = mirror_point[b, 0], mirror_point[b, 1], mirror_point[b, 2]
        weights, sums = 0.0, 0.0
        for k in range(np.uint64(begin[i]), np.uint64(end[i])):
            j = np.uint64(neighbour[k])
            dx, dy, dz = position[j, 0] - x, position[j, 1] - y, position[j, 2] - z
            r2 = dx * dx + dy * dy + dz * dz
            weight = kernel(r2, constants.smoothing) * constants.mass / position[j, 3]
            weights += weight
            sums += weight * (velocity[j, 3] - pressure_term(position[j, 3], constants))
        if weights >= NO_FLUID:
            velocity[i, 3] = max(velocity[i, 3] + sums / weights, 0.0)


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
