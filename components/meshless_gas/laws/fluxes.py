"""Physics of one pair of nodes: where slopes are kept, the flux between two states, the wall.

Loops over lanes call these, so nothing branches: what does not hold is chosen away.
"""

import math

from numba import njit

from quintet.components.meshless_gas.laws.limiters import FAST_LANEWISE, half_step

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


@njit(inline="always")
def half_steps(limiter, slope_i, slope_j, across, threshold):  # type: ignore[no-untyped-def]
    """Changes of a variable from both nodes to the middle of their pair, by slopes 2∇q·r."""
    return (
        half_step(limiter, slope_i - across, across, threshold),
        half_step(limiter, slope_j - across, across, threshold),
    )


@njit(inline="always")
def pair_direction(cx, cy, cz):  # type: ignore[no-untyped-def]
    """Size |c_ij| [1/m] of a coefficient, and its direction."""
    size = math.sqrt(cx * cx + cy * cy + cz * cz)
    per = 1.0 / max(size, 1e-300)
    return size, cx * per, cy * per, cz * per


@njit(inline="always")
def kept_share(state_i, state_j, direction, lowest_i, lowest_j):  # type: ignore[no-untyped-def]
    """Share of the slopes [1] that a pair keeps, by the pressures around it and how it closes.

    Parameters
    ----------
    state_i, state_j : (5,) kg/m3, m/s, Pa
        States of both nodes.
    direction : (4,) 1/m, 1
        As `pair_direction` has it.
    lowest_i, lowest_j : float, Pa
        Least pressures around both.
    """
    r, u, v, w, p = state_i
    rr, ur, vr, wr, pr = state_j
    _, x, y, z = direction
    closing = max((u - ur) * x + (v - vr) * y + (w - wr) * z, 0.0)
    ram = min(r, rr) * closing * closing
    return smoothness(lowest_i, lowest_j, p, pr, ram)


@njit(inline="always")
def thresholds(state_i, state_j, limiter):  # type: ignore[no-untyped-def]
    """Squares [kg2/m6, Pa2, m2/s2] beside which smaller ones of differences are not limited."""
    mean_r, mean_p, threshold = state_i[0] + state_j[0], state_i[4] + state_j[4], limiter.threshold
    eps_r = threshold * mean_r * mean_r
    eps_p = threshold * mean_p * mean_p
    return eps_r, eps_p, threshold * mean_p / mean_r


@njit(inline="always")
def positive_share(keep, state_i, state_j, density, pressure):  # type: ignore[no-untyped-def]
    """Share of the slopes that is kept: 0 where little density or pressure would be left.

    Parameters
    ----------
    keep : float, 1
    state_i, state_j : (5,) kg/m3, m/s, Pa
        States of both nodes.
    density, pressure : (2,) kg/m3, Pa
        Their changes from both nodes to the middle of the pair.
    """
    r, p, rr, pr = state_i[0], state_i[4], state_j[0], state_j[4]
    a, b = density
    c, d = pressure
    least_r, least_p = LEAST * min(r, rr), LEAST * min(p, pr)
    sound = (
        (r + keep * a > least_r)
        & (rr - keep * b > least_r)
        & (p + keep * c > least_p)
        & (pr - keep * d > least_p)
    )
    return keep if sound else 0.0


@njit(inline="always")
def sides(value_i, value_j, keep, changes):  # type: ignore[no-untyped-def]
    """Values of a variable on both sides of a pair's middle."""
    return value_i + keep * changes[0], value_j - keep * changes[1]


@njit(inline="always")
def pair_rates(state_i, left, right, direction, lowest, gamma):  # type: ignore[no-untyped-def]
    """Rates of density, momentum and energy of a node by the flux between it and a neighbour.

    Parameters
    ----------
    state_i, left, right : (5,) kg/m3, m/s, Pa
        States of the node and on both sides of the pair's middle, in the node's frame.
    direction : (4,) 1/m, 1
        As `pair_direction` has it.
    lowest : float, Pa
        Least pressure around both.
    gamma : float, 1

    Returns
    -------
    (5,) kg/(m3 s), N/m3, W/m3
        -2 |c_ij| (F(q_L, q_R; n_ij) - F(q_i; n_ij)).

    References
    ----------
    Katz & Jameson, AIAA J. 48 (2010) 1756, section II.
    """
    heat = gamma / (gamma - 1.0)
    r, u, v, w, p = state_i
    rl, ul, vl, wl, pl = left
    rr, ur, vr, wr, pr = right
    size, x, y, z = direction
    normal_l, normal_r = ul * x + vl * y + wl * z, ur * x + vr * y + wr * z
    carried_l, carried_r, pressure = ausmpw(rl, normal_l, pl, rr, normal_r, pr, lowest, gamma)
    mass = r * (u * x + v * y + w * z)
    push, factor = pressure - p, -2.0 * size
    enthalpy = heat * p / r + 0.5 * (u * u + v * v + w * w)
    enthalpy_l = heat * pl / rl + 0.5 * (ul * ul + vl * vl + wl * wl)
    enthalpy_r = heat * pr / rr + 0.5 * (ur * ur + vr * vr + wr * wr)
    density = factor * (carried_l + carried_r - mass)
    along_x = factor * (carried_l * ul + carried_r * ur - mass * u + push * x)
    along_z = factor * (carried_l * wl + carried_r * wr - mass * w + push * z)
    energy = factor * (carried_l * enthalpy_l + carried_r * enthalpy_r - mass * enthalpy)
    along_y = factor * (carried_l * vl + carried_r * vr - mass * v + push * y)
    return density, along_x, along_y, along_z, energy


@njit(**FAST_LANEWISE)
def in_laboratory(rates, x, y, z):  # type: ignore[no-untyped-def]
    """Rates (5,) of density, momentum and energy as a frame that moves with (x, y, z) has them."""
    r0, r1, r2, r3, r4 = rates
    r4 += x * r1 + y * r2 + z * r3 + 0.5 * (x * x + y * y + z * z) * r0
    return r0, r1 + x * r0, r2 + y * r0, r3 + z * r0, r4


@njit(**FAST_LANEWISE)
def wall_pressure(pressure, mach, gamma):  # type: ignore[no-untyped-def]
    """Pressure [Pa] at a wall that gas runs into at a Mach number: behind the shock that stops it.

    References
    ----------
    Toro, Riemann Solvers and Numerical Methods for Fluid Dynamics (2009), section 6.3.3.
    """
    part = 0.25 * (gamma + 1.0) * mach
    return pressure * (1.0 + gamma * mach * (part + math.sqrt(part * part + 1.0)))
