"""What a picture shows of bodies: corners and faces, centres and radii of spheres; planes."""

from collections.abc import Sequence
from functools import lru_cache

import numpy as np

from quintet.components.dem_bodies.shapes import planar
from quintet.components.dem_bodies.shapes.copies import Bodies
from quintet.components.dem_bodies.shapes.rigid_body import RigidBody
from quintet.components.dem_bodies.shapes.solid import Solid
from quintet.components.dem_bodies.state import Numbers, State
from quintet.components.shared.geometry import body_view
from quintet.components.shared.geometry.shapes import read_solid
from quintet.interfaces.component import Array, Fields
from quintet.interfaces.faces import polygons

REACH = 1.0  # sizes of what holds bodies and planes, by which planes are shown beyond it
ON = 1e-9  # of that size: what lies on a plane is not beyond it


def view(bodies: Bodies, solids: Sequence[Solid], state: State) -> Fields:
    """Corners and faces of boxes, polygons and meshes, centres and radii of spheres; velocities."""
    row = state.row[:-1]
    of_kinds = [_outline(body, solid) for body, solid in zip(bodies.kinds, solids, strict=True)]
    outlines = [of_kinds[kind] for kind in bodies.kind_of_each().tolist()]
    motion = state.velocity[row], state.angular_velocity[row]
    axes = state.axes[row].reshape(-1, 3, 3)
    return body_view.bodies_view(outlines, state.position[row], axes, *motion)


def _outline(body: RigidBody, solid: Solid) -> body_view.Outline:
    if body.size is not None:
        return body_view.box(body.size)
    if body.corners is not None:
        return body_view.polygon(planar.corners(body))
    if body.file is not None:
        return mesh(body.file, body.scale or 1.0)
    return body_view.Outline(solid.centres, solid.radii)


@lru_cache(maxsize=16)
def mesh(file: str, scale: float) -> body_view.Outline:
    """Vertices about the centre of mass, and triangles, of a body from a file."""
    shape = read_solid(file, scale)
    corners, cells = np.unique(shape.triangles.reshape(-1, 3), axis=0, return_inverse=True)
    points = corners - shape.centre
    return body_view.Outline(points, np.zeros(len(points)), cells.reshape(-1, 3))


def extent(state: State) -> tuple[Array, Array]:
    """Lower and upper corners (3,) of the box around the bodies [m]."""
    where, radius = state.position[:-1], state.motion[:-1, 3, None]
    return (where - radius).min(axis=0), (where + radius).max(axis=0)


def planes_view(planes: Numbers, bodies: Sequence[tuple[Array, Array]]) -> Fields:
    """Polygons on planes (p, 4): the part of each before the others, and near boxes of bodies."""
    normals = planes[:, :3]
    points = normals * planes[:, 3:]
    low, high, size = _near_bodies(points, normals, bodies)
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


def _near_bodies(
    points: Array, normals: Array, bodies: Sequence[tuple[Array, Array]]
) -> tuple[Array, Array, float]:
    """Corners (3,) m of a box around bodies and their feet on planes; its size without rim [m]."""
    low = np.min([low for low, _ in bodies], axis=0)
    high = np.max([high for _, high in bodies], axis=0)
    centre = 0.5 * (low + high)
    feet = centre - normals * ((centre - points) * normals).sum(axis=1, keepdims=True)
    low, high = np.vstack([feet, low]).min(axis=0), np.vstack([feet, high]).max(axis=0)
    size = float((high - low).max())
    return low - REACH * size, high + REACH * size, size


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
