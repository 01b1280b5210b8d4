"""Nodes over a cap of a sphere in three dimensions: layers over a geodesic grid."""

import math

import numpy as np
from numpy.typing import NDArray

from quintet.components.meshless_gas.clouds.cloud import Whole
from quintet.components.meshless_gas.clouds.grading import geometric
from quintet.components.meshless_gas.clouds.layers import (
    Bounds,
    LayeredCloud,
    Sides,
    SurfaceGrid,
    heights,
    kinds_of,
    layered,
)
from quintet.components.meshless_gas.clouds.meridian import (
    Reach,
    SphereInStream,
    last_patch,
    outer_radius,
)
from quintet.interfaces.component import Array

ARC = math.acos(1.0 / math.sqrt(5.0))  # rad, of an icosahedron's edge
GOLDEN = 0.5 * (1.0 + math.sqrt(5.0))
TURN = (0.31, 0.73, 1.17)  # rad: no node of the grid lies on the axis or in a plane of symmetry


def sphere_cap(sphere: SphereInStream, reach: Reach, sides: Sides) -> LayeredCloud:
    """Nodes round the part of a sphere that meets a flow along x.

    Parameters
    ----------
    sphere : SphereInStream
    reach : Reach
        Rays are counted over half a turn: nodes are as far apart as those of a meridian.
    sides : Sides
        The "wall", "far" and, where gas leaves, the "exit".

    Returns
    -------
    LayeredCloud
    """
    centre, radius, mach = sphere
    points, triangles = geodesic(max(1, round(reach.rays * ARC / math.pi)))
    angle = np.arccos(np.clip(-points[:, 0], -1.0, 1.0))
    whole = _without_ears(triangles[(angle <= reach.sector)[triangles].all(axis=1)])
    used = np.zeros(len(points), bool)
    used[whole] = True
    number = np.where(used, np.cumsum(used) - 1, -1)
    share = shares(points, triangles, whole)[used]
    near, is_edge = adjacent(number[triangles[used[triangles].any(axis=1)]], int(used.sum()))
    inside = number[whole]
    points, angle = points[used], angle[used]
    outer = outer_radius(angle, radius, mach, reach)
    distance = geometric(reach.first, outer - radius, reach.layers)
    places = centre + points * (radius + distance)[:, :, None]
    bounds = Bounds(
        np.full(len(points), sides.patches["wall"], np.int32),
        last_patch(angle, outer, reach, sides.patches),
        np.where(is_edge, sides.patches["exit"], 0).astype(np.int32),
        kinds_of(sides),
        points,
        share * (radius + distance) ** 2,
        _towards(places[-1], inside),
        rim(places, inside),
        reach.weight,
    )
    none = np.zeros(0, np.int32)
    surface = SurfaceGrid(near, none, np.zeros((0, 3, 3)), is_edge)
    return layered(places, surface, bounds, reach.is_cross)


def geodesic(frequency: int) -> tuple[Array, NDArray[np.int64]]:
    """Points (m, 3) of the unit sphere, and triangles (f, 3): an icosahedron's, divided."""
    corners, sides = _icosahedron()
    share = [
        (i, j, frequency - i - j) for i in range(frequency + 1) for j in range(frequency + 1 - i)
    ]
    number = {(i, j): k for k, (i, j, _) in enumerate(share)}
    upward = [(number[i, j], number[i + 1, j], number[i, j + 1]) for i, j, k in share if k > 0]
    downward = [
        (number[i, j], number[i - 1, j], number[i, j - 1]) for i, j, _ in share if i > 0 and j > 0
    ]
    places = np.einsum("sk,fkx->fsx", np.array(share, float) / frequency, corners[sides])
    points = places.reshape(-1, 3)
    points /= np.sqrt((points**2).sum(axis=1))[:, None]
    _, first, same = np.unique(np.round(points, 9), axis=0, return_index=True, return_inverse=True)
    parts = np.array(upward + downward) + len(share) * np.arange(len(sides))[:, None, None]
    return points[first] @ _rotation().T, same.ravel()[parts.reshape(-1, 3)]


def _icosahedron() -> tuple[Array, NDArray[np.int64]]:
    flat = [(0.0, s, t * GOLDEN) for s in (-1.0, 1.0) for t in (-1.0, 1.0)]
    corners = np.array([np.roll(face, k) for face in flat for k in range(3)])
    corners /= np.sqrt((corners**2).sum(axis=1))[:, None]
    near = ((corners[:, None] - corners) ** 2).sum(axis=2) < 1.2  # edges are 1.05 long
    sides = [
        (a, b, c)
        for a in range(12)
        for b in range(a)
        for c in range(b)
        if near[a, b] and near[b, c] and near[a, c]
    ]
    return corners, np.array(sides)


