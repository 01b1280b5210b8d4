"""How far bodies are from one another and from planes, as they stand at the start."""

import numpy as np

from quintet.components.dem_bodies.shapes import planar
from quintet.components.dem_bodies.shapes.agglomerate import Agglomerate, agglomerate
from quintet.components.dem_bodies.shapes.rigid_body import Plane, RigidBody
from quintet.components.dem_bodies.shapes.sphere_union import measure_union
from quintet.components.shared.geometry.polygons import in_space
from quintet.interfaces.component import Array

ROUNDED = 0.05  # of a box's shortest edge: radius of its edges unless a scene says otherwise
ALLOWED = 1e-6  # overlap over the size of the smaller body: rounding of what touches exactly

Spheres = tuple[Array, Array]  # centres (n, 3) m, radii (n,) m


def edge_radius(body: RigidBody) -> float:
    """Radius of the edges of a box, or of the corners of a polygon [m]."""
    if body.edge_radius is not None:
        return body.edge_radius
    return ROUNDED * (planar.shortest_edge(body) if body.size is None else min(body.size))


def cover(body: RigidBody) -> Agglomerate | None:
    """Read and cover the shape of a body that is a mesh."""
    if body.file is None or body.agglomerate is None:
        return None
    spheres = body.agglomerate
    return agglomerate(body.file, body.scale or 1.0, spheres.dim, spheres.sphere_radius)


def rotation_matrix(orientation: tuple[float, float, float, float]) -> Array:
    """Matrix (3, 3) of a unit quaternion: body -> world."""
    w, x, y, z = np.array(orientation) / np.linalg.norm(orientation)
    skew = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.asarray(np.eye(3) + 2.0 * w * skew + 2.0 * skew @ skew)


def contact_spheres(body: RigidBody) -> Spheres:
    """Contact spheres of a body that is not a box, in body axes about its centre of mass.

    Those of a polygon sit in its corners, in order.
    """
    if body.radius is not None:
        return np.zeros((1, 3)), np.array([body.radius])
    if body.corners is not None:
        radius = edge_radius(body)
        centres = in_space(planar.inner_corners(planar.corners(body), radius))
        return centres, np.full(len(centres), radius)
    if (covered := cover(body)) is not None:
        return covered.centres, np.full(len(covered.centres), covered.radius)
    assert body.centres is not None and body.radii is not None
    centre = measure_union((body.centres, body.radii))[1]
    return np.array(body.centres) - centre, np.array(body.radii)


def world_spheres(body: RigidBody) -> Spheres:
    """Find the same spheres in the world."""
    centres, radii = contact_spheres(body)
    return np.array(body.position) + centres @ rotation_matrix(body.orientation).T, radii


def bounding_radius(body: RigidBody) -> float:
    """Radius [m] about the centre of mass that holds the body."""
    if body.size is not None:
        return 0.5 * float(np.linalg.norm(body.size))
    if body.radius is not None:
        return body.radius
    centres, radii = contact_spheres(body)
    return float((np.linalg.norm(centres, axis=1) + radii).max())


def plane_gap(body: RigidBody, plane: Plane) -> float:
    """Distance [m] of a body's lowest point from a plane."""
    normal = np.array(plane.normal) / np.linalg.norm(plane.normal)
    origin = np.array(plane.point)
    if body.size is not None:
        down = np.abs(normal @ rotation_matrix(body.orientation)) @ (0.5 * np.array(body.size))
        return float(normal @ (np.array(body.position) - origin) - down)
    centres, radii = world_spheres(body)
    return float(((centres - origin) @ normal - radii).min())


def body_gap(a: RigidBody, b: RigidBody) -> float:
    """Gap [m] between two bodies, negative where they overlap."""
    if a.size is not None and b.size is not None:
        return box_gap(a, b)
    if a.size is not None or b.size is not None:
        box, other = (a, b) if a.size is not None else (b, a)
        centres, radii = world_spheres(other)
        return float((box_distance(box, centres) - radii).min())
    (c, r), (d, s) = world_spheres(a), world_spheres(b)
    if a.corners is not None and b.corners is not None:
        return planar.polygon_gap(c[:, [0, 2]], d[:, [0, 2]]) - float(r[0] + s[0])
    if a.corners is not None:
        return float((planar.polygon_distance(c[:, [0, 2]], d[:, [0, 2]]) - r[0] - s).min())
    if b.corners is not None:
        return float((planar.polygon_distance(d[:, [0, 2]], c[:, [0, 2]]) - s[0] - r).min())
    return float((np.linalg.norm(c[:, None] - d, axis=2) - r[:, None] - s).min())


def box_distance(box: RigidBody, points: Array) -> Array:
    """Signed distances (n,) m of points (n, 3) m from a box."""
    local = (points - np.array(box.position)) @ rotation_matrix(box.orientation)
    beyond = np.abs(local) - 0.5 * np.array(box.size)
    far = np.linalg.norm(np.maximum(beyond, 0.0), axis=1)
    return np.asarray(far + np.minimum(beyond.max(axis=1), 0.0))


def box_gap(a: RigidBody, b: RigidBody) -> float:
    """Widest gap [m] of two boxes over the 15 axes that can separate them (Gottschalk 1996)."""
    R, S = rotation_matrix(a.orientation), rotation_matrix(b.orientation)
    crossed = np.cross(R.T[:, None], S.T[None]).reshape(9, 3)
    lengths = np.linalg.norm(crossed, axis=1)
    axes = np.vstack([R.T, S.T, crossed[lengths > 1e-9] / lengths[lengths > 1e-9, None]])
    distance = np.abs(axes @ (np.array(a.position) - np.array(b.position)))
    half_a = np.abs(axes @ R) @ (0.5 * np.array(a.size))
    half_b = np.abs(axes @ S) @ (0.5 * np.array(b.size))
    return float((distance - half_a - half_b).max())
