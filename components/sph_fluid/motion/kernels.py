"""Loops over fluid in a frame that moves."""

import numpy as np
from numba import njit

from quintet.components.shared.numba_options import EXACT
from quintet.components.sph_fluid.state import Array


@njit(inline="always")
def across(turning, u, v, w):  # type: ignore[no-untyped-def]
    """Cross product of a vector (3,) and a velocity."""
    x, y, z = turning[0], turning[1], turning[2]
    return y * w - z * v, z * u - x * w, x * v - y * u


@njit(**EXACT)
def add_frame_acceleration(
    first: int, last: int, lead: float, uniform: Array, gradient: Array, turning: Array,
    position: Array, velocity: Array, rate: Array, power: Array,
) -> float:  # fmt: skip
    """Add the accelerations of a moving frame to those of fluid rows [first, last).

    a_i += c + G r_i - 2ω × u_i, with r_i and u_i at the middle of the step.

    Parameters
    ----------
    first, last : int
    lead : float, s
        From the time of `position` and `velocity` to the middle of the step.
    uniform : (3,) float array, m/s2
        c.
    gradient : (3, 3) float array, 1/s2
        G.
    turning : (3,) float array, 1/s
        2ω.
    position, velocity : (n, 4) float arrays
        Of the state.
    rate : (n, 4) float array, m/s2
        Accelerations so far; written.
    power : (fluid,) float array, m2/s3
        Power per mass of c + G r; written.

    Returns
    -------
    float, m2/s4
        The greatest squared acceleration.
    """
    greatest = 0.0
    for i in range(first, last):
        x = position[i, 0] + lead * (velocity[i, 0] + 0.5 * lead * rate[i, 0])
        y = position[i, 1] + lead * (velocity[i, 1] + 0.5 * lead * rate[i, 1])
        z = position[i, 2] + lead * (velocity[i, 2] + 0.5 * lead * rate[i, 2])
        force = (
            uniform[0] + gradient[0, 0] * x + gradient[0, 1] * y + gradient[0, 2] * z,
            uniform[1] + gradient[1, 0] * x + gradient[1, 1] * y + gradient[1, 2] * z,
            uniform[2] + gradient[2, 0] * x + gradient[2, 1] * y + gradient[2, 2] * z,
        )
        rate[i, 0], rate[i, 1], rate[i, 2] = (
            rate[i, 0] + force[0], rate[i, 1] + force[1], rate[i, 2] + force[2],
        )  # fmt: skip
        u, v, w = velocity[i, 0], velocity[i, 1], velocity[i, 2]
        a, b, c = across(turning, u, v, w)
        u, v, w = (
            u + lead * (rate[i, 0] - a), v + lead * (rate[i, 1] - b), w + lead * (rate[i, 2] - c),
        )  # fmt: skip
        power[i] = force[0] * u + force[1] * v + force[2] * w
        a, b, c = across(turning, u, v, w)
        rate[i, 0] -= a
        rate[i, 1] -= b
        rate[i, 2] -= c
        square = rate[i, 0] ** 2 + rate[i, 1] ** 2 + rate[i, 2] ** 2
        greatest = max(greatest, square)
    return np.float64(greatest)
