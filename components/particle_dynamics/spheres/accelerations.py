"""Accelerations of spheres in flight, at rest until they are launched."""

import numpy as np
from numpy.typing import NDArray

from quintet.components.particle_dynamics.spheres.state import Spheres, State
from quintet.interfaces.component import Array

Flags = NDArray[np.bool_]


def acceleration(spheres: Spheres, state: State, gravity: Array, flying: Flags) -> Array:
    """Accelerations (n, 3) m/s2 of spheres that fly, by all forces."""
    loaded = state.force / spheres.mass[:, None] * flying[:, None]
    return np.asarray(loaded + free_acceleration(spheres, state, gravity, flying))


def free_acceleration(spheres: Spheres, state: State, gravity: Array, flying: Flags) -> Array:
    """Accelerations (n, 3) m/s2 of spheres that fly, by gravity (3,) m/s2 and tethers."""
    pull = gravity
    if spheres.tether.any():
        stiff = (spheres.tether / spheres.mass)[:, None]  # 1/s2
        pull = pull - stiff * (state.position - spheres.start)
    return np.asarray(pull * flying[:, None])
