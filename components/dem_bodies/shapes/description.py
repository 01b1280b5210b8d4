"""Rigid bodies from their descriptions, which must be complete and not contradict themselves."""

import math
from dataclasses import fields
from typing import Any

import numpy as np

from quintet.components.dem_bodies.shapes.placement import cover, edge_radius
from quintet.components.dem_bodies.shapes.planar import leaves_edges
from quintet.components.dem_bodies.shapes.rigid_body import RigidBody
from quintet.components.dem_bodies.shapes.sphere_union import measure_union
from quintet.components.shared.geometry import shape_keys
from quintet.components.shared.geometry.bounds import ORIGIN
from quintet.components.shared.geometry.planar_shapes import Disc, Polygon
from quintet.components.shared.geometry.polygons import area_moments, in_space, require_outline
from quintet.components.shared.geometry.shapes import Box, Mesh, Sphere
from quintet.interfaces.component import Array

NEEDS = {
    **{name: shape_keys.NEEDS[name] for name in ("box", "sphere", "disc", "polygon")},
    "spheres": ("centres", "radii"),
    "mesh": ("file", "agglomerate"),
}
MAY = {
    **{name: ("edge_radius", *shape_keys.MAY.get(name, ())) for name in ("box", "polygon")},
    "spheres": ("origin",),
    "mesh": ("scale", "origin"),
}


def rigid_body(where: str, body: Any) -> RigidBody:
    """Return the body that a table describes; refuse one that is incomplete or contradictory."""
    shape_keys.require_keys(body, where, NEEDS, MAY)
    values = {f.name: getattr(body, f.name) for f in fields(RigidBody) if hasattr(body, f.name)}
    placed = RigidBody(**values, **_place(where, body))
    check_shape(where, placed)
    if (body.density is None) == (body.mass is None):
        raise ValueError(
            f"{where}: exactly one of density and mass must be given; found density "
            f"{body.density}, mass {body.mass}. Leave one out."
        )
    length = math.hypot(*body.orientation)
    if abs(length - 1.0) > 1e-6:
        raise ValueError(
            f"{where}.orientation must be a unit quaternion (w, x, y, z); found "
            f"{body.orientation} of length {length:.6g}. Divide it by its length."
        )
    check_locked(where, placed)
    return placed


def _place(where: str, body: Any) -> dict[str, Any]:
    """Centre of mass, the shape, and the edges of a box."""
    if body.shape == "spheres":
        return _from_origin(body, _centre_of_spheres(where, body))
    if body.shape == "mesh":
        mesh = Mesh(file=body.file, scale=body.scale or 1.0)
        return _from_origin(body, _centre_of_mesh(where, body)) | {"geometry": mesh}
    shape = shape_keys.shape_of(body, where)
    if isinstance(shape, Polygon):
        require_outline(f"{where}.corners", shape.corners)
        centre = in_space(area_moments(shape.outline).centre[None])[0]
        return _from_origin(body, centre) | {"geometry": shape}
    assert isinstance(shape, Box | Sphere | Disc)
    size = shape.size if isinstance(shape, Box) else None
    return {"position": shape.centre, "size": size, "geometry": shape}


def _centre_of_spheres(where: str, body: Any) -> Array:
    if len(body.centres) != len(body.radii) or not body.radii:
        raise ValueError(
            f"{where}: spheres need one radius for each centre, and at least one; found "
            f"{len(body.centres)} centres and {len(body.radii)} radii. Complete them."
        )
    return measure_union((body.centres, body.radii))[1]


def _centre_of_mesh(where: str, body: Any) -> Array:
    try:
        covered = cover(body)
    except ValueError as error:  # the mistakes that are in the file
        raise ValueError(f"{where}: {error}") from error
    assert covered is not None
    return covered.centre


def _from_origin(body: Any, centre: Array) -> dict[str, Any]:
    x, y, z = (np.array(body.origin or ORIGIN) + centre).tolist()
    return {"position": (x, y, z)}


def check_locked(where: str, body: RigidBody) -> None:
    """Refuse locks that are named twice, a rotation that they would have to force, and no lock."""
    if body.released_at is not None and not body.locked:
        raise ValueError(
            f"{where}.released_at must be of a body that is locked until then; found no locked. "
            "Name its locked directions, or leave released_at out."
        )
    if len(set(body.locked)) < len(body.locked):
        raise ValueError(
            f"{where}.locked must name each direction once; found {', '.join(body.locked)}. Leave "
            "out the repetition."
        )
    rotations = [f"rotation_{axis}" for axis in "xyz"]
    locked = [rotation in body.locked for rotation in rotations]
    for axis, is_locked, ω in zip("xyz", locked, body.angular_velocity, strict=True):
        if is_locked and ω != 0.0 and not all(locked):
            raise ValueError(
                f"{where}.angular_velocity must be 0 about {axis}, which is locked; found {ω:g} "
                f"rad/s. Set it to 0, or lock {', '.join(rotations)} for a body that turns evenly."
            )


def check_shape(where: str, body: RigidBody) -> None:
    """Refuse edges that are rounder than the shape allows."""
    radius = edge_radius(body) if body.shape in ("box", "polygon") else 0.0
    if body.corners is not None and not leaves_edges(body, radius):
        raise ValueError(
            f"{where}.edge_radius must leave something of each edge; found {radius:.6g} m. Make it "
            "smaller."
        )
    if body.size is not None and not radius < 0.5 * min(body.size):
        raise ValueError(
            f"{where}.edge_radius must be less than half the smallest edge, "
            f"{0.5 * min(body.size):.6g} m; found {radius:.6g} m. Make it smaller."
        )
