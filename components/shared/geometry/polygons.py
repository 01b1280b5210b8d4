"""Polygons in the plane of x and z: moments, what is inside and how deep, which are convex.

Arrays of corners are (k, 2) m and go round from x to z.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from quintet.interfaces.component import Array

STRAIGHT = 1e-9  # sine of the turn at a corner that counts as none


class Area(NamedTuple):
    """Moments of a polygon's area."""

    area: float  # m2
    centre: Array  # (2,) m
    moment: float  # m4, ∫ r² dA about the centre


def area_moments(corner: Array) -> Area:
    """Area, its centre and its polar moment about that, by the triangles at the first corner."""
    a, b = corner[1:-1] - corner[0], corner[2:] - corner[0]
    parts = 0.5 * (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])  # m2
    area = float(parts.sum())
    centre = parts @ (a + b) / (3.0 * area)
    squares = ((a * a).sum(axis=1) + (a * b).sum(axis=1) + (b * b).sum(axis=1)) / 6.0
    moment = float(parts @ squares) - area * float(centre @ centre)
    return Area(area, corner[0] + centre, moment)


def area(corner: Array) -> float:
    """Area [m2] of a polygon that goes round from x to z; below 0 the other way."""
    x, z = corner.T
    return 0.5 * float((x * np.roll(z, -1) - np.roll(x, -1) * z).sum())


def half_planes(corner: Array) -> tuple[Array, Array]:
    """Outward normals (k, 2) and levels (k,) m of edges; a convex polygon is where n·x < level."""
    along = edges(corner)
    away = np.stack([along[:, 1], -along[:, 0]], axis=1)
    away = away / np.linalg.norm(away, axis=1, keepdims=True)
    return away, (away * corner).sum(axis=1)


def meeting_points(away: Array, level: Array) -> Array:
    """Corners (k, 2) m at which each line n·x = level meets the one before it."""
    pairs = zip(np.roll(away, 1, axis=0), away, np.roll(level, 1), level, strict=True)
    return np.array([np.linalg.solve([n, m], [a, b]) for n, m, a, b in pairs])


def in_order(corners: Sequence[tuple[float, float]]) -> Array:
    """Corners of a polygon that may go round either way, from x to z."""
    outline = np.array(corners)
    return outline[::-1].copy() if area(outline) < 0.0 else outline


def in_space(plane: Array) -> Array:
    """Points (n, 3) m of points (n, 2) m in the plane of x and z."""
    return np.insert(plane, 1, 0.0, axis=1)


def edges(corner: Array) -> Array:
    """Vectors (k, 2) m from each corner to the next."""
    return np.asarray(np.roll(corner, -1, axis=0) - corner)


def turns(corner: Array) -> Array:
    """Sine of the turn (k,) at each corner times both edges' lengths [m2]; positive: x to z."""
    along = edges(corner)
    before = np.roll(along, 1, axis=0)
    return np.asarray(before[:, 0] * along[:, 1] - before[:, 1] * along[:, 0])


def require_outline(where: str, corners: Sequence[tuple[float, float]]) -> None:
    """Refuse corners that do not go once round a polygon, either way, or are straight."""
    if len(corners) < 3 or not (np.abs(_sines(np.array(corners))) > STRAIGHT).all():
        raise ValueError(
            f"{where} must go once round a polygon, x and z of three corners or more, none of them "
            f"straight; found {corners}. Put them in order, or leave some out."
        )
    require_simple(where, corners)


def _sines(corner: Array) -> Array:
    """Sine of the turn (k,) at each corner; 0 at corners that do not differ from the next."""
    length = np.linalg.norm(edges(corner), axis=1)
    both = length * np.roll(length, 1)
    return np.asarray(turns(corner) / np.where(both > 0.0, both, np.inf))


def is_convex(corner: Array) -> bool:
    """Whether corners (k, 2) m go once round a convex polygon, either way."""
    along, sine = edges(corner), _sines(corner)
    if sine.sum() < 0.0:
        sine = -sine
    # Round once: of a star each corner is right, but its turns add up to more.
    angle = np.arcsin(np.clip(sine, 0.0, 1.0))
    back = (along * np.roll(along, 1, axis=0)).sum(axis=1) < 0.0
    whole = np.where(back, np.pi - angle, angle).sum()
    return bool((sine > STRAIGHT).all() and abs(whole - 2.0 * np.pi) < 1e-6)


def require_simple(where: str, corners: Sequence[tuple[float, float]]) -> None:
    """Refuse corners (k, 2) m of a polygon whose edges meet elsewhere than at corners."""
    start = np.array(corners)
    along = np.roll(start, -1, axis=0) - start
    count = len(start)
    if not (np.linalg.norm(along, axis=1) > 0.0).all():
        raise ValueError(
            f"{where}: each corner must differ from the next; found two that are equal. Remove one."
        )
    first, second = np.triu_indices(count, 2)
    keep = ~((first == 0) & (second == count - 1))  # neighbours
    first, second = first[keep], second[keep]
    across = _cross(along[first], along[second])
    between = start[second] - start[first]
    safe = np.where(across == 0.0, 1.0, across)
    t, u = _cross(between, along[second]) / safe, _cross(between, along[first]) / safe
    met = (across != 0.0) & (t >= 0.0) & (t <= 1.0) & (u >= 0.0) & (u <= 1.0)
    if met.any():
        k = int(np.argmax(met))
        raise ValueError(
            f"{where}: corners must go once round a polygon that does not cross itself; "
            f"the edges after corners {first[k]} and {second[k]} meet. Put them in order."
        )


def _cross(a: Array, b: Array) -> Array:
    return np.asarray(a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0])


def inside_polygon(first: Array, second: Array, corners: Array) -> NDArray[np.bool_]:
    """Whether places (n,), (n,) m are inside a polygon (k, 2) m: by the edges that a ray meets."""
    inside = np.zeros(np.broadcast(first, second).shape, bool)
    for (a, b), (c, d) in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        passes = (b > second) != (d > second)
        if b != d:
            inside ^= passes & (first < a + (second - b) * (c - a) / (d - b))
    return inside


def polygon_depths(corner: Array, points: Array) -> tuple[Array, Array]:
    """How deep (n,) m points (n, 2) m lie in a polygon, negative outside, and normals (n, 2).

    Normals point outwards along the way to the nearest place of an edge.
    """
    along, from_corner = edges(corner), points[:, None] - corner
    share = np.clip((from_corner * along).sum(axis=2) / (along * along).sum(axis=1), 0.0, 1.0)
    away = from_corner - share[:, :, None] * along
    distance = np.linalg.norm(away, axis=2)
    nearest = distance.argmin(axis=1)
    rows = np.arange(len(points))
    far, out = distance[rows, nearest], away[rows, nearest]
    inward = np.where(inside_polygon(points[:, 0], points[:, 1], corner), 1.0, -1.0)
    return inward * far, out * (-inward / np.maximum(far, 1e-300))[:, None]
