"""Filling a rigid body of two dimensions with samples: discs and polygons, 1 m deep.

Arrays of points in the plane are (n, 2) m, x and z; what crosses a link is (n, 3), with y 0.
"""

import math
from itertools import pairwise

import numpy as np

from quintet.components.shared.geometry.polygons import (
    area,
    half_planes,
    in_space,
    meeting_points,
    polygon_depths,
)
from quintet.components.shared.geometry.surface_samples_closed import Body
from quintet.components.shared.geometry.surface_samples_solid import box_lattice
from quintet.interfaces.component import Array

NEARLY = 1e-9  # of a body's size: what is less makes no difference
HALVINGS = 60  # of the bracket around the largest circle in a polygon

Samples = tuple[Array, Array, Array]  # arm (n, 3) m, outward normal (n, 3), volume (n,) m3


def fill_disc(diameter: float, spacing: float, depth: float, inset: float | None = None) -> Samples:
    """Sample a disc [m] by rings in its plane, as `fill_polygon` does a polygon."""
    less = 0.0 if inset is None else inset - 0.5 * spacing
    return _disc(0.5 * diameter - less, spacing, depth)


def fill_polygon(
    corner: Array, spacing: float, depth: float, inset: float | None = None
) -> Samples:
    """Sample a convex polygon by a row of points in its plane, to a depth below its surface.

    Parameters
    ----------
    corner : (k, 2) float array, m
        Corners, from x to z.
    spacing, depth : float, m
        Distance of samples; how far below the outermost they reach (deeper ones act on nothing).
    inset : float, m
        How far below the surface the outermost samples lie; half a spacing if not given.

    Returns
    -------
    arm (n, 3) m from the centre, outward normal (n, 3), volume (n,) m3 of 1 m depth
    """
    outline = offset_inward(corner, 0.0 if inset is None else inset - 0.5 * spacing)
    axes = _right_angles(outline)
    if axes is None:
        return _layers(outline, spacing, depth)
    return _rectangle(outline, axes, spacing, depth)


def closed_polygon(corner: Array) -> Body:
    """Any polygon with corners (k, 2) m, from x to z, as a closed body of no extent along y."""

    def depths(points: Array) -> tuple[Array, Array]:
        below, normal = polygon_depths(corner, points[:, [0, 2]])
        return below, in_space(normal)

    low, high = in_space(np.array([corner.min(axis=0), corner.max(axis=0)]))
    return Body(depths, low, high, area(corner))


def polygon_images(corner: Array, arm: Array, normal: Array) -> Array:
    """Images (n, 3) m of samples of a convex polygon, mirrored in its surface."""
    away, level = half_planes(corner)
    below = level - arm[:, [0, 2]] @ away.T  # (n, k) m, under each edge
    nearest = below.min(axis=1)
    # Where two edges are equally near the normal goes out between them, and meets both further off.
    along = normal[:, [0, 2]] @ away.T
    near = below <= (nearest + NEARLY * np.abs(level).max())[:, None]
    steepest = np.where(near, along, -np.inf).max(axis=1)
    return np.asarray(arm + 2.0 * (nearest / steepest)[:, None] * normal)


def offset_inward(corner: Array, distance: float) -> Array:
    """Corners (k, 2) m of the polygon whose edges lie so far further in; (0, 2): nothing is left.

    Outwards, where the distance is negative, each corner stays between its two edges.
    """
    if distance == 0.0:
        return corner
    away, level = half_planes(corner)
    level = level - distance
    if distance < 0.0:
        return meeting_points(away, level)
    for n, a in zip(away, level, strict=True):
        corner = _clip(corner, corner @ n - a)
    edge_length = np.linalg.norm(corner - np.roll(corner, 1, axis=0), axis=1)
    return np.asarray(corner[edge_length > NEARLY * np.abs(level).max()])


