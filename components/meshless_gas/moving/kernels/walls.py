"""Walls of bodies, and what they are loaded with."""

from typing import Any

from numba import njit

from quintet.components.meshless_gas.kernels.outflows import five
from quintet.components.meshless_gas.moving.laws import slip_wall_state
from quintet.components.shared.numba_options import EXACT

# Columns of loads (b, 8) on bodies.
FORCE, TORQUE = slice(0, 3), slice(3, 6)  # N, N m
POWER, HEAT = 6, 7  # W of the walls on the gas, W into the body


@njit(**EXACT)
def write_slip_walls(
    rows: Any, above: Any, heights: Any, normals: Any, velocity: Any, gamma: float, primitive: Any
) -> None:
    """Write the states of slip walls; see `slip_wall_state`.

    Parameters
    ----------
    above : (w, 2)
        Nodes above the walls.
    heights : (w, 2) m
        Of those nodes.
    normals : (w, 3) 1
        Into the gas.
    primitive : (n, 5)
        The rows are written.
    """
    for n in range(rows.shape[0]):
        first, second = five(primitive[above[n, 0]]), five(primitive[above[n, 1]])
        normal = (normals[n, 0], normals[n, 1], normals[n, 2])
        of_wall = (velocity[n, 0], velocity[n, 1], velocity[n, 2])
        near, far = heights[n, 0], heights[n, 1]
        state = slip_wall_state(first, second, near, far, normal, of_wall, gamma)
        for q in range(5):
            primitive[rows[n], q] = state[q]


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
