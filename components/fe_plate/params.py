"""What a scene says about a structure of finite elements."""

import math
from typing import Literal

from quintet.components.fe_plate.meshes.params import Direction, Part
from quintet.interfaces.params import (
    Fraction,
    NotNegative,
    Number,
    Positive,
    Vector,
    parameters,
)


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
    pulse
        Whether it grows from nothing and vanishes again between these, as sin².
    """

    faces: Faces
    pressure: Number
    begin: NotNegative = 0.0
    end: Positive | None = None
    pulse: bool = False

    def __post_init__(self) -> None:
        if self.pulse and self.end is None:
            raise ValueError("pressures: a pulse must have an end; found none. Say it.")

    def at(self, time: float) -> float:
        """Pressure [Pa] at a time [s]."""
        if not self.begin <= time < (math.inf if self.end is None else self.end):
            return 0.0
        if not self.pulse or self.end is None:
            return self.pressure
        return (
            self.pressure * math.sin(math.pi * (time - self.begin) / (self.end - self.begin)) ** 2
        )


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
class Gauges:
    """What is measured in a structure; each gauge is a port of its own.

    Parameters
    ----------
    node_gauges : m
        Points at the start: position [m] and velocity [m/s] of the node that is nearest to each.
    element_gauges : m
        Points at the start: stress, pressure [Pa], plastic strain, temperature [K] and damage of
        the element whose middle is nearest to each.
    part_gauge
        Whether the mean velocity [m/s] and the energies [J] of each part are given.
    """

    node_gauges: tuple[Vector, ...] = ()
    element_gauges: tuple[Vector, ...] = ()
    part_gauge: bool = False


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
    gauges
        What is measured.
    gravity : m/s2
        Acceleration of free fall.
    dimensions
        In two, x and z, plane strain: parts are one element of 1 m deep along y, forces those on
        1 m, and faces edges.
    integration
        Reduced: one quadrature point an element, with stabilisation; full: eight, with strains
        assumed so that bending is exact: seven times the work.
    courant : 1
        Share of the greatest step that is proven stable.
    hourglass : 1
        Stiffness of the stabilisation of one point, as a share of the element's own.
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
    gauges: Gauges = Gauges()
    gravity: Vector = (0.0, 0.0, 0.0)
    dimensions: Literal[2, 3] = 3
    integration: Literal["reduced", "full"] = "reduced"
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
        if self.dimensions == 2:
            for number, part in enumerate(self.parts):
                part.require_planar(f"parts.{number}")
