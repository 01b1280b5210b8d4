"""Refusals in two dimensions: shapes of three, and motion that would leave the plane."""

from collections.abc import Sequence

import numpy as np

from quintet.components.dem_bodies.shapes.copies import Bodies
from quintet.components.dem_bodies.shapes.planar import SHAPES
from quintet.components.dem_bodies.shapes.rigid_body import Plane
from quintet.components.shared.geometry.polygons import is_convex
from quintet.interfaces.params import Vector


def check_plane(bodies: Bodies, planes: Sequence[Plane], gravity: Vector, dimensions: int) -> None:
    """Refuse shapes of other dimensions, and motion that would leave the plane."""
    templates = list(zip(bodies.first, bodies.templates, strict=False))
    planar = dimensions == 2
    for k, body in templates:
        if (body.shape in SHAPES) != planar:
            rule = " or ".join(SHAPES) if planar else "a shape of three dimensions"
            raise ValueError(
                f"bodies[{k}].shape must be {rule} where dimensions is {dimensions}; found "
                f"{body.shape}. Choose another, or set dimensions to {3 if planar else 2}."
            )
        if body.corners is not None and not is_convex(np.array(body.corners)):
            _require_alone(k, len(bodies) - 1, len(planes))
    if not planar:
        return
    _require_plane("gravity", gravity, (1,))
    for k, plane in enumerate(planes):
        _require_plane(f"planes[{k}].normal", plane.normal, (1,))
    first = templates[0][1].position[1]
    for k, body in templates:
        where, y = f"bodies[{k}]", body.position[1]
        if body.copies is not None and body.copies.number[1] > 1:
            where, y = f"bodies[{k + body.copies.number[2]}]", y + body.copies.spacing[1]
        if y != first:
            raise ValueError(
                f"{where} must have the y of all others, {first:g} m, in two dimensions; "
                f"found {y:g} m. Correct it."
            )
        _require_plane(f"{where}.velocity", body.velocity, (1,))
        _require_plane(f"{where}.angular_velocity", body.angular_velocity, (0, 2))
        _require_plane(f"{where}.orientation (w, x, y, z)", body.orientation, (1, 3))


def _require_alone(number: int, others: int, planes: int) -> None:
    if others or planes:
        raise ValueError(
            f"bodies[{number}].corners must go round a convex polygon where it may touch anything; "
            f"found one that is not, beside {others} other bodies and {planes} planes. Leave these "
            "out, or make several bodies of it."
        )


def _require_plane(where: str, vector: Sequence[float], none: tuple[int, ...]) -> None:
    if any(vector[axis] != 0.0 for axis in none):
        raise ValueError(
            f"{where} must stay in the plane of x and z, in two dimensions; found {tuple(vector)}. "
            "Set what leaves it to 0."
        )
