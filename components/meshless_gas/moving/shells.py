"""The cloud of a body in space: shells of nodes over a geodesic grid."""

import numpy as np

from quintet.components.meshless_gas.clouds.cap import adjacent, geodesic, shares
from quintet.components.meshless_gas.clouds.cloud import INNER, SLIP
from quintet.components.meshless_gas.clouds.layers import Bounds, SurfaceGrid, layered
from quintet.components.meshless_gas.moving.params import Body
from quintet.components.meshless_gas.moving.rings import Ring


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
    points, triangles = geodesic(body.frequency)
    near, is_edge = adjacent(triangles, len(points))
    count, heights = len(points), np.array(body.heights)
    radii = body.radius + heights
    none = np.zeros(count, np.int32)
    bounds = Bounds(
        first=none + 1,
        last=none,
        edge=none,
        kinds=np.array([INNER, SLIP], np.int8),
        normals=points,
        areas=shares(points, triangles) * radii[:, None] ** 2,
        beyond=-points,
        weight=body.weight,
    )
    inward = np.arange(count, dtype=np.int32)
    grid = SurfaceGrid(near, none[:0], np.zeros((0, 3, 3)), is_edge, inward)
    made = layered(radii[:, None, None] * points, grid, bounds, is_cross)
    wall = made.cloud.kind == SLIP
    cloud = made.cloud._replace(
        normals=np.where(wall[:, None], made.cloud.normals, 0.0),
        areas=np.where(wall[:, None], made.cloud.areas, 0.0),
        region=np.full(len(wall), region, np.int32),
        patch=np.where(wall, patch, 0).astype(np.int32),
    )
    return Ring(cloud, made.neighbours, np.repeat(heights, count), count)
