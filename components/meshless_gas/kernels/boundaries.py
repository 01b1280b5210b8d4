"""States of boundary nodes: given, or from the nodes within by weights along the normal.

∂φ/∂n = 0 at a node of normal n gives φ_i = Σ η_j φ_j/Σ η_j, η_j = c_ij·n, over neighbours within.
"""

import math
from typing import Any

import numpy as np
from numba import njit

from quintet.components.meshless_gas.clouds.cloud import INFLOW, OUTFLOW
from quintet.components.meshless_gas.kernels.far_field import meet
from quintet.components.meshless_gas.laws.fluxes import wall_pressure
from quintet.components.shared.numba_options import EXACT, INNER

# Columns of what a scene says of each boundary: 5 of its state, then these.
BACK_PRESSURE, TOTAL_PRESSURE, TOTAL_TEMPERATURE, PATCH_COLUMNS = 5, 6, 7, 8
NOISE = 1e-6  # relative difference from a given state below which gas within has this state
GATE = 0.5  # Mach number of the flow into a wall above which the wall pushes back


@njit(**EXACT)
def write_weights(
    rows: Any, kind: Any, normals: Any, neighbours: Any, coefficients: Any, weights: Any
) -> int:
    """Write the weights (b, K) of neighbours within; return the row of a node that has none, or -1.

    Weights below 0, as curved clouds have them, are left out.
    """
    lacks = -1
    for row in range(rows.shape[0]):
        i = rows[row]
        whole = 0.0
        for k in range(neighbours.shape[1]):
            j = neighbours[i, k]
            along = 0.0
            if kind[j] == 0:
                for d in range(3):
                    along += coefficients[i, k, d] * normals[i, d]
            weights[row, k] = max(along, 0.0)
            whole += weights[row, k]
        if whole == 0.0:  # at a corner: all that is within counts
            for k in range(neighbours.shape[1]):
                if kind[neighbours[i, k]] == 0 and neighbours[i, k] != i:
                    weights[row, k] = 1.0
                    whole += 1.0
        if whole == 0.0:
            lacks = row
        for k in range(neighbours.shape[1]):
            weights[row, k] /= whole
    return lacks


@njit(**EXACT)
def write_boundaries(
    rows: Any,
    kind: Any,
    patch: Any,
    normals: Any,
    neighbours: Any,
    weights: Any,
    patches: Any,
    frame: Any,
    gamma: float,
    gas_constant: float,
    primitive: Any,
) -> None:
    """Write the states of inflows, outflows and slip walls.

    Parameters
    ----------
    kind, patch : (n,)
        Of all nodes: what it is, and which of `patches` it belongs to.
    weights : (b, K) 1
    frame : None or (n, 3) m/s
        Velocities of walls.
    gas_constant : float, J/(kg K)
    """
    near = np.empty(5)
    for row in range(rows.shape[0]):
        i = rows[row]
        outer = patches[patch[i]]
        near[:] = 0.0
        for k in range(neighbours.shape[1]):
            if weights[row, k] > 0.0:
                for q in range(5):
                    near[q] += weights[row, k] * primitive[neighbours[i, k], q]
        if kind[i] == INFLOW and outer[TOTAL_PRESSURE] > 0.0:
            from_rest(near, outer, gamma, gas_constant)
        elif kind[i] == INFLOW:
            come_in(near, outer, normals[i], gamma)
        elif kind[i] == OUTFLOW:
            leave(near, normals[i], outer[BACK_PRESSURE], gamma)
        elif frame is None:
            slip(near, normals[i], 0.0, 0.0, 0.0, gamma)
        else:
            slip(near, normals[i], frame[i, 0], frame[i, 1], frame[i, 2], gamma)
        for q in range(5):
            primitive[i, q] = near[q]


@njit(**INNER)
def come_in(near: Any, outer: Any, normal: Any, gamma: float) -> None:
    """State of gas that comes in: the given one; slower than sound it lets waves out."""
    into, same = 0.0, True
    for d in range(3):
        into += outer[1 + d] * normal[d]
    sound = math.sqrt(gamma * outer[4] / outer[0])
    for q in range(5):
        size = outer[q] if q == 0 or q == 4 else sound
        same = same and abs(near[q] - outer[q]) <= NOISE * size
    if not same and into < sound:
        meet(near, outer, normal, gamma)
        return
    for q in range(5):
        near[q] = outer[q]


@njit(**INNER)
def from_rest(near: Any, outer: Any, gamma: float, gas_constant: float) -> None:
    """State that gas at rest comes to without losses, at the pressure of the gas it meets."""
    rest, hot = outer[TOTAL_PRESSURE], outer[TOTAL_TEMPERATURE]
    ratio = min(near[4] / rest, 1.0) ** ((gamma - 1.0) / gamma)
    temperature = hot * ratio
    speed = math.sqrt(2.0 * gamma / (gamma - 1.0) * gas_constant * (hot - temperature))
    pressure = min(near[4], rest)
    near[0], near[4] = pressure / (gas_constant * temperature), pressure
    for d in range(3):  # where its velocity says the direction alone
        near[1 + d] = speed * outer[1 + d]


@njit(**INNER)
def leave(near: Any, normal: Any, back: float, gamma: float) -> None:
    """State of gas that leaves: its own; below the speed of sound at the pressure beyond."""
    out = -(near[1] * normal[0] + near[2] * normal[1] + near[3] * normal[2])
    if back > 0.0 and out * out < gamma * near[4] / near[0]:
        near[0] *= (back / near[4]) ** (1.0 / gamma)
        near[4] = back


@njit(**INNER)
def slip(near: Any, normal: Any, u: float, v: float, w: float, gamma: float) -> None:
    """State beside a wall that moves with (u, v, w): nothing goes through; struck hard, it stops.

    A settled flow does not run into its walls, and what is left of it in a node beside one must not
    raise the pressure. Density follows the pressure without losses.
    """
    into = -((near[1] - u) * normal[0] + (near[2] - v) * normal[1] + (near[3] - w) * normal[2])
    mach = into / math.sqrt(gamma * near[4] / near[0])
    for d in range(3):
        near[1 + d] += into * normal[d]
    pressure = wall_pressure(near[4], mach if mach > GATE else 0.0, gamma)
    near[0] *= (pressure / near[4]) ** (1.0 / gamma)
    near[4] = pressure


@njit(**EXACT)
def boundary_flows(rows: Any, areas: Any, primitive: Any, gamma: float, flows: Any) -> None:
    """Write what enters through boundary nodes per second: (5,) kg/s, N, W.

    Parameters
    ----------
    rows : (b,)
        Boundary nodes that stand still.
    areas : (n, 3) m2
        Along normals into the gas.
    flows : (5,)
        Written.
    """
    flows[:] = 0.0
    for row in range(rows.shape[0]):
        i = rows[row]
        r, p = primitive[i, 0], primitive[i, 4]
        u, v, w = primitive[i, 1], primitive[i, 2], primitive[i, 3]
        x, y, z = areas[i, 0], areas[i, 1], areas[i, 2]
        volume = u * x + v * y + w * z
        mass = r * volume
        flows[0] += mass
        flows[1] += mass * u + p * x
        flows[2] += mass * v + p * y
        flows[3] += mass * w + p * z
        energy = gamma / (gamma - 1.0) * p + 0.5 * r * (u * u + v * v + w * w)
        flows[4] += volume * energy
