"""What symmetry about an axis adds to the flow of a half plane."""

from typing import Any

import numpy as np
from numba import njit

from quintet.components.shared.numba_options import EXACT, FAST


@njit(**EXACT)
def add_axis(
    first: int, last: int, rows: Any, positions: Any, primitive: Any, gamma: float, residual: Any
) -> None:
    """Add -(ρw, ρuw, ρw², (E + p)w)/r: circles of nodes grow with their radius r = z.

    Nodes lie on neither side of the axis, whose image is beyond it, so r is never 0.
    """
    for row in range(first, last):
        i = np.uintp(rows[row])
        r, u, w, p = primitive[i, 0], primitive[i, 1], primitive[i, 3], primitive[i, 4]
        rate = r * w / positions[i, 2]
        residual[i, 0] -= rate
        residual[i, 1] -= rate * u
        residual[i, 3] -= rate * w
        residual[i, 4] -= rate * (gamma / (gamma - 1.0) * p / r + 0.5 * (u * u + w * w))


@njit(**EXACT)
def write_swelling(first: int, last: int, positions: Any, primitive: Any, transported: Any,
                   swelling: Any) -> None:  # fmt: skip
    """Write -2/3 μ w/r (n,) Pa: what circles that grow add to the normal stresses."""
    for i in range(first, last):
        swelling[i] = -2.0 / 3.0 * transported[i, 1] * primitive[i, 3] / positions[i, 2]


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
    """Add to momentum and energy what stresses about an axis have more than those of a plane.

    With s = -2/3 μ w/r: (∂s/∂x + τ_xr/r, ∂s/∂r + 2μ(∂w/∂r - w/r)/r,
    ∇·(s v) + (u τ_xr + w τ_rr + λ ∂T/∂r)/r).
    """
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
        shear = mu * (g[1, 2] + g[3, 0])
        normal = mu * (2.0 * g[3, 2] - 2.0 / 3.0 * (g[1, 0] + g[3, 2])) + s
        residual[i, 1] += along + shear / r
        residual[i, 3] += across + 2.0 * mu * (g[3, 2] - w / r) / r
        heat = conduction * mu * temperature_gradients[i, 2]
        residual[i, 4] += power + (u * shear + w * normal + heat) / r
