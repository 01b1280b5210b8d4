"""What a picture shows of bodies: corners and faces, centres and radii of spheres; planes."""

from collections.abc import Sequence
from functools import lru_cache

import numpy as np

from quintet.components.dem_bodies.shapes import planar
from quintet.components.dem_bodies.shapes.rigid_body import Plane, RigidBody
from quintet.components.dem_bodies.shapes.solid import Solid
from quintet.components.dem_bodies.state import State, Whole
from quintet.components.shared.geometry.polygons import in_space
from quintet.interfaces.component import Array, Fields
from quintet.interfaces.faces import CORNERS, FACES, polygons, stacked

REACH = 1.0  # sizes of what holds bodies and planes, by which planes are shown beyond it
ON = 1e-9  # of that size: what lies on a plane is not beyond it


def view(bodies: Sequence[RigidBody], solids: Sequence[Solid], state: State) -> Fields:
    """Corners and faces of boxes, polygons and meshes, centres and radii of spheres; velocities."""
    points: list[Array] = []
    radii: list[Array] = []
    owners: list[int] = []
    faces: list[Array] = []
    for k, (body, solid, a) in enumerate(zip(bodies, solids, state.row, strict=False)):
        corners, radius = solid.centres, solid.radii
        if body.size is not None:
            corners, radius = CORNERS * 0.5 * np.array(body.size), np.zeros(8)
            faces.append(FACES + len(owners))
        elif body.corners is not None:
            corners = in_space(planar.corners(body))
            radius = np.zeros(len(corners))
            faces.append(np.arange(len(corners))[None] + len(owners))
        elif body.file is not None:
            corners, cells = mesh(body.file, body.scale or 1.0)
            radius = np.zeros(len(corners))
            faces.append(cells + len(owners))
        axes = state.axes[a].reshape(3, 3)
        points.append(state.position[a] + corners @ axes.T)
        radii.append(radius)
        owners += [k] * len(corners)
    where, owner = np.vstack(points), np.array(owners)
    row = state.row[owner]
    turning = np.cross(state.angular_velocity[row], where - state.position[row])
    velocity = state.velocity[row] + turning
    shown = {"points": where, "velocity": velocity, "radius": np.concatenate(radii), "body": owner}
    return shown | ({"cells": stacked(faces)} if faces else {})


@lru_cache(maxsize=16)
def mesh(file: str, scale: float) -> tuple[Array, Whole]:
    """Vertices (n, 3) m about the centre of mass, and triangles (t, 3), of a body from a file."""
    # Left out of scenes without meshes.
    from quintet.components.shared.geometry.mesh_files import read

    shape = read(file, scale)
    corners, cells = np.unique(shape.triangles.reshape(-1, 3), axis=0, return_inverse=True)
    return corners - shape.centre, cells.reshape(-1, 3)


def planes_view(planes: Sequence[Plane], state: State) -> Fields:
    """Polygons on the planes: what of each is before the others, and not far from the bodies."""
    where, radius = state.position[:-1], state.motion[:-1, 3]
    low, high = (where - radius[:, None]).min(axis=0), (where + radius[:, None]).max(axis=0)
    points = np.array([plane.point for plane in planes]).reshape(-1, 3)
    normals = np.array([plane.normal for plane in planes]).reshape(-1, 3)
    normals = normals / np.linalg.norm(normals, axis=1, keepdims=True)
    centre = 0.5 * (low + high)
    feet = centre - normals * ((centre - points) * normals).sum(axis=1, keepdims=True)
    low, high = np.vstack([feet, low]).min(axis=0), np.vstack([feet, high]).max(axis=0)
    size = float((high - low).max())
    low, high = low - REACH * size, high + REACH * size
    # The box as six more planes, that look inwards.
    limits = np.concatenate([points, np.tile(low, (3, 1)), np.tile(high, (3, 1))])
    inwards = np.concatenate([normals, np.eye(3), -np.eye(3)])
    centre, reach = 0.5 * (low + high), float(np.linalg.norm(high - low))
    outlines = []
    for k, (point, normal) in enumerate(zip(points, normals, strict=True)):
        middle = centre - normal * (normal @ (centre - point))
        corners = middle + reach * _square(normal)
        for m, (limit, inward) in enumerate(zip(limits, inwards, strict=True)):
            if m != k:
                corners = _before(corners, limit, inward, ON * size)
        if len(corners) >= 3:
            outlines.append(corners)
    return polygons(outlines)


def _square(normal: Array) -> Array:
    """Corners (4, 3) of a square of edge 2 about the origin, across a unit normal."""
    along = np.cross(normal, np.eye(3)[np.abs(normal).argmin()])
    along /= np.linalg.norm(along)
    across = np.cross(normal, along)
    return np.array([-along - across, along - across, along + across, across - along])


def _before(corners: Array, point: Array, inward: Array, allowed: float) -> Array:
    """Corners (k, 3) m of what of a convex polygon is before a plane (Sutherland & Hodgman)."""
    if not len(corners):
        return corners
    heights = (corners - point) @ inward
    cut: list[Array] = []
    ends = zip(np.roll(corners, -1, axis=0), np.roll(heights, -1), strict=True)
    for corner, height, (end, end_height) in zip(corners, heights, ends, strict=True):
        if height >= -allowed:
            cut.append(corner)
        if (height < -allowed) != (end_height < -allowed):
            cut.append(corner + (end - corner) * (height / (height - end_height)))
    return np.array(cut).reshape(-1, 3)
