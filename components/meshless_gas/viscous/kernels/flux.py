"""Viscous stress and heat flux between nodes, added to what the Euler fluxes give.

    dq_i/dt += 2 Σ_j [F_ij - F_i] · c_ij,   F = (0, τ, τ·v + λ∇T)

With ∇φ_ij = g - (g·r - Δφ) r/r², g the mean of both nodes' gradients and r = x_j - x_i, so that a
pair feels its own difference: without it the flux does not see waves of two spacings.
"""

import numpy as np
from numba import njit

from quintet.components.meshless_gas.laws.transport import sutherland
from quintet.components.meshless_gas.viscous.laws import (
    diffusion_rate,
    gas_temperature,
    own_transfer,
    pair_transfer,
)
from quintet.components.shared.numba_options import EXACT, FAST


@njit(**EXACT)
def write_transport(first, last, primitive, law, transported):  # type: ignore[no-untyped-def]
    """Temperature [K] and viscosity [Pa s] of all nodes, (n, 2)."""
    for i in range(first, last):
        temperature = gas_temperature(primitive[i, 0], primitive[i, 4], law.gas_constant)
        transported[i, 0] = temperature
        transported[i, 1] = sutherland(temperature, law)


@njit(**FAST)
def write_temperature_gradients(  # type: ignore[no-untyped-def]
    first, last, rows, neighbours, coefficients, transported, gradients
):
    """Gradients (n, 3) K/m of temperature by least squares."""
    for row in range(first, last):
        i = np.uintp(rows[row])
        x, y, z, temperature = 0.0, 0.0, 0.0, transported[i, 0]
        for k in range(neighbours.shape[1]):
            rise = transported[np.uintp(neighbours[i, k]), 0] - temperature
            x += coefficients[i, k, 0] * rise
            y += coefficients[i, k, 1] * rise
            z += coefficients[i, k, 2] * rise
        gradients[i, 0], gradients[i, 1], gradients[i, 2] = x, y, z


@njit(**EXACT)
def write_ghost_slopes(begin, end, owner, turn, gradients):  # type: ignore[no-untyped-def]
    """Turn gradients (n, 3) of a scalar to the ghosts of their nodes."""
    first = gradients.shape[0] - owner.shape[0]
    for g in range(begin, end):
        x, y, z = gradients[owner[g], 0], gradients[owner[g], 1], gradients[owner[g], 2]
        for a in range(3):
            along = turn[g, a, 0] * x + turn[g, a, 1] * y + turn[g, a, 2] * z
            gradients[first + g, a] = along


@njit(**FAST)
def add_viscous(  # type: ignore[no-untyped-def]
    first, last, rows, positions, primitive, transported, neighbours, coefficients, gradients,
    temperature_gradients, law, residual,
):  # fmt: skip
    """Add rates of momentum and energy by friction and conduction to nodes.

    Parameters
    ----------
    transported : (n, 2) K, Pa s
    gradients : (n, 5, 3)
    temperature_gradients : (n, 3) K/m
    residual : (n, 5)
        Rates of density, momentum and energy per volume; the last four are added to.
    """
    for row in range(first, last):
        i = np.uintp(rows[row])
        g, t = gradients[i], temperature_gradients[i]
        x, y, z = positions[i, 0], positions[i, 1], positions[i, 2]
        u, v, w = primitive[i, 1], primitive[i, 2], primitive[i, 3]
        temperature, mu_i = transported[i, 0], transported[i, 1]
        fx, fy, fz, fe, sx, sy, sz = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
        for k in range(neighbours.shape[1]):
            j = np.uintp(neighbours[i, k])
            if j == i:
                continue
            cx, cy, cz = coefficients[i, k, 0], coefficients[i, k, 1], coefficients[i, k, 2]
            r = (positions[j, 0] - x, positions[j, 1] - y, positions[j, 2] - z)
            inverse = 1.0 / (r[0] * r[0] + r[1] * r[1] + r[2] * r[2])
            other = (primitive[j, 1], primitive[j, 2], primitive[j, 3])
            h, s = gradients[j], temperature_gradients[j]
            mu = 0.5 * (mu_i + transported[j, 1])
            rise = transported[j, 0] - temperature
            px, py, pz, pe = pair_transfer(
                (u, v, w), other, g, h, t, s, rise, r, inverse, (cx, cy, cz), mu, law
            )
            fx, fy, fz, fe = fx + px, fy + py, fz + pz, fe + pe
            sx, sy, sz = sx + cx, sy + cy, sz + cz
        px, py, pz, pe = own_transfer((u, v, w), g, t, (sx, sy, sz), mu_i, law)
        residual[i, 1] += 2.0 * (fx - px)
        residual[i, 2] += 2.0 * (fy - py)
        residual[i, 3] += 2.0 * (fz - pz)
        residual[i, 4] += 2.0 * (fe - pe)


@njit(**FAST)
def shorten_bounds(  # type: ignore[no-untyped-def]
    first, last, rows, positions, primitive, transported, neighbours, coefficients, gamma, law,
    bounds,
):  # fmt: skip
    """Shorten the stable step (n,) s of each node by what diffusion adds; return the least.

    1/Δt_i is raised by Σ_j 2 |c_ij|/|r_ij| · max(γ/Pr, 4/3) μ/ρ, of a law by `fastest_spread`.
    """
    least = np.inf
    for row in range(first, last):
        i = np.uintp(rows[row])
        total = 0.0
        for k in range(neighbours.shape[1]):
            j = np.uintp(neighbours[i, k])
            c, r = 0.0, 0.0
            for axis in range(3):
                c += coefficients[i, k, axis] ** 2
                r += (positions[j, axis] - positions[i, axis]) ** 2
            if r > 0.0:
                total += np.sqrt(c / r)
        rate = diffusion_rate(total, primitive[i, 0], transported[i, 1], gamma, law)
        bounds[i] = 1.0 / (1.0 / bounds[i] + rate)
        least = min(least, bounds[i])
    return least
