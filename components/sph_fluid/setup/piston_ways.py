"""Where pistons of any shape go: their surfaces over the whole motion, and what is in their way.

Motions are cut into places between which no corner moves further than half a spacing. At each of
them triangles of the surface are compared with boxes by their separating axes (Akenine-Möller, J.
Graphics Tools 6 (2001) 29).
"""

import itertools
import math
from collections.abc import Iterator

import numpy as np

from quintet.components.shared.geometry.bounds import Bounds
from quintet.components.shared.geometry.box_faces import CORNERS, FACES
from quintet.components.sph_fluid.setup.boundary import Boundary
from quintet.components.sph_fluid.setup.pistons import Piston
from quintet.interfaces.component import Array

LONGEST_STEP = 0.5  # spacings that a corner may move between two places
MOST_PLACES = 4096  # of one motion


def surface(piston: Piston, boundary: Boundary) -> Array:
    """Triangles (t, 3, 3) m of an obstacle or a mesh, as it stands in the scene."""
    if (mesh := piston.number("meshes")) >= 0:
        # Left out of scenes without boundaries from files.
        from quintet.components.sph_fluid.setup.mesh_surfaces import placed

        return placed(boundary.meshes[mesh]).corner
    low, high = np.array(boundary.solids[piston.number("obstacles")])
    corners = 0.5 * (low + high) + 0.5 * (high - low) * CORNERS
    return np.concatenate([corners[FACES[:, [0, 1, 2]]], corners[FACES[:, [0, 2, 3]]]])


def moved(points: Array, place: Array, axis: Array, point: Array) -> Array:
    """Points (..., 3) m, turned about an axis through a point by place[3], and displaced.

    Parameters
    ----------
    points : (..., 3) float array, m
    place : (4,) float array, m, m, m, rad
    axis : (3,) float array
        Unit vector.
    point : (3,) float array, m
        On the axis.
    """
    angle = float(place[3])
    if angle == 0.0:
        return np.asarray(points + place[:3])
    arm = points - point
    # Written out: what a library makes of a product depends on its threads.
    x, y, z = axis.tolist()
    parallel = (arm[..., 0] * x + arm[..., 1] * y + arm[..., 2] * z)[..., np.newaxis] * axis
    rotated = parallel + math.cos(angle) * (arm - parallel) + math.sin(angle) * np.cross(axis, arm)
    return np.asarray(point + place[:3] + rotated)


def places_of(piston: Piston, triangles: Array, spacing: float) -> Array:
    """Places (n, 4) of a motion in order, so near each other that no corner is missed."""
    course = piston.path.trajectory.course()
    arm = np.linalg.norm(triangles.reshape(-1, 3) - np.array(piston.path.point), axis=1).max()
    change = np.diff(course, axis=0)
    travel = np.linalg.norm(change[:, :3], axis=1) + arm * np.abs(change[:, 3])  # m
    longest = max(LONGEST_STEP * spacing, float(travel.sum()) / MOST_PLACES)
    parts = np.maximum(np.ceil(travel / longest).astype(int), 1)
    places = [
        begin + (np.arange(count) / count)[:, np.newaxis] * step
        for begin, step, count in zip(course[:-1], change, parts, strict=True)
        if step.any()
    ]
    return np.concatenate([*places, course[-1:]])


def surfaces_on_way(piston: Piston, boundary: Boundary, spacing: float) -> Iterator[Array]:
    """Triangles (t, 3, 3) m where the motion has them, from place to place."""
    triangles, point = surface(piston, boundary), np.array(piston.path.point)
    for place in places_of(piston, triangles, spacing):
        yield moved(triangles, place, piston.path.direction, point)


def meets(triangles: Array, box: Bounds, tolerance: float) -> bool:
    """Whether some of the triangles (t, 3, 3) m lie deeper than a tolerance [m] in a box."""
    low, high = np.array(box[0]) + tolerance, np.array(box[1]) - tolerance
    if (low >= high).any():
        return False
    is_near = (triangles.min(axis=1) < high) & (triangles.max(axis=1) > low)
    corner = triangles[is_near.all(axis=1)] - 0.5 * (low + high)
    if not len(corner):
        return False
    half = 0.5 * (high - low)
    edges = np.roll(corner, -1, axis=1) - corner
    normal = np.cross(edges[:, 0], edges[:, 1])
    is_apart = np.abs((normal * corner[:, 0]).sum(axis=1)) >= np.abs(normal) @ half
    for unit, k in itertools.product(np.eye(3), range(3)):
        axis = np.cross(unit, edges[:, k])
        projection = (corner * axis[:, np.newaxis]).sum(axis=2)  # (t, 3)
        reach = np.abs(axis) @ half
        between = (projection.min(axis=1) >= reach) | (projection.max(axis=1) <= -reach)
        is_apart |= between & (reach > 0.0)
    return not bool(is_apart.all())
