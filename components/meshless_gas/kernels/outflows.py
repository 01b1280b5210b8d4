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
from quintet.components.meshless_gas.kernels.boundaries import BACK_PRESSURE
from quintet.components.shared.numba_options import EXACT, INNER
from quintet.interfaces.component import Array

LEAST = 0.5  # of the least density and pressure near: what a continued state must keep
NOISE = 1e-6  # of the pressure, below which differences are none
ROUGH = 0.25  # share of what pressures near differ by that a plane misses: none is smooth
CROSSING = 0.2  # Mach numbers about that of sound over which the incoming wave is let go


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

    References
    ----------
    Hirsch, Numerical Computation of Internal and External Flows 2 (1990), section 19.1.
    """
    more, low, high = np.empty(5), np.empty(5), np.empty(5)
    for row in range(rows.shape[0]):
        i = rows[row]
        sound = math.sqrt(gamma * primitive[i, 4] / primitive[i, 0])
        out = outward_speed(primitive[i], normals[i])
        if patches[patch[i], BACK_PRESSURE] > 0.0 and abs(out) < sound:
            continue
        write_plane(i, near[row], weights[row], primitive, more, low, high)
        smooth = 1.0 - roughness(positions, i, near[row], weights[row], primitive) / ROUGH
        let_waves_out(out, sound, primitive[i, 0], normals[i], more)
        # Smooth flow may go on beyond what is near; where a shock is there is nothing beyond it.
        for q in range(5):
            beyond = max(smooth, 0.0) * (high[q] - low[q])
            least, most = low[q] - beyond, high[q] + beyond
            if q == 0 or q == 4:
                least = max(least, LEAST * low[q])
            primitive[i, q] = min(max(primitive[i, q] + more[q], least), most)
        back = -outward_speed(primitive[i], normals[i])
        if back > 0.0 and out > 0.0:  # what leaves nearby does not come back here
            for d in range(3):
                primitive[i, 1 + d] -= back * normals[i, d]


@njit(**INNER)
def outward_speed(state: Any, normal: Any) -> float:
    """Speed [m/s] against a normal into the gas of a state, or of a change of it."""
    speed = 0.0
    for d in range(3):
        speed -= state[1 + d] * normal[d]
    return speed


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
def let_waves_out(out: float, sound: float, density: float, normal: Any, more: Any) -> None:
    """Keep of a change (5,) what is carried along, if gas leaves, and what runs against it."""
    outward = outward_speed(more, normal)
    carried = min(max(out / (CROSSING * sound), 0.0), 1.0)
    against = min(max((out / sound - 1.0) / CROSSING, 0.0), 1.0)  # if the gas is faster
    ahead = 0.5 * (more[4] + density * sound * outward)
    behind = 0.5 * against * (more[4] - density * sound * outward)
    push, speed = ahead + behind, (ahead - behind) / (density * sound)
    more[0] = carried * (more[0] - more[4] / (sound * sound)) + push / (sound * sound)
    more[4] = push
    for d in range(3):
        along = more[1 + d] + outward * normal[d]
        more[1 + d] = carried * along - speed * normal[d]


@njit(**INNER)
def roughness(positions: Any, i: int, near: Any, weights: Any, primitive: Any) -> float:
    """Root mean square of what the plane misses pressures by, over the most that they differ by."""
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
    return math.sqrt(missed / max(count, 1)) / (high - low + NOISE * high)
