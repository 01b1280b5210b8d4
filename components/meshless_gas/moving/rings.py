"""The cloud of a body: rings of nodes round a circle, or half rings over an axis of symmetry."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from quintet.components.meshless_gas.clouds.cloud import INNER, SLIP, Cloud, Whole, with_ghosts
from quintet.components.meshless_gas.moving.params import Body
from quintet.interfaces.component import Array

CLOSE = 3.0  # spacings from the axis within which nodes have mirror images


class Ring(NamedTuple):
    """A body's cloud about the origin, and how its nodes hang together."""

    cloud: Cloud
    home: Whole  # (n, 8) neighbours: those in the own and the two layers beside it, itself for none
    height: Array  # (n,) m, above the wall
    rays: int  # nodes of a layer, the first of which is the wall


def ring(body: Body, region: int, patch: int, axisymmetric: bool) -> Ring:
    """Make the rings of a body at the origin.

    Parameters
    ----------
    body : Body
    region, patch : int
        Of the cloud, and of the boundary that its wall is.
    axisymmetric : bool
        Nodes are then those of the half plane z > 0, and areas and volumes those of whole circles.

    Returns
    -------
    Ring
    """
    count = max(4, body.rays // 2) if axisymmetric else body.rays
    angle = (np.arange(count) + 0.5) * (math.pi if axisymmetric else math.tau) / count
    heights = np.array(body.heights)
    outward = np.stack([-np.cos(angle), np.zeros(count), np.sin(angle)], axis=1)
    radii = body.radius + heights
    positions = (radii[:, None, None] * outward).reshape(-1, 3)
    arc = (math.pi if axisymmetric else math.tau) / count
    edges = np.concatenate([[radii[0]], 0.5 * (radii[1:] + radii[:-1]), [radii[-1]]])
    area, length = 0.5 * arc * np.diff(edges**2), arc * radii
    volumes = np.repeat(area, count)
    nodes = len(positions)
    normals, areas = np.zeros((nodes, 3)), np.zeros((nodes, 3))
    normals[:count] = outward
    areas[:count] = outward * length[0]
    if axisymmetric:
        volumes *= math.tau * positions[:, 2]
        areas[:count] *= math.tau * positions[:count, 2:]
    kind = np.full(nodes, INNER, np.int8)
    kind[:count] = SLIP
    thickness = np.diff(heights, append=2.0 * heights[-1] - heights[-2])
    made = Cloud(
        positions=positions,
        kind=kind,
        normals=normals,
        spacing=np.repeat(np.minimum(thickness, length), count),
        region=np.full(nodes, region, np.int32),
        volumes=volumes,
        areas=areas,
        patch=np.where(kind == SLIP, patch, 0).astype(np.int32),
        weight=np.full(nodes, body.weight),
        owner=np.zeros(0, np.int32),
        turn=np.zeros((0, 3, 3)),
    )
    images = np.full(nodes, -1)
    if axisymmetric:
        owner = np.flatnonzero(positions[:, 2] < CLOSE * max(body.spacing, length[-1]))
        mirror = np.diag([1.0, 1.0, -1.0])
        turns = np.repeat(mirror[None], len(owner), axis=0)
        made = with_ghosts(made, owner, positions[owner] @ mirror, turns)
        images[owner] = nodes + np.arange(len(owner))
    return Ring(made, _home(len(heights), count, images), np.repeat(heights, count), count)


def _home(layers: int, count: int, images: NDArray[np.int64]) -> Whole:
    """Eight neighbours of each node: those in a block of three layers by three rays."""
    layer, ray = np.divmod(np.arange(layers * count), count)
    columns = []
    for up in (0, -1, 1):
        for side in (-1, 0, 1):
            if up == 0 and side == 0:
                continue
            level, beside = layer + up, ray + side
            row = level * count + beside % count
            over = (beside < 0) | (beside >= count)
            if images.max(initial=-1) >= 0:  # beyond the axis lies the image of the node itself
                own = level * count + ray
                row = np.where(over, images[np.clip(own, 0, len(images) - 1)], row)
            there = (level >= 0) & (level < layers)
            columns.append(np.where(there, row, layer * count + ray))
    return np.stack(columns, axis=1).astype(np.int32)
