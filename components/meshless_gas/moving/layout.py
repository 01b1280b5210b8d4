"""How the clouds of bodies are put together with their background."""

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from quintet.components.meshless_gas.clouds.cloud import Cloud, Whole, joined
from quintet.components.meshless_gas.moving.rings import Ring, ring
from quintet.components.meshless_gas.moving.shells import shell
from quintet.components.meshless_gas.moving_bodies import Moving
from quintet.interfaces.component import Array

Rows = NDArray[np.int64]


class Pose(NamedTuple):
    """Where bodies are and how they move."""

    centre: Array  # (b, 3) m
    velocity: Array  # (b, 3) m/s
    spin: Array  # (b, 3) rad/s


class CloudLayout(NamedTuple):
    """What of the clouds of bodies never changes; n nodes, w of them of walls."""

    home: Whole  # (n, K) neighbours of each node in its own cloud
    height: Array  # (n,) m, above the own body; ∞ of the background
    volumes: Array  # (n,) m3, of each cloud alone
    areas: Array  # (n, 3) m2, of boundary nodes, if no cloud reaches them
    carried: Rows  # (c,) nodes of bodies' clouds
    carrier: Rows  # (c,) whose they are
    offsets: Array  # (c, 3) m, from the body's centre
    images: Rows  # (g,) images of carried nodes beyond the axis
    imaged: Rows  # (g,) and what they are images of
    walls: Rows  # (w,)
    body: Rows  # (w,)
    above: Rows  # (w, 2) the two nodes above each
    heights: Array  # (w, 2) m, of these
    leaving: Rows  # (o,) nodes of bodies' clouds where gas leaves downstream
    before: Rows  # (o,) and those beside them, whose states they have
    plane: Rows  # (l,) nodes of bodies and background where a cloud ends with its box
    arms: Array  # (w, 3) m, of walls from the centre
    radii: Array  # (b,) m, of bodies
    thickness: Array  # (b,) m, of their clouds
    spacing: Array  # (b,) m, of nodes at the rims of clouds
    second: Array  # (b,) m, least height of the second layer of each body
    is_cut: NDArray[np.bool_]  # (b,) whether the cloud ends where the box does
    box: Array  # (2, 3) m, corners of the background
    open_sides: list[tuple[int, int]]  # axis and side of faces that clouds must not reach
    fringe_count: int  # neighbours of a node across overlaps
    planar: bool  # whether nothing leaves the plane of x and z

    def heights_of(self, places: Array, centre: Array) -> Array:
        """Heights (b, m) m of places above bodies with these centres."""
        apart = places[None] - centre[:, None]
        return np.asarray(np.sqrt((apart**2).sum(axis=2)) - self.radii[:, None])


def with_bodies(
    background: Cloud, params: Moving, patch: int, planar: bool
) -> tuple[Cloud, list[Ring]]:
    """Join the clouds of bodies, at their first positions, to a background."""
    rings = [
        ring(body, 1 + b, patch, params.axisymmetric)
        if planar
        else shell(body, 1 + b, patch, params.line_stencils)
        for b, body in enumerate(params.bodies)
    ]
    moved = [
        body_cloud.cloud._replace(positions=body_cloud.cloud.positions + np.array(body.centre))
        for body_cloud, body in zip(rings, params.bodies, strict=True)
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
    fringe_count: int,
    planar: bool,
) -> CloudLayout:
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
    fringe_count : int
        Neighbours of a node across overlaps.
    planar : bool
    """
    count = cloud.nodes
    sizes = [body_cloud.cloud.nodes for body_cloud in rings]
    imaged = [len(body_cloud.cloud.owner) for body_cloud in rings]
    first = background + np.cumsum([0, *sizes[:-1]])  # rows of each body's cloud begin here
    beyond = count + len(cloud.owner) - sum(imaged) + np.cumsum([0, *imaged[:-1]])  # its images
    _write_home(rings, first, beyond, neighbours)
    images = np.concatenate(
        [row + np.arange(size) for row, size in zip(beyond, imaged, strict=True)]
    )
    leaving = _rows_of([body_cloud.leaving for body_cloud in rings], first)
    return CloudLayout(
        home=neighbours[:count].copy(),
        height=np.concatenate(
            [np.full(background, np.inf), *(body_cloud.height for body_cloud in rings)]
        ),
        volumes=cloud.volumes[:count].copy(),
        areas=cloud.areas[:count].copy(),
        carried=np.arange(background, background + sum(sizes)),
        carrier=np.repeat(np.arange(len(rings)), sizes),
        offsets=np.concatenate(
            [body_cloud.cloud.positions[: body_cloud.cloud.nodes] for body_cloud in rings]
        ),
        images=images,
        imaged=cloud.owner[images - count].astype(np.int64),
        leaving=leaving,
        before=_rows_of([body_cloud.before for body_cloud in rings], first),
        plane=_plane(cloud, background, leaving),
        **_walls(rings, first),
        **_bodies(params, rings),
        box=box,
        open_sides=_open_sides(params.axisymmetric, planar),
        fringe_count=fringe_count,
        planar=planar,
    )


def _write_home(rings: list[Ring], first: Rows, beyond: Rows, neighbours: Whole) -> None:
    """Write the neighbours of bodies' nodes in their own cloud, whose images lie beyond."""
    for body_cloud, row, image in zip(rings, first, beyond, strict=True):
        place = np.arange(row, row + body_cloud.cloud.nodes)
        home = body_cloud.home
        home = np.where(home < len(place), home + row, home - len(place) + image)
        neighbours[place] = place[:, None]
        neighbours[place, : home.shape[1]] = home


