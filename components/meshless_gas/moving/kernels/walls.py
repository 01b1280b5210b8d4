"""Slip walls of bodies by a Riemann problem at the wall, and what they are loaded with."""

import math
from typing import Any

import numpy as np
from numba import njit

from quintet.components.meshless_gas.laws.fluxes import SENSED, WIDTH, wall_pressure
from quintet.components.shared.numba_options import EXACT

# Columns of loads (b, 8) on bodies.
FORCE, TORQUE = slice(0, 3), slice(3, 6)  # N, N m
POWER, HEAT = 6, 7  # W of the walls on the gas, W into the body
LEAST = 0.3  # of the first node's density and pressure: what a wall's state must keep


@njit(**EXACT)
def write_slip_walls(
    rows: Any, above: Any, heights: Any, normals: Any, velocity: Any, gamma: float, primitive: Any
) -> None:
    """Write the states of slip walls: what the two nodes above each say of the wall, stopped there.

    The state is extrapolated to the wall, so that what runs into it fades with the square of the
    height in a settled flow, and the pressure of the shock that stops it needs no threshold.

    Parameters
    ----------
    heights : (w, 2) m
        Of those nodes.
    normals : (w, 3) 1
        Into the gas.
    primitive : (n, 5)
        The rows are written.
    """
    state = np.empty(5)
    for n in range(rows.shape[0]):
        i, j, k = rows[n], above[n, 0], above[n, 1]
        ratio = min(primitive[j, 4], primitive[k, 4]) / max(primitive[j, 4], primitive[k, 4])
        keep = min(max((ratio - SENSED) / WIDTH, 0.0), 1.0)
        share = keep * heights[n, 0] / (heights[n, 1] - heights[n, 0])
        for q in range(5):
            state[q] = primitive[j, q] + share * (primitive[j, q] - primitive[k, q])
        if not (state[0] > LEAST * primitive[j, 0] and state[4] > LEAST * primitive[j, 4]):
            state[:] = primitive[j]
        into = 0.0
        for d in range(3):
            into -= (state[1 + d] - velocity[n, d]) * normals[n, d]
        for d in range(3):
            state[1 + d] += into * normals[n, d]
        mach = into / math.sqrt(gamma * state[4] / state[0])
        pressure = wall_pressure(state[4], max(mach, 0.0), gamma)
        primitive[i, 0] = state[0] * (pressure / state[4]) ** (1.0 / gamma)
        primitive[i, 1], primitive[i, 2], primitive[i, 3] = state[1], state[2], state[3]
        primitive[i, 4] = pressure


@njit(**EXACT)
def add_loads(
    rows: Any, body: Any, areas: Any, arms: Any, velocity: Any, primitive: Any, loads: Any
) -> None:
    """Add force and torque on bodies, and the work of the walls on the gas, by the pressure.

    Parameters
    ----------
    rows, body : (w,)
        Nodes of walls, and whose they are.
    areas : (w, 3) m2
        Along normals into the gas.
    arms : (w, 3) m
        From the centre.
    loads : (b, 8) N, N m, W
        Columns but for the heat are added to.
    """
    for n in range(rows.shape[0]):
        b, p = body[n], primitive[rows[n], 4]
        x, y, z = -p * areas[n, 0], -p * areas[n, 1], -p * areas[n, 2]
        loads[b, 0] += x
        loads[b, 1] += y
        loads[b, 2] += z
        loads[b, 3] += arms[n, 1] * z - arms[n, 2] * y
        loads[b, 4] += arms[n, 2] * x - arms[n, 0] * z
        loads[b, 5] += arms[n, 0] * y - arms[n, 1] * x
        loads[b, POWER] -= x * velocity[n, 0] + y * velocity[n, 1] + z * velocity[n, 2]
