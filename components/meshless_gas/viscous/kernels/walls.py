"""What a no-slip wall does to the gas, and the gas to the wall."""

import math

from numba import njit

from quintet.components.meshless_gas.viscous.laws import gas_temperature, wall_state, wall_traction
from quintet.components.shared.numba_options import EXACT


@njit(**EXACT)
def write_no_slip_walls(  # type: ignore[no-untyped-def]
    rows, neighbours, weights, normals, velocity, temperature, gamma, law, primitive
):
    """Give nodes of no-slip walls the wall's velocity and temperature, the gas's pressure.

    Where gas runs into a wall at a Mach number above `GATE`, as after a start from the uniform
    stream, it has the pressure behind the shock that stops it: otherwise the stream would pass
    through a first layer that is thick.

    Parameters
    ----------
    weights : (w, K)
        With sum 1: of no slope along the normal.
    temperature : (w,) K
        Negative where the wall is adiabatic.
    primitive : (n, 5)
        The rows are written.
    """
    for n in range(rows.shape[0]):
        i = rows[n]
        pressure, warmth, into = 0.0, 0.0, 0.0
        for k in range(neighbours.shape[1]):
            j, share = neighbours[i, k], weights[n, k]
            if share == 0.0:
                continue
            pressure += share * primitive[j, 4]
            warmth += share * gas_temperature(primitive[j, 0], primitive[j, 4], law.gas_constant)
            for axis in range(3):
                into -= share * (primitive[j, 1 + axis] - velocity[n, axis]) * normals[i, axis]
        of_wall = (velocity[n, 0], velocity[n, 1], velocity[n, 2])
        state = wall_state(pressure, warmth, into, of_wall, temperature[n], gamma, law)
        for q in range(5):
            primitive[i, q] = state[q]


@njit(**EXACT)
def write_tractions(  # type: ignore[no-untyped-def]
    rows, above, positions, normals, velocity, primitive, law, friction, heat
):
    """Write friction (w, 3) Pa and heat flux (w,) W/m2 into walls, of second order.

    By parabolas through the wall and two nodes above it: the least-squares slope at the wall falls
    8 to 15 % short where the layer of temperature is eight spacings thick.
    """
    for n in range(rows.shape[0]):
        i, j, k = rows[n], above[n, 0], above[n, 1]
        near, far = 0.0, 0.0
        for axis in range(3):
            near += (positions[j, axis] - positions[i, axis]) * normals[i, axis]
            far += (positions[k, axis] - positions[i, axis]) * normals[i, axis]
        x, y, z, flux = wall_traction(
            primitive[i], primitive[j], primitive[k], near, far, velocity[n], normals[i], law
        )
        friction[n, 0], friction[n, 1], friction[n, 2], heat[n] = x, y, z, flux


@njit(**EXACT)
def add_wall_flows(areas, velocity, friction, heat, flows):  # type: ignore[no-untyped-def]
    """Take what friction and conduction give to walls from what enters: (5,) kg/s, N, W.

    Areas (w, 3) m2 are those of the walls' own faces.
    """
    for n in range(areas.shape[0]):
        size = 0.0
        for axis in range(3):
            size += areas[n, axis] ** 2
        size = math.sqrt(size)
        flows[4] -= size * heat[n]
        for axis in range(3):
            flows[1 + axis] -= size * friction[n, axis]
            flows[4] -= size * friction[n, axis] * velocity[n, axis]
