"""What a scene says about one body: its shape, its material, how it moves at the start."""

import math
from typing import ClassVar, Literal

from quintet.components.shared.geometry.bounds import Bounds
from quintet.components.shared.geometry.shape_keys import (
    RENAMED,
    BoxKeys,
    CylinderKeys,
    MeshKeys,
    RoundKeys,
    TubeKeys,
    shape_of,
)
from quintet.components.shared.geometry.shapes import Mesh, Shape
from quintet.components.shared.materials.params import Material, MaterialName
from quintet.interfaces.params import Vector, parameters

Axis = Literal["x", "y", "z"]
Gradient = tuple[Vector, Vector, Vector]


@parameters
class Body(BoxKeys, CylinderKeys, TubeKeys, RoundKeys, MeshKeys):
    """A body, filled with particles: a lattice of them, or layers of circles in a tube.

    Parameters
    ----------
    shape
        In two dimensions a box, or a cylinder along y: with an inner radius a ring.
    centre : m
        Of a sphere.
    radius : m
        Of a sphere or cylinder.
    material
        Name of a material of the library, or its table.
    velocity : m/s
        At the start; of the middle of its box if it turns or strains.
    angular_velocity : rad/s
        At the start, about the middle of its box.
    velocity_gradient : 1/s
        At the start: rows of ∂v_a/∂x_b, about the middle of its box, added to the rest.
    """

    RENAMED: ClassVar = {**RENAMED, "position": "origin"}
    shape: Literal["box", "sphere", "cylinder", "mesh"] = "box"
    material: MaterialName | Material
    velocity: Vector = (0.0, 0.0, 0.0)
    angular_velocity: Vector = (0.0, 0.0, 0.0)
    velocity_gradient: Gradient = ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))

    def __post_init__(self) -> None:
        shape_of(self, "bodies")

    @property
    def geometry(self) -> Shape:
        """The shape that the keys describe."""
        return shape_of(self, "bodies")

    @property
    def bounds(self) -> Bounds:
        """Lowest and highest corner [m] of what it reaches over."""
        return self.geometry.bounds

    def volume(self, dimensions: int, axisymmetric: bool = False) -> float:
        """Volume [m3]; in two dimensions of a slice 1 m deep, or of what is turned about z."""
        shape = self.geometry
        if isinstance(shape, Mesh):
            return shape.volume
        (low, _, bottom), (high, _, top) = shape.bounds
        if axisymmetric and self.shape == "box":
            return math.pi * (high**2 - max(low, 0.0) ** 2) * (top - bottom)
        edges = [b - a for a, b in zip(*shape.bounds, strict=True)]
        if dimensions == 2 and not axisymmetric:
            edges[1] = 1.0
        return shape.share * math.prod(edges)

    @property
    def motion(self) -> tuple[object, ...]:
        """All of its motion at the start."""
        return self.velocity, self.angular_velocity, self.velocity_gradient
