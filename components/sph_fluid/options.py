"""Loops of the terms that are off unless a scene switches them on; imported only then."""

import numpy as np
from numba import njit

from quintet.components.shared.neighbours import FAST
from quintet.components.sph_fluid.kernels import List
from quintet.components.sph_fluid.laws import Fluid, kernel
from quintet.components.sph_fluid.state import Array


@njit(**FAST)
def mean_motion(
    first: int, last: int, place: Array, motion: Array, near: List, fluid: Fluid, drift: Array
) -> None:
    """Write Σ_j (m_j/ρ̄_ij)(u_j - u_i)W_ij over the fluid [m/s]; Monaghan 1989, eq. (2.6)."""
    begin, middle, _, neighbour = near
    for i in range(first, last):
        du, dv, dw = 0.0, 0.0, 0.0
        for k in range(np.uint64(begin[i]), np.uint64(middle[i])):
            j = np.uint64(neighbour[k])
            dx, dy, dz = place[i, 0] - place[j, 0], place[i, 1] - place[j, 1], place[i, 2] - place[j, 2]
            weight = kernel(dx * dx + dy * dy + dz * dz, fluid) / (place[i, 3] + place[j, 3])
            du += weight * (motion[j, 0] - motion[i, 0])
            dv += weight * (motion[j, 1] - motion[i, 1])
            dw += weight * (motion[j, 2] - motion[i, 2])
        drift[i, 0] = 2.0 * fluid.mass * du
        drift[i, 1] = 2.0 * fluid.mass * dv
        drift[i, 2] = 2.0 * fluid.mass * dw


@njit(**FAST)
def shepard(
    first: int, last: int, place: Array, near: List, fluid: Fluid, density: Array
) -> None:
    """Write the filtered density Σ_j m_j W_ij / Σ_j (m_j/ρ_j) W_ij over the fluid, j = i included."""
    begin, middle, _, neighbour = near
    for i in range(first, last):
        weight, volume = 0.0, 0.0
        for k in range(np.uint64(begin[i]), np.uint64(middle[i])):
            j = np.uint64(neighbour[k])
            dx, dy, dz = place[i, 0] - place[j, 0], place[i, 1] - place[j, 1], place[i, 2] - place[j, 2]
            w = kernel(dx * dx + dy * dy + dz * dz, fluid)
            weight += w
            volume += w / place[j, 3]
        density[i] = weight / volume
