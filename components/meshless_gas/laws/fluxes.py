"""Physics of one pair of nodes: where slopes are kept, the flux between two states, the wall.

Loops over lanes call these, so nothing branches: what does not hold is chosen away.
"""

import math

from numba import njit

from quintet.components.meshless_gas.laws.limiters import FAST_LANEWISE

SENSED, WIDTH = 0.2, 0.3  # pressure ratio below which slopes vanish, and over which they grow
COLLIDING = 4.0  # ram pressure over pressure above which streams collide
LEAST = 0.05  # of the smaller of two densities or pressures: below it slopes are left out


@njit(**FAST_LANEWISE)
def smoothness(lowest_i, lowest_j, pressure_i, pressure_j, ram):  # type: ignore[no-untyped-def]
    """Share of the slopes that is kept: 0 where the least pressure near is far below the pair's.

    A jump within a node's cloud spoils its gradient, and with it the mirror image that the limiter
    compares with; the limiter cannot see it. Streams that collide count with their `ram` pressure
    ρ Δu² [Pa] before there is a shock between them, where it is `COLLIDING` times the pressure.
    """
    most = max(pressure_i, pressure_j)
    ratio = min(lowest_i, lowest_j) / (most + max(ram - COLLIDING * most, 0.0))
    return min(max((ratio - SENSED) / WIDTH, 0.0), 1.0)


@njit(**FAST_LANEWISE)
def ausmpw(  # type: ignore[no-untyped-def]
    density_l, normal_l, pressure_l, density_r, normal_r, pressure_r, lowest, gamma
):
    """AUSMPW+: mass carried from the left and from the right, and the pressure between them.

    Parameters
    ----------
    density_l, density_r : float, kg/m3
    normal_l, normal_r : float, m/s
        Velocities along the direction from left to right.
    pressure_l, pressure_r, lowest : float, Pa
        Of both sides, and the least around them.
    gamma : float, 1

    Returns
    -------
    float, kg/(m2 s) : from the left
    float, kg/(m2 s) : from the right
    float, Pa

    References
    ----------
    Kim, Kim & Rho, J. Comput. Phys. 174 (2001) 38, equations 10 to 21.
    """
    heat = gamma / (gamma - 1.0)
    enthalpy_l = heat * pressure_l / density_l + 0.5 * normal_l * normal_l
    enthalpy_r = heat * pressure_r / density_r + 0.5 * normal_r * normal_r
    critical = (gamma - 1.0) / (gamma + 1.0) * (enthalpy_l + enthalpy_r)  # speed of sound squared
    upwind = normal_l if normal_l + normal_r >= 0.0 else normal_r
    per_speed = max(abs(upwind), math.sqrt(critical)) / critical  # s/m
    mach_l, mach_r = normal_l * per_speed, normal_r * per_speed
    a, b = min(max(mach_l, -1.0), 1.0), min(max(mach_r, -1.0), 1.0)
    forward = 0.25 * (a + 1.0) * (a + 1.0)  # M⁺ and M⁻, and what is beyond the speed of sound
    backward = -0.25 * (b - 1.0) * (b - 1.0)
    square_l, square_r = a * a - 1.0, b * b - 1.0
    push_l = forward * (2.0 - a) + 0.1875 * a * square_l * square_l
    push_r = -backward * (2.0 + b) - 0.1875 * b * square_r * square_r
    forward += max(mach_l - 1.0, 0.0)
    backward += min(mach_r + 1.0, 0.0)
    pressure = push_l * pressure_l + push_r * pressure_r
    least, most = min(pressure_l, pressure_r), max(pressure_l, pressure_r)
    ratio = least / most
    weight = 1.0 - ratio * ratio * ratio
    near = min(lowest / least, 1.0)
    inverse = 1.0 / max(pressure, 1e-12 * most)
    f_l = (pressure_l * inverse - 1.0) * near * near if abs(mach_l) < 1.0 else 0.0
    f_r = (pressure_r * inverse - 1.0) * near * near if abs(mach_r) < 1.0 else 0.0
    rightward = forward + backward >= 0.0
    whole_l = forward + backward * ((1.0 - weight) * (1.0 + f_r) - f_l)
    whole_r = backward + forward * ((1.0 - weight) * (1.0 + f_l) - f_r)
    part_l, part_r = forward * weight * (1.0 + f_l), backward * weight * (1.0 + f_r)
    carried_l = whole_l if rightward else part_l
    carried_r = part_r if rightward else whole_r
    return carried_l * density_l / per_speed, carried_r * density_r / per_speed, pressure


@njit(**FAST_LANEWISE)
def wall_pressure(pressure, mach, gamma):  # type: ignore[no-untyped-def]
    """Pressure [Pa] at a wall that gas runs into at a Mach number: behind the shock that stops it.

    References
    ----------
    Toro, Riemann Solvers and Numerical Methods for Fluid Dynamics (2009), section 6.3.3.
    """
    part = 0.25 * (gamma + 1.0) * mach
    return pressure * (1.0 + gamma * mach * (part + math.sqrt(part * part + 1.0)))
