"""How the clouds of bodies are put together with their background."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from quintet.components.meshless_gas.clouds.cloud import Cloud, Whole, joined
from quintet.components.meshless_gas.moving.params import Moving
from quintet.components.meshless_gas.moving.rings import Ring, ring
from quintet.interfaces.component import Array

Rows = NDArray[np.int64]


class Layout(NamedTuple):
    """What of the clouds of bodies never changes; n nodes, w of them of walls."""

    home: Whole  # (n, K) neighbours of each node in its own cloud
    height: Array  # (n,) m, above the own body; ∞ of the background
    volumes: Array  # (n,) m3, of nodes that are not left out
    carried: Rows  # (c,) nodes of bodies' clouds
    carrier: Rows  # (c,) whose they are
    offsets: Array  # (c, 3) m, from the body's centre
    images: Rows  # (g,) images of carried nodes beyond the axis
    imaged: Rows  # (g,) and what they are images of
    walls: Rows  # (w,)
    body: Rows  # (w,)
    above: Rows  # (w, 2) the two nodes above each
    heights: Array  # (w, 2) m, of these
    arms: Array  # (w, 3) m, of walls from the centre
    second: Array  # (b,) m, height of the second layer of each body
    box: Array  # (2, 3) m, corners of the background
    open_sides: list[tuple[int, int]]  # axis and side of faces that clouds must not reach
    gamma: float


def with_bodies(background: Cloud, params: Moving, patch: int) -> tuple[Cloud, list[Ring]]:
    """Join the clouds of bodies, at their first positions, to a background."""
    rings = [ring(one, 1 + b, patch, params.axisymmetric) for b, one in enumerate(params.bodies)]
    moved = [
        one.cloud._replace(positions=one.cloud.positions + np.array(body.position))
        for one, body in zip(rings, params.bodies, strict=True)
    ]
    if params.axisymmetric:
        radius = background.positions[:, 2:]
        background = background._replace(
            volumes=math.tau * np.maximum(radius[:, 0], 0.0) * background.volumes,
            areas=math.tau * radius * background.areas,
        )
    return joined([background, *moved]), rings


def layout(
    cloud: Cloud,
    background: int,
    rings: list[Ring],
    params: Moving,
    neighbours: Whole,
    box: Array,
    gamma: float,
) -> Layout:
    """Say how bodies' clouds lie in the joined cloud.

    Parameters
    ----------
    cloud : Cloud
    background : int
        Number of nodes of the background.
    rings : list of Ring
    params : Moving
    neighbours : (n, K)
        Of the background; rows of other nodes are written.
    box : (2, 3) m
    gamma : float, 1
    """
    count = cloud.nodes
    ghosts = len(cloud.owner) - sum(len(one.cloud.owner) for one in rings)
    height, volumes = np.full(count, np.inf), cloud.volumes[:count].copy()
    first, image = background, count + ghosts
    carried, carrier, offsets, walls, body, above = [], [], [], [], [], []
    heights, arms, second, images = [], [], [], []
    for b, one in enumerate(rings):
        nodes, rows = one.cloud.nodes, one.home
        own = np.where(rows < nodes, rows + first, rows - nodes + image)
        place = np.arange(first, first + nodes)
        neighbours[place] = place[:, None]
        neighbours[place, : own.shape[1]] = own
        height[place] = one.height
        # Nodes beyond what the background leaves free count no volume twice.
        body_ = params.bodies[b]
        depth = one.height.max() - (params.overlap + 0.5) * body_.spacing
        volumes[place] *= one.height <= depth
        carried.append(place)
        carrier.append(np.full(nodes, b))
        offsets.append(one.cloud.positions[:nodes])
        wall = np.arange(one.rays)
        walls.append(first + wall)
        body.append(np.full(one.rays, b))
        above.append(first + np.stack([wall + one.rays, wall + 2 * one.rays], axis=1))
        levels = one.height[:: one.rays]
        heights.append(np.tile(levels[1:3], (one.rays, 1)))
        arms.append(one.cloud.positions[: one.rays])
        second.append(levels[2])
        images.append(np.arange(image, image + len(one.cloud.owner)))
        first, image = first + nodes, image + len(one.cloud.owner)
    all_images = np.concatenate(images)
    sides = [(0, -1), (0, 1), (2, 1)]
    return Layout(
        home=neighbours[:count].copy(),
        height=height,
        volumes=volumes,
        carried=np.concatenate(carried),
        carrier=np.concatenate(carrier),
        offsets=np.concatenate(offsets),
        images=all_images,
        imaged=cloud.owner[all_images - count].astype(np.int64),
        walls=np.concatenate(walls),
        body=np.concatenate(body),
        above=np.concatenate(above),
        heights=np.concatenate(heights),
        arms=np.concatenate(arms),
        second=np.array(second),
        box=box,
        open_sides=sides if params.axisymmetric else [*sides, (2, -1)],
        gamma=gamma,
    )