def _rotation() -> Array:
    matrix = np.eye(3)
    for axis, turn in enumerate(TURN):
        i, j = (axis + 1) % 3, (axis + 2) % 3
        unit = np.eye(3)
        unit[i, i] = unit[j, j] = math.cos(turn)
        unit[i, j], unit[j, i] = -math.sin(turn), math.sin(turn)
        matrix = unit @ matrix
    return matrix


def shares(points: Array, every: NDArray[np.int64], faces: NDArray[np.int64]) -> Array:
    """Share (m,) of the unit sphere of each point: a third of those of its triangles in `faces`."""
    areas = np.zeros(len(points))
    for k in range(3):
        np.add.at(areas, faces[:, k], _flat(points, faces) / 3.0)
    return areas * (4.0 * math.pi / _flat(points, every).sum())


def _flat(points: Array, faces: NDArray[np.int64]) -> Array:
    a, b, c = (points[faces[:, k]] for k in range(3))
    return np.asarray(0.5 * np.sqrt((np.cross(b - a, c - a) ** 2).sum(axis=1)))


def _towards(places: Array, triangles: NDArray[np.int64]) -> Array:
    """Areas (m, 3) m2 towards the sphere: a third of the triangles round each point."""
    a, b, c = (places[triangles[:, k]] for k in range(3))
    area = 0.5 * np.cross(b - a, c - a)
    area *= -np.sign((area * a).sum(axis=1))[:, None]
    sides = np.zeros(places.shape)
    for k in range(3):
        np.add.at(sides, triangles[:, k], area / 3.0)
    return sides


def adjacent(faces: NDArray[np.int64], count: int) -> tuple[Whole, NDArray[np.bool_]]:
    """Neighbours (m, a) by triangles, padded with -1, and which points lie beside none."""
    pairs = np.vstack([faces[:, [k, (k + 1) % 3]] for k in range(3)])
    pairs = np.vstack([pairs, pairs[:, ::-1]])
    is_edge = np.zeros(count, bool)
    is_edge[pairs[(pairs[:, 1] < 0) & (pairs[:, 0] >= 0), 0]] = True
    pairs = np.unique(pairs[(pairs >= 0).all(axis=1)], axis=0)
    order = np.zeros(count + 1, np.int64)
    np.cumsum(np.bincount(pairs[:, 0], minlength=count), out=order[1:])
    column = np.arange(len(pairs)) - order[pairs[:, 0]]
    near = np.full((count, int(column.max()) + 1), -1, np.int32)
    near[pairs[:, 0], column] = pairs[:, 1]
    return near, is_edge


def _sides(faces: NDArray[np.int64]) -> NDArray[np.int64]:
    """Sides (s, 3) of one triangle alone, and its third corner."""
    sides = np.vstack([np.roll(faces, -k, axis=1) for k in range(3)])
    _, first, often = np.unique(
        np.sort(sides[:, :2], axis=1), axis=0, return_index=True, return_counts=True
    )
    return np.asarray(sides[first[often == 1]])


def _without_ears(faces: NDArray[np.int64]) -> NDArray[np.int64]:
    """Triangles but for those whose three corners lie at the edge: none of them is within."""
    while True:
        at_edge = np.isin(faces, _sides(faces)[:, :2]).all(axis=1)
        if not at_edge.any():
            return faces
        faces = faces[~at_edge]


def rim(places: Array, faces: NDArray[np.int64]) -> Array:
    """Areas (layers, m, 3) m2 into the gas over the grid's edge: half of a side to each end."""
    a, b, c = _sides(faces).T
    ray = places[-1] - places[0]
    up = heights(places)[:, :, None] * ray / np.sqrt((ray**2).sum(axis=1))[:, None]
    sides = np.zeros(places.shape).transpose(1, 0, 2)
    for end in (a, b):
        area = 0.5 * np.cross(places[:, b] - places[:, a], up[:, end])
        area *= np.sign((area * (places[:, c] - places[:, a])).sum(axis=2))[:, :, None]
        np.add.at(sides, end, area.transpose(1, 0, 2))
    return sides.transpose(1, 0, 2)
