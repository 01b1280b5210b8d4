"""What symmetry about an axis adds to the flow of a half plane."""

from typing import Any

import numpy as np
from numba import njit

from quintet.components.meshless_gas.axis.laws import axis_rates, axis_stresses, swelling_stress
from quintet.components.shared.numba_options import EXACT, FAST


@njit(**EXACT)
def add_axis(
    first: int, last: int, rows: Any, positions: Any, primitive: Any, gamma: float, residual: Any
) -> None:
    """Add -(ρw, ρuw, ρw², (E + p)w)/r: circles of nodes grow with their radius r = z."""
    for row in range(first, last):
        i = np.uintp(rows[row])
        r, u, w, p = primitive[i, 0], primitive[i, 1], primitive[i, 3], primitive[i, 4]
        mass, along, across, energy = axis_rates(r, u, w, p, positions[i, 2], gamma)
        residual[i, 0] -= mass
        residual[i, 1] -= along
        residual[i, 3] -= across
        residual[i, 4] -= energy


@njit(**EXACT)
def write_swelling(first: int, last: int, positions: Any, primitive: Any, transported: Any,
                   swelling: Any) -> None:  # fmt: skip
    """Write -2/3 μ w/r (n,) Pa: what circles that grow add to the normal stresses."""
    for i in range(first, last):
        swelling[i] = swelling_stress(primitive[i, 3], transported[i, 1], positions[i, 2])


@njit(**FAST)
def add_axis_stresses(
    first: int,
    last: int,
    rows: Any,
    positions: Any,
    primitive: Any,
    transported: Any,
    swelling: Any,
    neighbours: Any,
    coefficients: Any,
    gradients: Any,
    temperature_gradients: Any,
    conduction: float,
    residual: Any,
) -> None:
    """Add to momentum and energy what stresses about an axis have more than those of a plane."""
    for row in range(first, last):
        i = np.uintp(rows[row])
        u, w, r = primitive[i, 1], primitive[i, 3], positions[i, 2]
        mu, s = transported[i, 1], swelling[i]
        along = across = power = 0.0
        for k in range(neighbours.shape[1]):
            j = np.uintp(neighbours[i, k])
            x, z = coefficients[i, k, 0], coefficients[i, k, 2]
            along += x * (swelling[j] - s)
            across += z * (swelling[j] - s)
            power += x * (swelling[j] * primitive[j, 1] - s * u)
            power += z * (swelling[j] * primitive[j, 3] - s * w)
        g = gradients[i]
        du, dw = (g[1, 0], g[1, 2]), (g[3, 0], g[3, 2])
        heat = conduction * mu * temperature_gradients[i, 2]
        fx, fr, fe = axis_stresses(along, across, power, u, w, r, mu, s, du, dw, heat)
        residual[i, 1] += fx
        residual[i, 3] += fr
        residual[i, 4] += fe
