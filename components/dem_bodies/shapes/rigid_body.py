"""Rigid bodies as this component places them: a shape in body axes, and a pose."""

from dataclasses import dataclass
from typing import Annotated, ClassVar

from pydantic import Field

from quintet.components.shared.geometry.bounds import Corners
from quintet.components.shared.geometry.shapes import Shape
from quintet.interfaces.params import (
    Count,
    NotNegative,
    Number,
    Positive,
    PositiveVector,
    Vector,
    parameters,
)

Quaternion = tuple[Number, Number, Number, Number]


@parameters
class Copies:
    """A lattice of equal bodies, numbered in its order, x slowest.

    Parameters
    ----------
    number : 1
        How many along x, y and z.
    spacing : m
        From one copy to the next.
    scatter : m
        Largest displacement of each copy along each axis.
    seed : 1
        Seed of the random numbers of the scatter.
    """

    number: tuple[Count, Count, Count]
    spacing: PositiveVector
    scatter: NotNegative = 0.0
    seed: int = 0


@parameters
class Agglomerate:
    """Equal spheres on a lattice that cover the surface of a mesh.

    Parameters
    ----------
    dim : 1
        Places of the lattice along the longest edge of the box around the mesh.
    sphere_radius : m
        Of the spheres; at most half the shortest edge of that box.
    """

    RENAMED: ClassVar = {
        "file": 'file of the body, whose shape is "mesh"',
        "scale": 'scale of the body, whose shape is "mesh"',
    }
    dim: Annotated[int, Field(ge=2)]
    sphere_radius: Positive


@parameters
class Plane:
    """A fixed half-space.

    Parameters
    ----------
    point : m
        Any point of its surface.
    normal : 1
        Towards the free side; of any length.
    material
        One of the materials.
    until : s
        When it vanishes; it stays if not given.
    """

    point: Vector
    normal: Vector
    material: str
    until: Positive | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class RigidBody:
    """One rigid body, or a lattice of equal ones; fields of other shapes are None."""

    shape: str
    position: Vector  # m, of the centre of mass
    geometry: Shape | None = None  # where the scene has it; None of a union of spheres
    size: Vector | None = None  # m, edges of a box
    edge_radius: float | None = None  # m, of a box or polygon
    radius: float | None = None  # m, of a sphere or disc
    corners: Corners | None = None  # m, of a polygon, about any point
    centres: tuple[Vector, ...] | None = None  # m, of spheres, about any point
    radii: tuple[float, ...] | None = None  # m
    file: str | None = None  # of a mesh
    scale: float | None = None  # m
    agglomerate: Agglomerate | None = None
    density: float | None = None  # kg/m3
    mass: float | None = None  # kg
    material: str
    orientation: Quaternion
    velocity: Vector  # m/s
    angular_velocity: Vector  # rad/s
    locked: tuple[str, ...]
    released_at: float | None  # s
    copies: Copies | None
