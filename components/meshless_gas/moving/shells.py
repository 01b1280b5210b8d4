"""The cloud of a body in space: shells of nodes over a geodesic grid."""

import math

import numpy as np
from numpy.typing import NDArray

from quintet.components.meshless_gas.clouds.cap import (
    ARC,
    adjacent,
    geodesic,
    rim,
    shares,
)
from quintet.components.meshless_gas.clouds.cloud import INNER, OUTFLOW, SLIP
from quintet.components.meshless_gas.clouds.layers import Bounds, SurfaceGrid, layered
from quintet.components.meshless_gas.moving.rings import Ring, heights_over
from quintet.components.meshless_gas.moving_bodies import Body
from quintet.interfaces.component import Array

BEYOND = 0.35  # of an edge of a triangle: how far beyond a sector a point still is moved to its end


def shell(body: Body, region: int, patch: int, is_cross: bool) -> Ring:
    """Make the shells of a body at the origin.

    Parameters
    ----------
    body : Body
    region, patch : int
        Of the cloud, and of the boundary that its wall is.
    is_cross : bool
        Neighbours are those of the own shell and the two straight above and below; else all of the
        three shells, 20 of most nodes.

    Returns
    -------
    Ring
    """
    points, faces = _grid(body)
    count = len(points)
    near, is_edge = adjacent(faces, count)
    if body.is_cut:
        points = _ended(points, is_edge, body.sector)
    heights = heights_over(body, np.arccos(np.clip(-points[:, 0], -1.0, 1.0)))
    radii = body.radius + heights
    whole = faces[(faces >= 0).all(axis=1)]
    share = shares(points, whole, whole) * 0.5 * (1.0 - math.cos(body.sector))
    places = radii[:, :, None] * points
    none = np.zeros(count, np.int32)
    bounds = Bounds(
        first=none + 1,
        last=none,
        edge=np.where(is_edge, 2, 0).astype(np.int32),
        kinds=np.array([INNER, SLIP, OUTFLOW], np.int8),
        normals=points,
        areas=share * radii**2,
        beyond=-points,
        sides=rim(places, whole) if body.is_cut else np.zeros(places.shape),
        weight=body.weight,
    )
    grid = SurfaceGrid(near, none[:0], np.zeros((0, 3, 3)), is_edge)
    shells = layered(places, grid, bounds, is_cross)
    kind = shells.cloud.kind
    # The last shell is no boundary, and the wall's edge no outflow.
    areas = np.where((kind != INNER)[:, None], shells.cloud.areas, 0.0)
    areas[:count] = points * bounds.areas[0][:, None]
    areas[-count:] -= np.where(is_edge[:, None], bounds.beyond, 0.0)
    cloud = shells.cloud._replace(
        normals=np.where((kind != INNER)[:, None], shells.cloud.normals, 0.0),
        areas=areas,
        region=np.full(len(kind), region, np.int32),
        patch=np.where(kind == SLIP, patch, 0).astype(np.int32),
    )
    leaving = np.flatnonzero(kind == OUTFLOW)
    layer, foot = np.divmod(leaving, count)
    before = layer * count + _inward(points, is_edge)[foot]
    return Ring(cloud, shells.neighbours, heights.ravel(), count, leaving, before)


def _grid(body: Body) -> tuple[Array, NDArray[np.int64]]:
    """Points and triangles; of a sector those with a point in it, -1 for those beyond."""
    points, faces = geodesic(body.frequency)
    if not body.is_cut:
        return points, faces
    angle = np.arccos(np.clip(-points[:, 0], -1.0, 1.0))
    inside = angle <= body.sector + BEYOND * ARC / body.frequency
    number = np.where(inside, np.cumsum(inside) - 1, -1)
    return points[inside], number[faces[inside[faces].any(axis=1)]]


def _ended(points: Array, is_edge: NDArray[np.bool_], sector: float) -> Array:
    """Points, those at the edge moved to an angle [rad] from upstream."""
    aside = points[:, 1:] / np.hypot(points[:, 1], points[:, 2])[:, None]
    end = np.column_stack([np.full(len(points), -math.cos(sector)), math.sin(sector) * aside])
    return np.where(is_edge[:, None], end, points)


def _inward(points: Array, is_edge: NDArray[np.bool_]) -> NDArray[np.int64]:
    """Nearest point that is no edge (m,), of those at an edge; itself elsewhere."""
    within = np.flatnonzero(~is_edge)
    inward = np.arange(len(points))
    for point in np.flatnonzero(is_edge):
        inward[point] = within[((points[within] - points[point]) ** 2).sum(axis=1).argmin()]
    return inward
