"""Loops over fluid in a frame that moves."""

import numpy as np
from numba import njit

from quintet.components.shared.numba_options import EXACT
from quintet.components.sph_fluid.motion.laws import FrameForces, frame_acceleration
from quintet.components.sph_fluid.state import Array


@njit(**EXACT)
def add_frame_acceleration(
    first: int, last: int, forces: FrameForces, position: Array, velocity: Array, rate: Array,
    power: Array,
) -> float:  # fmt: skip
    """Add the accelerations of a moving frame to those of fluid rows [first, last).

    Parameters
    ----------
    first, last : int
    forces : FrameForces
    position, velocity : (n, 4) float arrays
        Of the state.
    rate : (n, 4) float array, m/s2
        Accelerations so far; written.
    power : (fluid,) float array, m2/s3
        Power per mass of the motion of the frame; written.

    Returns
    -------
    float, m2/s4
        The greatest squared acceleration.
    """
    greatest = 0.0
    for i in range(first, last):
        r = position[i, 0], position[i, 1], position[i, 2]
        u = velocity[i, 0], velocity[i, 1], velocity[i, 2]
        a = rate[i, 0], rate[i, 1], rate[i, 2]
        (x, y, z), power[i] = frame_acceleration(r, u, a, forces)
        rate[i, 0], rate[i, 1], rate[i, 2] = x, y, z
        greatest = max(greatest, x**2 + y**2 + z**2)
    return np.float64(greatest)