def _rows_of(nodes: list[Rows], first: Rows) -> Rows:
    """Rows of nodes of each body's cloud, which begins at a first row."""
    return np.concatenate([rows + row for rows, row in zip(nodes, first, strict=True)])


def _walls(rings: list[Ring], first: Rows) -> dict[str, Any]:
    """Fields of the layout about nodes of walls."""
    rays = [body_cloud.rays for body_cloud in rings]
    walls = _rows_of([np.arange(many) for many in rays], first)
    many = np.repeat(rays, rays)
    levels = [body_cloud.height.reshape(-1, body_cloud.rays) for body_cloud in rings]
    return {
        "walls": walls,
        "body": np.repeat(np.arange(len(rings)), rays),
        "above": np.stack([walls + many, walls + 2 * many], axis=1),
        "heights": np.concatenate([level[1:3].T for level in levels]),
        "arms": np.concatenate(
            [body_cloud.cloud.positions[: body_cloud.rays] for body_cloud in rings]
        ),
    }


def _bodies(params: Moving, rings: list[Ring]) -> dict[str, Any]:
    """Fields of the layout about bodies."""
    levels = [body_cloud.height.reshape(-1, body_cloud.rays) for body_cloud in rings]
    return {
        "radii": np.array([body.radius for body in params.bodies]),
        "thickness": np.array([body.heights[-1] for body in params.bodies]),
        "spacing": np.array([body.spacing for body in params.bodies]),
        "second": np.array([level[2].min() for level in levels]),
        "is_cut": np.array([body.is_cut for body in params.bodies]),
    }


def _open_sides(axisymmetric: bool, planar: bool) -> list[tuple[int, int]]:
    """Axis and side of faces that clouds must not reach."""
    sides = [(0, -1), (0, 1), (2, 1)]
    if not axisymmetric:
        sides.append((2, -1))
    return sides if planar else [*sides, (1, -1), (1, 1)]


def _plane(cloud: Cloud, background: int, leaving: Rows) -> Rows:
    """Nodes in the plane across x where gas leaves bodies' clouds."""
    if not len(leaving):
        return leaving
    end = cloud.positions[:background, 0].max()
    beside = np.flatnonzero(cloud.positions[:background, 0] == end)
    return np.concatenate([beside, leaving])


def write_plane_areas(plane: Rows, positions: Array, wall: float, areas: Array) -> None:
    """Share a plane across the axis among the circles of nodes in it, each up to half way.

    Parameters
    ----------
    plane : (l,)
        Nodes that are not left out.
    positions : (n, 3) m
    wall : float, m
        Radius at which the plane begins; it ends at its last node.
    areas : (n, 3) m2
        Written along -x.
    """
    rows = plane[np.argsort(positions[plane, 2])]
    radius = positions[rows, 2]
    edges = np.concatenate([[wall], 0.5 * (radius[1:] + radius[:-1]), radius[-1:]])
    areas[rows, 0] = -math.pi * np.diff(edges**2)
