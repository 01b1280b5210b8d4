"""Bodies of two dimensions: discs and polygons in the plane of x and z, 1 m deep along y.

Arrays of corners are (k, 2) m, x and z, and go round from x to z.
"""

import numpy as np

from quintet.components.dem_bodies.shapes.rigid_body import RigidBody
from quintet.components.shared.geometry.polygons import (
    area_moments,
    edges,
    half_planes,
    in_order,
    meeting_points,
    polygon_depths,
)
from quintet.interfaces.component import Array

SHAPES = ("disc", "polygon")


def corners(body: RigidBody) -> Array:
    """Corners (k, 2) m of a polygon about its centre of mass."""
    assert body.corners is not None
    outline = in_order(body.corners)
    return np.asarray(outline - area_moments(outline).centre)


def inner_corners(corner: Array, radius: float) -> Array:
    """Corners (k, 2) m of the polygon at which a circle of a radius [m] is swept round."""
    away, level = half_planes(corner)
    return meeting_points(away, level - radius)


def shortest_edge(body: RigidBody) -> float:
    """Length [m] of a polygon's shortest edge."""
    return float(np.linalg.norm(edges(np.array(body.corners)), axis=1).min())


def polygon_distance(corner: Array, points: Array) -> Array:
    """Signed distances (n,) m of points (n, 2) m from a polygon."""
    return -polygon_depths(corner, points)[0]


def polygon_gap(a: Array, b: Array) -> float:
    """Distance [m] of two convex polygons; negative: the least way that parts them."""
    separation = max(_separation(a, b), _separation(b, a))
    if separation < 0.0:
        return separation
    return float(min(polygon_distance(a, b).min(), polygon_distance(b, a).min()))


def _separation(a: Array, b: Array) -> float:
    """How far [m] b is beyond that edge of a which it is furthest beyond."""
    away, level = half_planes(a)
    return float((b @ away.T - level).min(axis=0).max())


def leaves_edges(body: RigidBody, radius: float) -> bool:
    """Whether circles of a radius [m] in a polygon's corners leave something of each edge."""
    corner = corners(body)
    return bool(((edges(inner_corners(corner, radius)) * edges(corner)).sum(axis=1) > 0.0).all())
