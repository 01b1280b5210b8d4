"""The cloud of a body: rings of nodes round a circle, or half rings over an axis of symmetry."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from quintet.components.meshless_gas.clouds.cloud import (
    INNER,
    OUTFLOW,
    SLIP,
    Cloud,
    Whole,
    with_ghosts,
)
from quintet.components.meshless_gas.clouds.grading import capped
from quintet.components.meshless_gas.moving_bodies import Body
from quintet.interfaces.component import Array

CLOSE = 3.0  # spacings from the axis within which nodes have mirror images


class Ring(NamedTuple):
    """A body's cloud about the origin, and how its nodes hang together."""

    cloud: Cloud
    home: Whole  # (n, 8) neighbours: those in the own and the two layers beside it, itself for none
    height: Array  # (n,) m, above the wall
    rays: int  # nodes of a layer, the first of which is the wall
    leaving: NDArray[np.int64]  # (o,) nodes where gas leaves downstream
    before: NDArray[np.int64]  # (o,) and those beside them


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
    angle, arc = _angles(body, axisymmetric)
    count, heights = len(angle), heights_over(body, angle)
    outward = np.stack([-np.cos(angle), np.zeros(count), np.sin(angle)], axis=1)
    radii = body.radius + heights
    positions = (radii[:, :, None] * outward).reshape(-1, 3)
    edges = np.concatenate([radii[:1], 0.5 * (radii[1:] + radii[:-1]), radii[-1:]])
    length = arc * radii
    volumes = (0.5 * arc * np.diff(edges**2, axis=0)).ravel()
    nodes = len(positions)
    normals, areas = np.zeros((nodes, 3)), np.zeros((nodes, 3))
    kind = np.full(nodes, INNER, np.int8)
    leaving = np.zeros(0, np.int64)
    if body.is_cut:
        leaving = np.arange(2 * count - 1, nodes, count)
        kind[leaving] = OUTFLOW
        normals[leaving] = [-math.sin(angle[-1]), 0.0, -math.cos(angle[-1])]
        areas[leaving] = normals[leaving] * np.diff(edges[:, -1])[1:, None]
    kind[:count] = SLIP
    normals[:count] = outward
    areas[:count] = outward * length[0][:, None]
    if axisymmetric:
        volumes *= math.tau * positions[:, 2]
        areas *= math.tau * positions[:, 2:]
    thickness = np.diff(heights, axis=0, append=2.0 * heights[-1:] - heights[-2:-1])
    cloud = Cloud(
        positions=positions,
        kind=kind,
        normals=normals,
        spacing=np.minimum(thickness, arc[0] * radii).ravel(),
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
        cloud, images = _mirrored(cloud, CLOSE * max(body.spacing, length[-1, 0]))
    home = _home(len(heights), count, images, body.is_cut)
    return Ring(cloud, home, heights.ravel(), count, leaving, leaving - 1)


def _mirrored(cloud: Cloud, reach: float) -> tuple[Cloud, NDArray[np.int64]]:
    """Add mirror images of nodes within reach [m] of the axis; return each node's image or -1."""
    owner = np.flatnonzero(cloud.positions[:, 2] < reach)
    mirror = np.diag([1.0, 1.0, -1.0])
    turns = np.repeat(mirror[None], len(owner), axis=0)
    images = np.full(len(cloud.positions), -1)
    images[owner] = len(images) + np.arange(len(owner))
    return with_ghosts(cloud, owner, cloud.positions[owner] @ mirror, turns), images


def _angles(body: Body, axisymmetric: bool) -> tuple[Array, Array]:
    """Angles [rad] of rays from upstream, and of the arc that each stands for."""
    if body.is_cut:  # the last ray lies at the sector's end, and stands for half as much
        count = max(4, round(body.points_around * body.sector / math.tau))
        step = body.sector / (count - 0.5)
        arc = np.full(count, step)
        arc[-1] *= 0.5
        return (np.arange(count) + 0.5) * step, arc
    turn = math.pi if axisymmetric else math.tau
    count = max(4, body.points_around // 2) if axisymmetric else body.points_around
    return (np.arange(count) + 0.5) * turn / count, np.full(count, turn / count)


def heights_over(body: Body, angle: Array) -> Array:
    """Heights (layers, rays) m of nodes above the wall."""
    heights = np.array(body.heights)
    if body.first_spacing_at_sector is None:
        return np.repeat(heights[:, None], len(angle), axis=1)
    # Thickness of a boundary layer at a blunt body: about 1/√p, and p falls with the angle.
    share = ((1.0 - np.cos(angle)) / (1.0 - math.cos(body.sector))) ** 2
    first = heights[1] + share * (body.first_spacing_at_sector - heights[1])
    return capped(first, heights[-1], len(heights) - 1, body.spacing)


def _home(layers: int, count: int, images: NDArray[np.int64], is_cut: bool) -> Whole:
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
                itself = level * count + ray
                row = np.where(over, images[np.clip(itself, 0, len(images) - 1)], row)
            exists = (level >= 0) & (level < layers)
            if is_cut:  # beyond the last ray lies nothing
                exists &= beside < count
            columns.append(np.where(exists, row, layer * count + ray))
    return np.stack(columns, axis=1).astype(np.int32)
