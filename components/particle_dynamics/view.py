"""What a picture shows of a lattice: its points with their hotness."""

import numpy as np

from quintet.interfaces.component import Array, Fields

RADIUS = 0.25  # spacings, at which points are drawn


def view(
    position: Array, velocity: Array, mean: Array, relative: Array, boltzmann: float, spacing: float
) -> Fields:
    """Points with hotness, temperature and velocity.

    Parameters
    ----------
    position, velocity : (n, 3) float array, m and m/s
    mean, relative : (n,) float array, J and 1
        Hotness, and its ratio to that of the hottest point.
    boltzmann, spacing : float, J/K and m
    """
    return {
        "points": position.copy(),
        "radius": np.full(len(mean), RADIUS * spacing),
        "relative_hotness": relative,
        "hotness": mean,
        "temperature": mean / (1.5 * boltzmann),
        "velocity": velocity.copy(),
    }