def _clip(corner: Array, above: Array) -> Array:
    """Cut off what lies above a line, given how far above it each corner is (k,) m."""
    corners = []
    for k in range(len(corner)):
        a, b = above[k - 1], above[k]
        if (a < 0.0) != (b < 0.0):
            corners.append(corner[k - 1] + a / (a - b) * (corner[k] - corner[k - 1]))
        if b < 0.0:
            corners.append(corner[k])
    return np.array(corners).reshape(-1, 2)


def inradius(corner: Array) -> float:
    """Radius [m] of the largest circle in a convex polygon, by halving."""
    low, high = 0.0, math.sqrt(area(corner))  # a circle's radius is less than √(area)
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if len(offset_inward(corner, middle)) else (low, middle)
    return low


def _right_angles(corner: Array) -> Array | None:
    """Axes (2, 2) along the edges of a rectangle; None for any other polygon."""
    away, _ = half_planes(corner)
    turns = np.einsum("kd,kd->k", away, np.roll(away, -1, axis=0))
    return away[:2] if len(corner) == 4 and np.abs(turns).max() < NEARLY else None


def _rectangle(corner: Array, axes: Array, spacing: float, depth: float) -> Samples:
    """Lattice of a rectangle, whose cells divide its edges."""
    (x, z), centre = np.ptp(corner @ axes.T, axis=0), corner.mean(axis=0)
    points, normal, volume = box_lattice(np.array([x, 1.0, z]), spacing, depth, planar=True)
    return in_space(points[:, [0, 2]] @ axes + centre), in_space(normal[:, [0, 2]] @ axes), volume


def _layers(corner: Array, spacing: float, depth: float) -> Samples:
    """Layers of equal thickness one inside the other, their samples spread along each edge."""
    middle = inradius(corner)
    count = max(1, round(middle / spacing))
    thickness = middle / count
    points, normals, volumes = [], [], []
    for k in range(count):
        below = (k + 0.5) * thickness
        if below >= depth:
            break
        outer, inner = (offset_inward(corner, (k + end) * thickness) for end in (0, 1))
        ring = area(outer) - (area(inner) if len(inner) and k + 1 < count else 0.0)
        places, normal = _along_edges(offset_inward(corner, below), spacing)
        points.append(places)
        normals.append(normal)
        volumes.append(np.full(len(places), ring / len(places)))
    place, normal = np.concatenate(points), np.concatenate(normals)
    return in_space(place), in_space(normal), np.concatenate(volumes)


def _along_edges(corner: Array, spacing: float) -> tuple[Array, Array]:
    """Points (n, 2) m evenly on the edges of a polygon, none at corners, and their normals."""
    away, _ = half_planes(corner)
    points, normals = [], []
    for k, start in enumerate(corner):
        along = corner[(k + 1) % len(corner)] - start
        count = max(1, round(float(np.hypot(*along)) / spacing))
        points.append(start + (np.arange(count)[:, None] + 0.5) / count * along)
        normals.append(np.tile(away[k], (count, 1)))
    return np.concatenate(points), np.concatenate(normals)


def _disc(radius: float, spacing: float, depth: float) -> Samples:
    """Rings one inside the other; each has as many samples as it holds squares of the spacing."""
    edges = [*np.arange(radius, 0.0, -spacing).tolist(), 0.0]
    points, volumes = [], []
    for k, (outer, inner) in enumerate(pairwise(edges)):
        middle, ring = 0.5 * (outer + inner), math.pi * (outer**2 - inner**2)
        if radius - middle >= depth:
            break
        count = max(1, round(ring / spacing**2))
        if count == 1 and inner == 0.0:
            middle = 0.0
        angle = 2.0 * math.pi * (np.arange(count) + 0.5 * (k % 2)) / count
        points.append(middle * np.stack([np.cos(angle), np.sin(angle)], axis=1))
        volumes.append(np.full(count, ring / count))
    place = np.concatenate(points)
    distance = np.linalg.norm(place, axis=1)
    normal = place / np.maximum(distance, 1e-12 * radius)[:, None]
    normal[~normal.any(axis=1)] = (0.0, 1.0)
    return in_space(place), in_space(normal), np.concatenate(volumes)
