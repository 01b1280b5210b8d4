"""What a scene says about a structure of finite elements."""

import math
from typing import Literal

from quintet.components.shared.materials.params import Material, MaterialName, material
from quintet.interfaces.params import (
    Count,
    Fraction,
    NotNegative,
    Number,
    Positive,
    Vector,
    parameters,
)

Direction = Literal["x", "y", "z"]


@parameters
class Part:
    """A box of equal elements.

    Parameters
    ----------
    lowest, highest : m
        Its corners.
    elements : 1
        How many along x, y and z.
    material
        Name of a material of the library, or its table.
    velocity : m/s
        At the start.
    """

    lowest: Vector
    highest: Vector
    elements: tuple[Count, Count, Count]
    material: MaterialName | Material
    velocity: Vector = (0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        if not all(a < b for a, b in zip(self.lowest, self.highest, strict=True)):
            raise ValueError(
                f"part: highest must be beyond lowest along every axis; found {self.lowest} and "
                f"{self.highest} m."
            )

    @property
    def count(self) -> int:
        """Number of its elements."""
        return math.prod(self.elements)

    @property
    def expected_step(self) -> float:
        """Step [s] that its shortest edge bears."""
        made = material(self.material)
        sides = zip(self.lowest, self.highest, self.elements, strict=True)
        bound = sum(((n / (b - a)) ** 2 for a, b, n in sides), 0.0)
        speed = math.sqrt((made.bulk + 4.0 / 3.0 * made.shear) / made.density)
        return 1.0 / (speed * math.sqrt(bound))


@parameters
class Fixed:
    """Nodes that are held.

    Parameters
    ----------
    lowest, highest : m
        A box; nodes within it at the start are held.
    directions
        Along which they keep their places; all for clamped ones, the normal for a symmetry plane.
    """

    lowest: Vector
    highest: Vector
    directions: tuple[Direction, ...] = ("x", "y", "z")


@parameters
class Faces:
    """Outer faces, by a box.

    Parameters
    ----------
    lowest, highest : m
        Faces all of whose corners lie in this box at the start.
    """

    lowest: Vector
    highest: Vector


@parameters
class Pressure:
    """A pressure on outer faces, along their normals as they move.

    Parameters
    ----------
    faces
        Those that it acts on.
    pressure : Pa
        Positive pushes.
    begin, end : s
        When it acts; to the end of the run without `end`.
    """

    faces: Faces
    pressure: Number
    begin: NotNegative = 0.0
    end: Positive | None = None


@parameters
class RigidWall:
    """A plane that nodes do not pass; they slide on it, and leave it freely.

    Parameters
    ----------
    point : m
        Any point of the plane.
    normal : 1
        Towards the structure; of any length.
    """

    point: Vector
    normal: Vector

    def __post_init__(self) -> None:
        if not any(self.normal):
            raise ValueError("rigid wall: normal must have a length; found 0.")


@parameters
class FePlateParams:
    """A structure, its supports and its loads.

    Parameters
    ----------
    parts
        What it is made of; parts do not touch each other.
    fixed
        Nodes that are held.
    coupled_faces
        Outer faces that partners see; all if none are said.
    pressures
        On outer faces.
    rigid_walls
        Planes that nodes do not pass.
    gravity : m/s2
        Acceleration of free fall.
    courant : 1
        Share of the greatest step that is proven stable.
    hourglass : 1
        Stiffness of the stabilisation, as a share of the element's own.
    viscosity_linear, viscosity_quadratic : 1
        C₁ and C₀ of the bulk viscosity ρ l (C₀² l D² - C₁ c D), in compression.
    mass_damping : 1/s
        α: motion decays as exp(-α t/2).
    stiffness_damping : s
        β of the stress β (2G dev D + K tr D).
    """

    parts: tuple[Part, ...]
    fixed: tuple[Fixed, ...] = ()
    coupled_faces: tuple[Faces, ...] = ()
    pressures: tuple[Pressure, ...] = ()
    rigid_walls: tuple[RigidWall, ...] = ()
    gravity: Vector = (0.0, 0.0, 0.0)
    courant: Fraction = 0.9
    hourglass: NotNegative = 0.05
    viscosity_linear: NotNegative = 0.06
    viscosity_quadratic: NotNegative = 1.5
    mass_damping: NotNegative = 0.0
    stiffness_damping: NotNegative = 0.0

    def __post_init__(self) -> None:
        if not self.parts:
            raise ValueError("parts must be at least one; found none. Add [[parts]].")
        if self.courant == 0.0:
            raise ValueError("courant must be above 0; found 0.")
