"""Stress and heat flux between nodes, slopes at a wall, and what a rarefied gas does there.

Papers: Maxwell, Phil. Trans. R. Soc. 170 (1879) 231; Smoluchowski, Ann. Phys. 300 (1898) 101;
Kennard, Kinetic Theory of Gases (1938), sections 178 and 181.
"""

import math

from numba import njit

from quintet.components.meshless_gas.laws.boundaries import GATE
from quintet.components.meshless_gas.laws.fluxes import wall_pressure
from quintet.components.meshless_gas.laws.transport import sutherland
from quintet.components.shared.numba_options import FAST_INNER, INNER

TWO_THIRDS = 2.0 / 3.0


@njit(**INNER)
def gas_temperature(density, pressure, gas_constant):  # type: ignore[no-untyped-def]
    """Temperature [K] of a gas of a density [kg/m3] and a pressure [Pa]."""
    return pressure / (density * gas_constant)


@njit(**FAST_INNER)
def stress(u, v, w, mu):  # type: ignore[no-untyped-def]
    """Viscous stress xx yy zz xy xz yz over μ-scaled gradients of three velocities."""
    third = TWO_THIRDS * (u[0] + v[1] + w[2])
    return (
        mu * (2.0 * u[0] - third),
        mu * (2.0 * v[1] - third),
        mu * (2.0 * w[2] - third),
        mu * (u[1] + v[0]),
        mu * (u[2] + w[0]),
        mu * (v[2] + w[1]),
    )


@njit(**FAST_INNER)
def corrected(a, b, rise, r, inverse):  # type: ignore[no-untyped-def]
    """Gradient between two nodes whose component along r is their difference."""
    x, y, z = 0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1]), 0.5 * (a[2] + b[2])
    excess = (x * r[0] + y * r[1] + z * r[2] - rise) * inverse
    return x - excess * r[0], y - excess * r[1], z - excess * r[2]


@njit(**FAST_INNER)
def along(tensor, x, y, z):  # type: ignore[no-untyped-def]
    """A symmetric tensor xx yy zz xy xz yz times a vector."""
    xx, yy, zz, xy, xz, yz = tensor
    return xx * x + xy * y + xz * z, xy * x + yy * y + yz * z, xz * x + yz * y + zz * z


@njit(inline="always")
def pair_transfer(  # type: ignore[no-untyped-def]
    velocity_i, velocity_j, g, h, t, s, rise, r, inverse, coefficient, mu, law
):
    """Friction and conduction between two nodes, along their coefficient.

    Parameters
    ----------
    velocity_i, velocity_j : (3,) m/s
        Velocities of both nodes.
    g, h : (5, 3)
        Gradients of their density, velocity and pressure.
    t, s : (3,) K/m
        Gradients of their temperature.
    rise : float, K
        Of the temperature, from the first to the second.
    r, inverse : (3,) m and 1/m2
        From the first to the second, and one over its square.
    coefficient : (3,) 1/m
    mu : float, Pa s
    law : Transport

    Returns
    -------
    (4,) N/m3, W/m3
        τ·c, and (τ·v + λ∇T)·c.
    """
    cx, cy, cz = coefficient
    u, v, w = velocity_i
    a, b, c = velocity_j
    tensor = stress(
        corrected(g[1], h[1], a - u, r, inverse),
        corrected(g[2], h[2], b - v, r, inverse),
        corrected(g[3], h[3], c - w, r, inverse),
        mu,
    )
    q = corrected(t, s, rise, r, inverse)
    px, py, pz = along(tensor, cx, cy, cz)
    work = px * (u + a) + py * (v + b) + pz * (w + c)
    return px, py, pz, 0.5 * work + law.conduction * mu * (q[0] * cx + q[1] * cy + q[2] * cz)


@njit(inline="always")
def own_transfer(velocity_i, g, t, whole, mu, law):  # type: ignore[no-untyped-def]
    """As `pair_transfer`, by the node's own gradients along the sum (3,) 1/m of coefficients."""
    u, v, w = velocity_i
    px, py, pz = along(stress(g[1], g[2], g[3], mu), whole[0], whole[1], whole[2])
    heat = law.conduction * mu * (t[0] * whole[0] + t[1] * whole[1] + t[2] * whole[2])
    return px, py, pz, px * u + py * v + pz * w + heat


@njit(inline="always")
def diffusion_rate(total, density, mu, gamma, law):  # type: ignore[no-untyped-def]
    """What diffusion adds to one over the stable step [1/s]: 2 Σ |c|/|r| · γ μ/(Pr ρ).

    Parameters
    ----------
    total : float, 1/m2
        Σ |c|/|r|.
    law : Transport
        As `fastest_spread` has it.
    """
    heat = gamma / (gamma - 1.0) * law.gas_constant
    factor = 2.0 * gamma * law.conduction / heat
    return total * factor * mu / density


