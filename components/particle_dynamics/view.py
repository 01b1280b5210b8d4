"""What a picture shows of a lattice: its points, by hotness."""

import numpy as np

from quintet.components.particle_dynamics.state import State
from quintet.interfaces.component import Array, Fields

RADIUS = 0.25  # spacings, at which points are drawn


def hotness(state: State, since: float, least: float) -> tuple[Array, Array]:
    """Mean kinetic energy (n,) J over a time [s], and over that of the hottest point.

    Where this has less than a least [J], which is rounding, nothing is hot.
    """
    mean = state.kinetic / since if since > 0.0 else np.zeros(len(state.kinetic))
    highest = mean.max()
    return mean, mean / highest if highest > least else np.zeros(len(mean))


def view(state: State, since: float, least: float, boltzmann: float, spacing: float) -> Fields:
    """Points with hotness, temperature and velocity."""
    mean, relative = hotness(state, since, least)
    return {
        "points": state.position.copy(),
        "radius": np.full(len(mean), RADIUS * spacing),
        "relative_hotness": relative,
        "hotness": mean,
        "temperature": mean / (1.5 * boltzmann),
        "velocity": state.velocity.copy(),
    }
