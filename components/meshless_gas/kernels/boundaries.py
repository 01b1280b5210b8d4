"""States of boundary nodes: given, or from the nodes within by weights along the normal.

∂φ/∂n = 0 at a node of normal n gives φ_i = Σ η_j φ_j/Σ η_j, η_j = c_ij·n, over neighbours within.
"""

from typing import Any

import numpy as np
from numba import njit

from quintet.components.meshless_gas.laws.boundaries import boundary_flow, boundary_state
from quintet.components.shared.numba_options import EXACT


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
        velocity = (0.0, 0.0, 0.0)
        if frame is not None:
            velocity = (frame[i, 0], frame[i, 1], frame[i, 2])
        state = boundary_state(
            kind[i],
            (near[0], near[1], near[2], near[3], near[4]),
            (outer[0], outer[1], outer[2], outer[3], outer[4], outer[5], outer[6], outer[7]),
            (normals[i, 0], normals[i, 1], normals[i, 2]),
            velocity,
            gamma,
            gas_constant,
        )
        for q in range(5):
            primitive[i, q] = state[q]


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
        state = (
            primitive[i, 0], primitive[i, 1], primitive[i, 2], primitive[i, 3], primitive[i, 4]
        )  # fmt: skip
        flow = boundary_flow(state, (areas[i, 0], areas[i, 1], areas[i, 2]), gamma)
        for q in range(5):
            flows[q] += flow[q]
