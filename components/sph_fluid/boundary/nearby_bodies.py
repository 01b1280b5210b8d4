"""Which bodies stand so near to a wall, or to each other, that a film may lie between."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from quintet.components.sph_fluid.boundary.samples import Samples
from quintet.components.sph_fluid.params import SphFluidParams
from quintet.components.sph_fluid.state import Array, Whole


class Bounds(NamedTuple):
    """Boxes around the samples of bodies."""

    low: Array  # (bodies, 3) m
    high: Array  # (bodies, 3) m


def bodies_of(samples: Samples) -> tuple[Array, Whole]:
    """Numbers (bodies,) of all bodies, and where among them that of each sample (samples,) is."""
    number, body = np.unique(samples.body, return_inverse=True)
    return number, body.reshape(-1)


def bounds(place: Array, body: Whole, count: int) -> Bounds:
    """Boxes around the samples (n, 3) m of `count` bodies."""
    low, high = np.full((count, 3), np.inf), np.full((count, 3), -np.inf)
    np.minimum.at(low, body, place)
    np.maximum.at(high, body, place)
    return Bounds(low, high)


def near_walls(bodies: Bounds, params: SphFluidParams, reach: float) -> NDArray[np.bool_]:
    """Which bodies (bodies,) are nearer to a wall or an obstacle than `reach` [m]."""
    is_near = np.zeros(len(bodies.low), bool)
    if params.boundary.tank is not None:
        low, high = np.array(params.boundary.tank)
        for face in params.closed_faces:
            axis = "xyz".index(face[0])
            if face[1] == "-":
                is_near |= bodies.low[:, axis] < low[axis] + reach
            else:
                is_near |= bodies.high[:, axis] > high[axis] - reach
    for box in params.boundary.solids:
        low, high = np.array(box)
        is_near |= ((bodies.low < high + reach) & (bodies.high > low - reach)).all(axis=1)
    return is_near


def near_each_other(bodies: Bounds, reach: float) -> NDArray[np.bool_]:
    """Which bodies (bodies,) are nearer to another than `reach` [m], by the boxes around them."""
    order = np.argsort(bodies.low[:, 0], kind="stable")
    low, high = bodies.low[order], bodies.high[order]
    # Of boxes sorted by their lower ends along x, those that begin before another ends.
    first = np.arange(len(low))
    last = np.searchsorted(low[:, 0], high[:, 0] + reach)
    count = np.maximum(last - first - 1, 0)
    earlier: Whole = np.repeat(first, count)
    later = earlier + 1 + np.arange(len(earlier)) - np.repeat(np.cumsum(count) - count, count)
    is_apart = (low[later] > high[earlier] + reach) | (low[earlier] > high[later] + reach)
    is_near = ~is_apart.any(axis=1)
    has_neighbour = np.zeros(len(low), bool)
    has_neighbour[order[earlier[is_near]]] = has_neighbour[order[later[is_near]]] = True
    return has_neighbour