@njit(inline="always")
def wall_state(pressure, warmth, into, velocity, temperature, gamma, law):  # type: ignore[no-untyped-def]
    """State (5,) at a no-slip wall: its velocity and temperature, the gas's pressure.

    Parameters
    ----------
    pressure, warmth : float, Pa and K
        Of the gas above.
    into : float, m/s
        Its speed into the wall.
    velocity : (3,) m/s
        Of the wall.
    temperature : float, K
        Negative where the wall is adiabatic.
    """
    mach = into / math.sqrt(gamma * law.gas_constant * warmth)
    if mach > GATE:
        pressure = wall_pressure(pressure, mach, gamma)
    if temperature > 0.0:
        warmth = temperature
    density = pressure / (law.gas_constant * warmth)
    return density, velocity[0], velocity[1], velocity[2], pressure


@njit(inline="always")
def wall_traction(state, first, second, near, far, velocity, normal, law):  # type: ignore[no-untyped-def]
    """Friction (3,) Pa along a no-slip wall and heat flux [W/m2] into it, of second order.

    Parameters
    ----------
    state, first, second : (5,) kg/m3, m/s, Pa
        On the wall and at far_temperature nodes above it.
    near, far : float, m
        Heights of these.
    velocity, normal : (3,) m/s and 1
        Of the wall.
    law : Transport

    Returns
    -------
    (4,) Pa, W/m2
    """
    wall = gas_temperature(state[0], state[4], law.gas_constant)
    mu = sutherland(wall, law)
    near_temperature = gas_temperature(first[0], first[4], law.gas_constant)
    far_temperature = gas_temperature(second[0], second[4], law.gas_constant)
    heat = law.conduction * mu * wall_slope(wall, near_temperature, far_temperature, near, far)
    x = mu * wall_slope(velocity[0], first[1], second[1], near, far)
    y = mu * wall_slope(velocity[1], first[2], second[2], near, far)
    z = mu * wall_slope(velocity[2], first[3], second[3], near, far)
    through = x * normal[0] + y * normal[1] + z * normal[2]
    return x - through * normal[0], y - through * normal[1], z - through * normal[2], heat


@njit(**INNER)
def wall_slope(at_wall, first, second, near, far):  # type: ignore[no-untyped-def]
    """Slope at a wall of the parabola through it and two values above it.

    Parameters
    ----------
    at_wall, first, second : float
        Values on the wall and at the two distances.
    near, far : float, m

    Returns
    -------
    float, 1/m times the value's unit
        Of first order where there is no second, 0 where there is none.
    """
    if not far > near:
        return (first - at_wall) / near if near > 0.0 else 0.0
    return ((first - at_wall) * far / near - (second - at_wall) * near / far) / (far - near)


@njit(**INNER)
def slope_shares(near, far):  # type: ignore[no-untyped-def]
    """Shares (3,) 1/m of the values at the wall and at two distances in `wall_slope`."""
    if not far > near:
        return (-1.0 / near, 1.0 / near, 0.0) if near > 0.0 else (0.0, 0.0, 0.0)
    first, second = far / near / (far - near), -near / far / (far - near)
    return -first - second, first, second


@njit(**INNER)
def mean_free_path(viscosity, pressure, temperature, gas_constant):  # type: ignore[no-untyped-def]
    """Mean free path λ = μ/p √(π R T/2) of a gas.

    Parameters
    ----------
    viscosity : float, Pa s
    pressure : float, Pa
    temperature : float, K
    gas_constant : float, J/(kg K)

    Returns
    -------
    float, m

    References
    ----------
    Maxwell, Phil. Trans. R. Soc. 170 (1879) 231.
    """
    return viscosity / pressure * math.sqrt(0.5 * math.pi * gas_constant * temperature)


def slip_length(momentum: float) -> float:
    """Slip velocity over λ ∂u/∂n, by the share of molecules that leave a wall in any direction.

    References
    ----------
    Maxwell, Phil. Trans. R. Soc. 170 (1879) 231: (2 - σ)/σ.
    """
    return (2.0 - momentum) / momentum


def jump_length(energy: float, gamma: float, prandtl: float) -> float:
    """Jump of temperature over λ ∂T/∂n, by the share of energy that is left at a wall.

    References
    ----------
    Smoluchowski, Ann. Phys. 300 (1898) 101; Kennard (1938), eq. (181): (2 - α)/α 2γ/(γ + 1)/Pr.
    """
    return (2.0 - energy) / energy * 2.0 * gamma / ((gamma + 1.0) * prandtl)
