"""States at the walls of bodies: slip walls by a Riemann problem, and walls that hold the gas."""

import math

from numba import njit

from quintet.components.meshless_gas.laws.fluxes import SENSED, WIDTH, wall_pressure
from quintet.components.shared.numba_options import INNER

LEAST = 0.3  # of the first node's density and pressure: what a wall's state must keep
COLDEST = 0.3  # of the nearer node's temperature: what an adiabatic wall must keep


@njit(**INNER)
def slip_wall_state(first, second, near, far, normal, velocity, gamma):  # type: ignore[no-untyped-def]
    """State (5,) of a slip wall: that of two nodes above it, extrapolated, and stopped there.

    What runs into the wall fades with the square of the height in a settled flow, and the pressure
    of the shock that stops it needs no threshold.

    Parameters
    ----------
    first, second : (5,) kg/m3, m/s, Pa
        States of the nodes above.
    near, far : float, m
        Their heights.
    normal : (3,) 1
        Into the gas.
    velocity : (3,) m/s
        Of the wall.
    """
    ratio = min(first[4], second[4]) / max(first[4], second[4])
    keep = min(max((ratio - SENSED) / WIDTH, 0.0), 1.0)
    share = keep * near / (far - near)
    r, p = first[0] + share * (first[0] - second[0]), first[4] + share * (first[4] - second[4])
    u = first[1] + share * (first[1] - second[1])
    v = first[2] + share * (first[2] - second[2])
    w = first[3] + share * (first[3] - second[3])
    if not (r > LEAST * first[0] and p > LEAST * first[4]):
        r, u, v, w, p = first[0], first[1], first[2], first[3], first[4]
    into = -(u - velocity[0]) * normal[0]
    into -= (v - velocity[1]) * normal[1]
    into -= (w - velocity[2]) * normal[2]
    mach = into / math.sqrt(gamma * p / r)
    pressure = wall_pressure(p, max(mach, 0.0), gamma)
    density = r * (pressure / p) ** (1.0 / gamma)
    return density, u + into * normal[0], v + into * normal[1], w + into * normal[2], pressure


@njit(**INNER)
def level_temperature(first, second, near, far):  # type: ignore[no-untyped-def]
    """Temperature [K] of an adiabatic wall: of the parabola that is level there.

    Where a shock lies between the two nodes above, that of the nearer.

    Parameters
    ----------
    first, second : float, K
        Temperatures of the nodes above.
    near, far : float, m
        Their heights.
    """
    low, high = near * near, far * far
    level = (first * high - second * low) / (high - low)
    return level if level > COLDEST * first else first
