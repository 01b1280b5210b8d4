"""States of boundary nodes, from those of the gas within and what the scene says of the boundary.

States are (5,) kg/m3, m/s, Pa; normals (3,) point into the gas.
"""

import math

from numba import njit

from quintet.components.meshless_gas.clouds.cloud import INFLOW, OUTFLOW
from quintet.components.meshless_gas.laws.far_field import meet
from quintet.components.meshless_gas.laws.fluxes import wall_pressure
from quintet.components.shared.numba_options import INNER

# Columns of what a scene says of each boundary: 5 of its state, then these.
BACK_PRESSURE, TOTAL_PRESSURE, TOTAL_TEMPERATURE, PATCH_COLUMNS = 5, 6, 7, 8
NOISE = 1e-6  # relative difference from a given state below which gas within has this state
GATE = 0.5  # Mach number of the flow into a wall above which the wall pushes back


@njit(**INNER)
def boundary_state(kind, near, outer, normal, velocity, gamma, gas_constant):  # type: ignore[no-untyped-def]
    """State of an inflow, an outflow or a slip wall.

    Parameters
    ----------
    kind : int
        What the node is.
    near : (5,)
        State of the gas within, of no slope along the normal.
    outer : (PATCH_COLUMNS,)
        What the scene says of the boundary.
    normal : (3,) 1
    velocity : (3,) m/s
        Of the wall.
    gas_constant : float, J/(kg K)
    """
    if kind == INFLOW:
        if outer[TOTAL_PRESSURE] > 0.0:
            return from_rest(near, outer, gamma, gas_constant)
        return come_in(near, outer, normal, gamma)
    if kind == OUTFLOW:
        return leave(near, normal, outer[BACK_PRESSURE], gamma)
    return slip(near, normal, velocity, gamma)


@njit(**INNER)
def come_in(near, outer, normal, gamma):  # type: ignore[no-untyped-def]
    """State of gas that comes in: the given one; slower than sound it lets waves out."""
    beyond = (outer[0], outer[1], outer[2], outer[3], outer[4])
    into = outer[1] * normal[0] + outer[2] * normal[1] + outer[3] * normal[2]
    sound = math.sqrt(gamma * outer[4] / outer[0])
    same = (
        abs(near[0] - outer[0]) <= NOISE * outer[0]
        and abs(near[1] - outer[1]) <= NOISE * sound
        and abs(near[2] - outer[2]) <= NOISE * sound
        and abs(near[3] - outer[3]) <= NOISE * sound
        and abs(near[4] - outer[4]) <= NOISE * outer[4]
    )
    if not same and into < sound:
        return meet(near, beyond, normal, gamma)
    return beyond


@njit(**INNER)
def from_rest(near, outer, gamma, gas_constant):  # type: ignore[no-untyped-def]
    """State that gas at rest comes to without losses, at the pressure of the gas it meets."""
    rest, hot = outer[TOTAL_PRESSURE], outer[TOTAL_TEMPERATURE]
    ratio = min(near[4] / rest, 1.0) ** ((gamma - 1.0) / gamma)
    temperature = hot * ratio
    speed = math.sqrt(2.0 * gamma / (gamma - 1.0) * gas_constant * (hot - temperature))
    pressure = min(near[4], rest)
    density = pressure / (gas_constant * temperature)
    # Where its velocity says the direction alone.
    return density, speed * outer[1], speed * outer[2], speed * outer[3], pressure


@njit(**INNER)
def leave(near, normal, back, gamma):  # type: ignore[no-untyped-def]
    """State of gas that leaves: its own; below the speed of sound at the pressure beyond."""
    out = -(near[1] * normal[0] + near[2] * normal[1] + near[3] * normal[2])
    if back > 0.0 and out * out < gamma * near[4] / near[0]:
        density = near[0] * (back / near[4]) ** (1.0 / gamma)
        return density, near[1], near[2], near[3], back
    return near


@njit(**INNER)
def slip(near, normal, velocity, gamma):  # type: ignore[no-untyped-def]
    """State beside a wall that moves: nothing goes through; struck hard, it stops.

    A settled flow has no velocity into its walls; a rest of it in the node beside a wall must not
    raise the pressure. Density follows the pressure at constant entropy.
    """
    into = -(
        (near[1] - velocity[0]) * normal[0]
        + (near[2] - velocity[1]) * normal[1]
        + (near[3] - velocity[2]) * normal[2]
    )
    mach = into / math.sqrt(gamma * near[4] / near[0])
    pressure = wall_pressure(near[4], mach if mach > GATE else 0.0, gamma)
    return (
        near[0] * (pressure / near[4]) ** (1.0 / gamma),
        near[1] + into * normal[0],
        near[2] + into * normal[1],
        near[3] + into * normal[2],
        pressure,
    )


@njit(**INNER)
def boundary_flow(state, area, gamma):  # type: ignore[no-untyped-def]
    """Mass, momentum and energy (5,) kg/s, N, W that enter through an area (3,) m2 into the gas."""
    r, u, v, w, p = state
    x, y, z = area
    volume = u * x + v * y + w * z
    mass = r * volume
    energy = gamma / (gamma - 1.0) * p + 0.5 * r * (u * u + v * v + w * w)
    return mass, mass * u + p * x, mass * v + p * y, mass * w + p * z, volume * energy


@njit(**INNER)
def held_along(state, conserved, normal):  # type: ignore[no-untyped-def]
    """Both states (5,) of a node on a plane of symmetry without the velocity through it.

    Density and pressure stay.
    """
    density = state[0]
    out = state[1] * normal[0] + state[2] * normal[1] + state[3] * normal[2]
    energy = conserved[4] - 0.5 * density * out * out
    x, y, z = out * normal[0], out * normal[1], out * normal[2]
    return (
        (density, state[1] - x, state[2] - y, state[3] - z, state[4]),
        (
            conserved[0],
            conserved[1] - density * out * normal[0],
            conserved[2] - density * out * normal[1],
            conserved[3] - density * out * normal[2],
            energy,
        ),
    )
