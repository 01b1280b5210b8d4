"""State at a boundary between gas within and gas beyond: the solution of their Riemann problem.

Waves that reach the boundary leave through it; what comes in is that of the gas beyond.
"""

import math

from numba import njit

from quintet.components.shared.numba_options import INNER

HALVINGS = 60  # of the interval in which the pressure between the waves lies


@njit(**INNER)
def velocity_change(p: float, density: float, pressure: float, gamma: float) -> float:
    """Velocity [m/s] that a wave to the pressure p makes; Toro (2009), equations 4.6 and 4.7."""
    if p > pressure:
        a = 2.0 / ((gamma + 1.0) * density)
        b = (gamma - 1.0) / (gamma + 1.0) * pressure
        return (p - pressure) * math.sqrt(a / (p + b))
    sound = math.sqrt(gamma * pressure / density)
    return 2.0 * sound / (gamma - 1.0) * ((p / pressure) ** ((gamma - 1.0) / (2.0 * gamma)) - 1.0)


@njit(**INNER)
def bracket(
    density_l: float, u_l: float, p_l: float, density_r: float, u_r: float, p_r: float, gamma: float
) -> tuple[float, float]:
    """Pressures [Pa] below and above that between the waves."""
    low, high = 0.0, max(p_l, p_r)
    for _ in range(HALVINGS):
        gap = velocity_change(high, density_l, p_l, gamma)
        gap += velocity_change(high, density_r, p_r, gamma) + u_r - u_l
        if gap >= 0.0:
            return low, high
        low, high = high, 4.0 * high
    return low, high


@njit(**INNER)
def between(
    density_l: float, u_l: float, p_l: float, density_r: float, u_r: float, p_r: float, gamma: float
) -> tuple[float, float]:
    """Pressure [Pa] and velocity [m/s] between the waves; of gas torn apart the pressure is 0."""
    low, high = bracket(density_l, u_l, p_l, density_r, u_r, p_r, gamma)
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        gap = velocity_change(middle, density_l, p_l, gamma)
        gap += velocity_change(middle, density_r, p_r, gamma) + u_r - u_l
        if gap < 0.0:
            low = middle
        else:
            high = middle
    p = 0.5 * (low + high)
    change = velocity_change(p, density_r, p_r, gamma) - velocity_change(p, density_l, p_l, gamma)
    return p, 0.5 * (u_l + u_r + change)


@njit(**INNER)
def at_rest(
    density: float, u: float, p: float, star: float, velocity: float, gamma: float
) -> tuple[float, float, float]:
    """Density, velocity and pressure at x/t = 0 on the left of the contact; Toro (2009), 4.5."""
    sound, ratio = math.sqrt(gamma * p / density), star / p
    g = (gamma - 1.0) / (gamma + 1.0)
    if ratio > 1.0:
        mach = math.sqrt(((gamma + 1.0) * ratio + gamma - 1.0) / (2.0 * gamma))
        if u - sound * mach >= 0.0:
            return density, u, p
        return density * (ratio + g) / (g * ratio + 1.0), velocity, star
    if u - sound >= 0.0:
        return density, u, p
    if velocity - sound * ratio ** ((gamma - 1.0) / (2.0 * gamma)) <= 0.0:
        return density * ratio ** (1.0 / gamma), velocity, star
    along = 2.0 / (gamma + 1.0) + g / sound * u
    speed = 2.0 / (gamma + 1.0) * (sound + 0.5 * (gamma - 1.0) * u)
    return (
        density * along ** (2.0 / (gamma - 1.0)),
        speed,
        p * along ** (2.0 * gamma / (gamma - 1.0)),
    )


@njit(**INNER)
def meet(near, outer, normal, gamma):  # type: ignore[no-untyped-def]
    """State at a boundary.

    Parameters
    ----------
    near, outer : (5,) kg/m3, m/s, Pa
        Of the gas within and of that beyond.
    normal : (3,) 1
        Into the gas.

    Returns
    -------
    (5,) kg/m3, m/s, Pa
    """
    into = outer[1] * normal[0] + outer[2] * normal[1] + outer[3] * normal[2]
    inside = near[1] * normal[0] + near[2] * normal[1] + near[3] * normal[2]
    star, velocity = between(outer[0], into, outer[4], near[0], inside, near[4], gamma)
    if not star > 0.0:  # torn apart: the boundary has the gas within
        return near
    if velocity >= 0.0:  # it comes in
        density, u, p = at_rest(outer[0], into, outer[4], star, velocity, gamma)
        return with_normal_speed(outer, normal, into, density, u, p)
    # Seen from within, against the normal.
    density, u, p = at_rest(near[0], -inside, near[4], star, -velocity, gamma)
    return with_normal_speed(near, normal, inside, density, -u, p)


@njit(**INNER)
def with_normal_speed(state, normal, across, density, u, p):  # type: ignore[no-untyped-def]
    """State (5,) of another density and pressure, and of the speed u in place of `across`."""
    return (
        density,
        state[1] - across * normal[0] + u * normal[0],
        state[2] - across * normal[1] + u * normal[1],
        state[3] - across * normal[2] + u * normal[2],
        p,
    )
