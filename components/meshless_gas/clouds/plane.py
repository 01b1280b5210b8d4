"""Clouds of one plane: layers over a line of wall."""

import math

import numpy as np
from numpy.typing import NDArray

from quintet.components.meshless_gas.clouds.cloud import Whole
from quintet.components.meshless_gas.clouds.grading import geometric
from quintet.components.meshless_gas.clouds.layers import (
    Bounds,
    LayeredCloud,
    Sides,
    SurfaceGrid,
    heights,
    kinds_of,
    layered,
)
from quintet.components.meshless_gas.clouds.meridian import Reach
from quintet.interfaces.component import Array


def line(count: int) -> SurfaceGrid:
    """Neighbours on a line of nodes that ends."""
    node = np.arange(count)
    neighbours = np.stack([node - 1, node + 1], axis=1)
    neighbours[-1, 1] = -1
    is_edge = (node == 0) | (node == count - 1)
    return SurfaceGrid(
        neighbours.astype(np.int32),
        np.zeros(0, np.int32),
        np.zeros((0, 3, 3)),
        is_edge,
    )


def wall_line(
    foot: Array,
    distance: Array,
    surface: SurfaceGrid,
    numbers: tuple[Whole, Whole, Whole],
    kinds: NDArray[np.int8],
    weight: float,
    is_cross: bool,
) -> LayeredCloud:
    """Layers over a line of wall in the plane x, z.

    Parameters
    ----------
    foot : (m, 3) m
        The wall's nodes, the gas on the left of who walks along them.
    distance : (layers,) or (layers, m) m
        Of each layer from the wall, straight up along the normal of the whole line.
    surface : SurfaceGrid
        Which nodes of the wall are neighbours.
    numbers : three of (m,)
        Of boundaries at the first and last layer, and at edges.
    kinds : (p,)
        What nodes of each boundary are.
    weight : float, 1
        Of the least squares.
    is_cross : bool
        Without diagonal neighbours.

    Returns
    -------
    LayeredCloud
        Per metre of depth.
    """
    span = foot[-1] - foot[0]
    up = np.array([-span[2], 0.0, span[0]]) / math.hypot(span[0], span[2])
    height = np.broadcast_to(distance.reshape(len(distance), -1), (len(distance), len(foot)))
    places = foot + up * height[:, :, None]
    length = np.sqrt((np.diff(foot, axis=0) ** 2).sum(axis=1))
    share = np.zeros(len(foot))
    share[:-1] += 0.5 * length
    share[1:] += 0.5 * length
    areas = np.repeat(share[None], len(distance), axis=0)
    normals = np.tile(up, (len(foot), 1))
    along = span / math.hypot(span[0], span[2])
    sides = np.zeros(places.shape)
    sides[:, [0, -1]] = heights(places[:, [0, -1]])[:, :, None] * np.stack([along, -along])
    bounds = Bounds(*numbers, kinds, normals, areas, -up * areas[-1][:, None], sides, weight)
    return layered(places, surface, bounds, is_cross)


def plate(
    reach: Reach,
    length: float,
    ahead: float,
    height: float,
    finest: float,
    sides: Sides,
) -> LayeredCloud:
    """Layers over a flat plate from x = 0 on, and over a stretch of free stream ahead of it.

    Parameters
    ----------
    reach : Reach
        Rays are the nodes along the plate.
    length, ahead, height : float, m
    finest : float, m
        Distance of nodes at the leading edge.
    sides : Sides
        The plate ("wall") and what is before it ("ahead"), upstream ("inlet"), above ("far") and
        downstream ("exit").
    """
    patches = sides.patches
    behind = geometric(finest, length, reach.rays)[:, 0]
    before = -geometric(finest, ahead, max(4, reach.rays // 4))[:0:-1, 0]
    x = np.concatenate([before, behind])
    foot = np.stack([x, np.zeros(len(x)), np.zeros(len(x))], axis=1)
    distance = geometric(reach.first, height, reach.layers)[:, 0]
    edge = np.zeros(len(x), np.int32)
    edge[0], edge[-1] = patches["inlet"], patches["exit"]
    first = np.where(x < 0.0, patches["ahead"], patches["wall"]).astype(np.int32)
    last = np.full(len(x), patches["far"], np.int32)
    numbers = (first, last, edge)
    return wall_line(
        foot, distance, line(len(x)), numbers, kinds_of(sides), reach.weight, reach.is_cross
    )
