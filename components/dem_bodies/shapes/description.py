"""Whether the description of a body is complete and does not contradict itself."""

import math
from typing import TYPE_CHECKING

from quintet.components.dem_bodies.shapes.placement import cover, edge_radius
from quintet.components.dem_bodies.shapes.planar import check_polygon

if TYPE_CHECKING:
    from quintet.components.dem_bodies.params import Body

SIZES = {  # what describes a body of each shape
    "box": ("size",),
    "sphere": ("diameter",),
    "spheres": ("centres", "radii"),
    "agglomerate": ("agglomerate",),
    "disc": ("diameter",),
    "polygon": ("corners",),
}


def check_body(where: str, body: "Body") -> None:
    """Refuse a body whose description is incomplete or contradicts itself."""
    check_shape(where, body)
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
    check_locked(where, body)
    try:
        cover(body)
    except ValueError as error:  # the mistakes that are in the file
        raise ValueError(f"{where}: {error}") from error


def check_locked(where: str, body: "Body") -> None:
    """Refuse locks that are named twice, and a rotation that locks would have to force."""
    if len(set(body.locked)) < len(body.locked):
        raise ValueError(
            f"{where}.locked must name each direction once; found {', '.join(body.locked)}. Leave "
            "out what is there twice."
        )
    rotations = [f"rotation_{axis}" for axis in "xyz"]
    locked = [one in body.locked for one in rotations]
    for axis, held, ω in zip("xyz", locked, body.angular_velocity, strict=True):
        if held and ω != 0.0 and not all(locked):
            raise ValueError(
                f"{where}.angular_velocity must be 0 about {axis}, which is locked; found {ω:g} "
                f"rad/s. Set it to 0, or lock {', '.join(rotations)} for a body that turns evenly."
            )


def check_shape(where: str, body: "Body") -> None:
    """Refuse a shape that is described by too little or too much."""
    wanted = SIZES[body.shape]
    known = {name for names in SIZES.values() for name in names}
    found = sorted(name for name in known if getattr(body, name) is not None)
    if found != sorted(wanted):
        raise ValueError(
            f"{where}: a {body.shape} is described by {' and '.join(wanted)} alone; "
            f"found {', '.join(found) or 'none'}. Give {' and '.join(wanted)}."
        )
    if body.edge_radius is not None and body.shape not in ("box", "polygon"):
        raise ValueError(
            f"{where}.edge_radius is for boxes and polygons; found it on a {body.shape}. Leave it "
            "out."
        )
    if body.corners is not None:
        check_polygon(where, body, edge_radius(body))
    if body.size is not None and not edge_radius(body) < 0.5 * min(body.size):
        raise ValueError(
            f"{where}.edge_radius must be less than half the smallest edge, "
            f"{0.5 * min(body.size):.6g} m; found {edge_radius(body):.6g} m. Make it smaller."
        )
    if body.centres is not None and body.radii is not None:
        if len(body.centres) != len(body.radii) or not body.radii:
            raise ValueError(
                f"{where}: spheres need one radius for each centre, and at least one; found "
                f"{len(body.centres)} centres and {len(body.radii)} radii. Complete them."
            )
