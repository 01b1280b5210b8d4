"""Bodies of two dimensions: discs and convex polygons in the plane of x and z, 1 m deep along y.

Arrays of corners are (k, 2) m, x and z, and go round from x to z.
"""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from quintet.components.dem_bodies.shapes.rigid_body import RigidBody
from quintet.components.shared.geometry.polygons import (
    area_moments,
    edges,
    in_order,
)
from quintet.interfaces.component import Array

if TYPE_CHECKING:
    from quintet.components.dem_bodies.params import DemBodiesParams

SHAPES = ("disc", "polygon")


def corners(body: RigidBody) -> Array:
    """Corners (k, 2) m of a polygon about its centre of mass."""
    assert body.corners is not None
    found = in_order(body.corners)
    return np.asarray(found - area_moments(found).centre)


def inner_corners(corner: Array, radius: float) -> Array:
    """Corners (k, 2) m of the polygon at which a circle of a radius [m] is swept round."""
    along = edges(corner)
    length = np.linalg.norm(along, axis=1)
    away = np.stack([along[:, 1], -along[:, 0]], axis=1) / length[:, None]
    level = (away * corner).sum(axis=1) - radius
    pairs = zip(np.roll(away, 1, axis=0), away, np.roll(level, 1), level, strict=True)
    return np.array([np.linalg.solve([n, m], [a, b]) for n, m, a, b in pairs])


def shortest_edge(body: RigidBody) -> float:
    """Length [m] of a polygon's shortest edge."""
    return float(np.linalg.norm(edges(np.array(body.corners)), axis=1).min())


def triangles(count: int) -> Array:
    """Corners (count - 2, 3) of the triangles that fill a convex polygon."""
    last = np.arange(2, count)
    return np.stack([np.zeros_like(last), last - 1, last], axis=1)


def polygon_distance(corner: Array, points: Array) -> Array:
    """Signed distances (n,) m of points (n, 2) m from a convex polygon."""
    along, from_corner = edges(corner), points[:, None] - corner
    length2 = (along * along).sum(axis=1)
    share = np.clip((from_corner * along).sum(axis=2) / length2, 0.0, 1.0)
    far = np.linalg.norm(from_corner - share[:, :, None] * along, axis=2).min(axis=1)
    outside = from_corner[:, :, 0] * along[:, 1] - from_corner[:, :, 1] * along[:, 0]
    return np.where((outside > 0.0).any(axis=1), far, -far)


def polygon_gap(a: Array, b: Array) -> float:
    """Distance [m] of two convex polygons; negative: the least way that parts them."""
    separation = max(_separation(a, b), _separation(b, a))
    if separation < 0.0:
        return separation
    return float(min(polygon_distance(a, b).min(), polygon_distance(b, a).min()))


def _separation(a: Array, b: Array) -> float:
    """How far [m] b is beyond that edge of a which it is furthest beyond."""
    along = edges(a)
    away = np.stack([along[:, 1], -along[:, 0]], axis=1)
    away = away / np.linalg.norm(away, axis=1, keepdims=True)
    return float((b @ away.T - (away * a).sum(axis=1)).min(axis=0).max())


def leaves_edges(body: RigidBody, radius: float) -> bool:
    """Whether circles of a radius [m] in a polygon's corners leave something of each edge."""
    corner = corners(body)
    return bool(((edges(inner_corners(corner, radius)) * edges(corner)).sum(axis=1) > 0.0).all())


def check_plane(params: "DemBodiesParams") -> None:
    """Refuse shapes of other dimensions, and motion that would leave the plane."""
    planar = params.dimensions == 2
    templates = params.placed.templates
    each = list(zip(params.placed.first, templates, strict=False))
    for k, body in each:
        if (body.shape in SHAPES) != planar:
            rule = f"{' or '.join(SHAPES)}" if planar else "a shape of three dimensions"
            raise ValueError(
                f"bodies[{k}].shape must be {rule} where dimensions is {params.dimensions}; found "
                f"{body.shape}. Choose another, or set dimensions to {3 if planar else 2}."
            )
    if not planar:
        return
    _require_plane("gravity", params.gravity, (1,))
    for k, plane in enumerate(params.planes):
        _require_plane(f"planes[{k}].normal", plane.normal, (1,))
    first = templates[0].position[1]
    for k, body in each:
        where, y = f"bodies[{k}]", body.position[1]
        if body.copies is not None and body.copies.number[1] > 1:
            where, y = f"bodies[{k + body.copies.number[2]}]", y + body.copies.spacing[1]
        if y != first:
            raise ValueError(
                f"{where} must have the y of all others, {first:g} m, in two dimensions; "
                f"found {y:g} m. Correct it."
            )
        _require_plane(f"{where}.velocity", body.velocity, (1,))
        _require_plane(f"{where}.angular_velocity", body.angular_velocity, (0, 2))
        _require_plane(f"{where}.orientation (w, x, y, z)", body.orientation, (1, 3))


def _require_plane(where: str, found: Sequence[float], none: tuple[int, ...]) -> None:
    if any(found[axis] != 0.0 for axis in none):
        raise ValueError(
            f"{where} must stay in the plane of x and z, in two dimensions; found {tuple(found)}. "
            "Set what leaves it to 0."
        )
