"""Walls of bodies that hold the gas; left out of scenes without friction."""

from typing import Any

from numba import njit

from quintet.components.meshless_gas.moving.laws import level_temperature
from quintet.components.meshless_gas.viscous.laws import gas_temperature
from quintet.components.shared.numba_options import EXACT


@njit(**EXACT)
def write_held_walls(
    rows: Any, above: Any, heights: Any, velocity: Any, temperature: Any, gas_constant: float,
    primitive: Any,
) -> None:  # fmt: skip
    """Write the states of no-slip walls, whose pressures are those of slip walls.

    Parameters
    ----------
    above : (w, 2)
        Nodes above the walls.
    heights : (w, 2) m
        Of those nodes.
    temperature : (w,) K
        Of the walls; negative where they are adiabatic.
    gas_constant : float, J/(kg K)
    primitive : (n, 5)
        Densities and velocities of the rows are written.
    """
    for n in range(rows.shape[0]):
        i, j, k = rows[n], above[n, 0], above[n, 1]
        warmth = temperature[n]
        if warmth < 0.0:
            first = gas_temperature(primitive[j, 0], primitive[j, 4], gas_constant)
            second = gas_temperature(primitive[k, 0], primitive[k, 4], gas_constant)
            warmth = level_temperature(first, second, heights[n, 0], heights[n, 1])
        primitive[i, 0] = primitive[i, 4] / (gas_constant * warmth)
        for d in range(3):
            primitive[i, 1 + d] = velocity[n, d]
