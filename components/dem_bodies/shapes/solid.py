"""Mass and inertia of bodies, the spheres that make their contacts, and how wide they are."""

from typing import NamedTuple

import numpy as np

from quintet.components.dem_bodies.shapes import planar
from quintet.components.dem_bodies.shapes.copies import Bodies
from quintet.components.dem_bodies.shapes.placement import (
    ROUNDED,
    contact_spheres,
    edge_radius,
)
from quintet.components.dem_bodies.shapes.rigid_body import RigidBody
from quintet.components.dem_bodies.shapes.sphere_union import measure_union
from quintet.components.shared.geometry.box_faces import CORNERS
from quintet.interfaces.component import Array

THIN = 0.1  # of a box's longest edge: a thinner box is listed as if it were as thick


class Solid(NamedTuple):
    """Mass and inertia of one kind of body, and the spheres that make its contacts."""

    mass: float  # kg
    inertia: Array  # (3, 3) kg m2, body axes
    centres: Array  # (s, 3) m, body axes
    radii: Array  # (s,) m
    size: Array  # (3,) m, edges of the box that holds it


def solids(bodies: Bodies) -> list[Solid]:
    """Measure the kinds of bodies."""
    return [measure(kind) for kind in bodies.kinds]


def measure(body: RigidBody) -> Solid:
    """Measure a body: a union of spheres by voxels, all others exactly."""
    if body.size is not None:
        size = np.array(body.size)
        centres = CORNERS * (0.5 * size - edge_radius(body))
        radii = np.full(8, edge_radius(body))
    else:
        centres, radii = contact_spheres(body)
        size = np.ptp(np.vstack([centres - radii[:, None], centres + radii[:, None]]), axis=0)
        if body.shape in planar.SHAPES:
            if body.corners is not None:
                size[[0, 2]] = np.ptp(planar.corners(body), axis=0)
            size[1] = 1.0
    if body.geometry is not None:
        volume, inertia = body.geometry.volume, body.geometry.inertia
    else:
        assert body.centres is not None and body.radii is not None
        volume, _, inertia = measure_union((body.centres, body.radii))
    density = body.density if body.mass is None else body.mass / volume
    assert density is not None
    return Solid(density * volume, density * inertia, centres, radii, size)


def is_ball(body: RigidBody) -> bool:
    """Whether a body is one free sphere: balls have a list and kernels of their own."""
    return body.radius is not None and not body.locked


def contact_length(body: RigidBody, solid: Solid) -> float:
    """Smallest contact radius [m] of a body; of a slender box that of a less slender one."""
    radius = float(solid.radii.min())
    if body.corners is not None:
        shortest = max(planar.shortest_edge(body), THIN * float(solid.size.max()))
        return max(radius, ROUNDED * shortest)
    if body.size is None:
        return radius
    return max(radius, ROUNDED * max(min(body.size), THIN * max(body.size)))


def contact_radii(body: RigidBody, solid: Solid) -> Array:
    """Contact radii (s,) m of a body's spheres: at corners, that of a blunt edge."""
    if body.size is None and body.corners is None:
        return solid.radii
    return np.full(len(solid.radii), contact_length(body, solid))


def half_thickness(body: RigidBody) -> float:
    """Half the least width [m] of a box or polygon."""
    if body.size is not None:
        return 0.5 * min(body.size)
    return float(-planar.polygon_distance(planar.corners(body), np.zeros((1, 2)))[0])


def largest_inverse_effective_mass(solid: Solid) -> float:
    """Largest 1/m* [1/kg] of a body's contact spheres over all directions of the normal."""
    x, y, z = solid.centres.T
    o = np.zeros_like(x)
    skew = np.array([[o, -z, y], [z, o, -x], [-y, x, o]]).transpose(2, 0, 1)  # r × n = skew n
    turning = skew.transpose(0, 2, 1) @ np.linalg.inv(solid.inertia) @ skew
    return 1.0 / solid.mass + float(np.linalg.eigvalsh(turning).max())
