"""States of outflow nodes by planes through the nodes within, of second order.

What leaves faster than sound is the gas within, continued to the boundary. Of slower gas the wave
that comes in from beyond is left out: its amplitude δp - ρa δu there is that of the gas within.
"""

import math
from typing import Any, NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from quintet.components.meshless_gas.clouds.cloud import INNER as WITHIN
from quintet.components.meshless_gas.clouds.cloud import OUTFLOW, Cloud, Whole
from quintet.components.meshless_gas.laws.boundaries import BACK_PRESSURE
from quintet.components.meshless_gas.laws.outflows import continued, outward_speed, roughness
from quintet.components.meshless_gas.laws.states import sound_speed
from quintet.components.shared.numba_options import EXACT, INNER
from quintet.interfaces.component import Array


class Outflows(NamedTuple):
    """Outflow nodes, and the planes through what is near to them within."""

    rows: NDArray[np.int32]  # (o,)
    near: Whole  # (o, m), padded with the node itself
    weights: Array  # (o, 4, m) 1 and 1/m, of their values in the plane's at the node and its slopes


def outflows(cloud: Cloud, neighbours: Whole) -> Outflows:
    """Planes by least squares through neighbours within and theirs, of weight 1/d²."""
    rows = np.flatnonzero(cloud.kind == OUTFLOW).astype(np.int32)
    around = neighbours[neighbours[rows]].reshape(len(rows), neighbours.shape[1] ** 2)
    around = np.sort(np.hstack([neighbours[rows], around]), axis=1)
    first = np.hstack([np.ones((len(rows), 1), bool), np.diff(around, axis=1) > 0])
    chosen = first & (cloud.kind[around] == WITHIN)
    many = int(chosen.sum(axis=1).max(initial=0))
    order = np.argsort(~chosen, axis=1, kind="stable")[:, :many]
    chosen, around = (np.take_along_axis(array, order, axis=1) for array in (chosen, around))
    near = np.where(chosen, around, rows[:, None])
    arm = cloud.positions[near] - cloud.positions[rows][:, None]
    distance = np.sqrt((arm**2).sum(axis=2))
    scale = distance.max(axis=1, initial=0.0)[:, None]
    root = np.divide(scale, distance, out=np.zeros_like(distance), where=distance > 0.0)
    basis = np.concatenate([np.ones((*arm.shape[:2], 1)), arm / scale[:, :, None]], axis=2)
    # Directions in which nothing is near, as across a half plane, have no slope.
    weights = np.linalg.pinv(root[:, :, None] * basis, rcond=1e-6) * root[:, None]
    weights[:, 1:] /= scale[:, :, None]
    return Outflows(rows, near.astype(np.int32), weights)


def clear_of_holes(planes: Outflows, active: NDArray[np.bool_]) -> Outflows:
    """Those of them near to which no node is left out."""
    clear = active[planes.rows] & active[planes.near].all(axis=1)
    return Outflows(planes.rows[clear], planes.near[clear], planes.weights[clear])


@njit(**EXACT)
def continue_outflows(
    rows: Any,
    near: Any,
    weights: Any,
    positions: Any,
    patch: Any,
    patches: Any,
    normals: Any,
    gamma: float,
    primitive: Any,
) -> None:
    """Write the states of outflow nodes that hold those of their neighbours: of second order.

    Parameters
    ----------
    near : (o, m)
        Nodes within.
    weights : (o, 4, m) 1, 1/m
    patch : (n,)
        Which of `patches` nodes belong to.
    primitive : (n, 5) kg/m3, m/s, Pa
        The rows are written.
    """
    more, low, high = np.empty(5), np.empty(5), np.empty(5)
    for row in range(rows.shape[0]):
        i = rows[row]
        state = five(primitive[i])
        normal = (normals[i, 0], normals[i, 1], normals[i, 2])
        sound = sound_speed(state[0], state[4], gamma)
        out = outward_speed(state, normal)
        if patches[patch[i], BACK_PRESSURE] > 0.0 and abs(out) < sound:
            continue
        write_plane(i, near[row], weights[row], primitive, more, low, high)
        rough = roughness_near(positions, i, near[row], weights[row], primitive)
        new = continued(state, out, sound, normal, five(more), five(low), five(high), rough)
        for q in range(5):
            primitive[i, q] = new[q]


@njit(**INNER)
def five(row: Any) -> tuple[float, float, float, float, float]:
    """Numbers of a state."""
    return row[0], row[1], row[2], row[3], row[4]


@njit(**INNER)
def write_plane(
    i: int, near: Any, weights: Any, primitive: Any, more: Any, low: Any, high: Any
) -> None:
    """Write what the plane has more than the node (5,), and the least and most of nodes near."""
    for q in range(5):
        more[q] = -primitive[i, q]
    low[:], high[:] = math.inf, -math.inf
    for k in range(near.shape[0]):
        j = near[k]
        if j == i:
            continue
        for q in range(5):
            more[q] += weights[0, k] * primitive[j, q]
            low[q], high[q] = min(low[q], primitive[j, q]), max(high[q], primitive[j, q])


@njit(**INNER)
def roughness_near(positions: Any, i: int, near: Any, weights: Any, primitive: Any) -> float:
    """Roughness of the pressures that a plane goes through."""
    value, slope = 0.0, np.zeros(3)
    low, high = math.inf, -math.inf
    for k in range(near.shape[0]):
        p = primitive[near[k], 4]
        value += weights[0, k] * p
        for d in range(3):
            slope[d] += weights[1 + d, k] * p
        if near[k] != i:
            low, high = min(low, p), max(high, p)
    missed, count = 0.0, 0
    for k in range(near.shape[0]):
        if near[k] != i:
            off = primitive[near[k], 4] - value
            for d in range(3):
                off -= slope[d] * (positions[near[k], d] - positions[i, d])
            missed, count = missed + off * off, count + 1
    return roughness(missed, count, low, high)
