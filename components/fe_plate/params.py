"""What a scene says about a structure of finite elements."""

import math
from typing import Literal

from quintet.components.fe_plate.meshes.params import Part
from quintet.components.fe_plate.meshes.selections import Elements, Faces, Fixed, NodeSet
from quintet.interfaces.params import (
    NotNegative,
    Number,
    Positive,
    Vector,
    parameters,
)

STIFFEST_HOURGLASS = 2.0  # whose frequency is the bound that the step keeps to
Erosion = Literal["plastic_strain", "damage", "spall"]


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
            raise ValueError("pressures: a pulse must have an end; found none. Add end.")
        if self.end is not None and not self.end > self.begin:
            raise ValueError(
                f"pressures.end must be after begin, {self.begin:g} s; found {self.end:g} s. "
                "Correct one of them."
            )

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
            raise ValueError(
                "rigid_walls.normal must not be 0; found 0. Let it point to the structure."
            )


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
    node_set_gauges
        Names of sets: mean position [m] and velocity [m/s] of the nodes of each.
    element_set_gauges
        Elements: mean velocity [m/s], energies [J], mean equivalent stress [Pa], greatest plastic
        strain and damage of each set.
    """

    node_gauges: tuple[Vector, ...] = ()
    element_gauges: tuple[Vector, ...] = ()
    part_gauge: bool = False
    node_set_gauges: tuple[str, ...] = ()
    element_set_gauges: tuple[Elements, ...] = ()


@parameters
class FePlateParams:
    """A structure, its supports and its loads.

    Parameters
    ----------
    parts
        What it is made of; parts do not touch each other.
    node_sets
        Nodes by name.
    fixed
        Nodes that are held.
    coupled_faces
        Outer faces that partners see; all if none are said.
    contact_with_faces
        Whether these touch the faces of a partner's mesh (link contact). Of two meshes one needs
        it, which then computes the forces.
    pressures
        On outer faces.
    rigid_walls
        Planes that nodes do not pass.
    gauges
        What is measured.
    gravity : m/s2
        Acceleration of free fall.
    erosion
        What erodes elements, where their material says it: a plastic strain (failure_strain),
        damage, or the greatest principal stress (spall_stress). What is left out does nothing.
    dimensions
        In two, x and z, plane strain: parts are one element of 1 m deep along y, forces those on
        1 m, and faces edges.
    integration
        Reduced: one quadrature point an element, with stabilisation: of n layers bending lacks
        1/n² of its stiffness; full: eight, with strains assumed so that bending is exact: eight
        times the work. Auto: full where a slender part has fewer than 8 layers and no material
        has a law of shocks or of failure, reduced elsewhere. Tetrahedra have four points, and
        refuse reduced.
    courant : 1
        Share of the greatest step that is proven stable; that of a mesh may be twice as great.
    hourglass : 1
        Stiffness of the stabilisation of one point, as a share of the element's own; at most 2.
    viscosity_linear, viscosity_quadratic : 1
        C₁ and C₀ of the bulk viscosity ρ l (C₀² l D² - C₁ c D), in compression.
    mass_damping : 1/s
        α: free motion decays as exp(-α t/2), the amplitude of a vibration as exp(-α t/4).
    stiffness_damping : s
        β of the stress β (2G dev D + K tr D): the amplitude of a vibration decays as
        exp(-β ω² t/2).
    """

    parts: tuple[Part, ...]
    node_sets: tuple[NodeSet, ...] = ()
    fixed: tuple[Fixed, ...] = ()
    coupled_faces: tuple[Faces, ...] = ()
    contact_with_faces: bool = False
    pressures: tuple[Pressure, ...] = ()
    rigid_walls: tuple[RigidWall, ...] = ()
    gauges: Gauges = Gauges()
    gravity: Vector = (0.0, 0.0, 0.0)
    erosion: tuple[Erosion, ...] = ("plastic_strain", "damage", "spall")
    dimensions: Literal[2, 3] = 3
    integration: Literal["auto", "reduced", "full"] = "auto"
    courant: Positive = 0.9
    hourglass: NotNegative = 0.05
    viscosity_linear: NotNegative = 0.06
    viscosity_quadratic: NotNegative = 1.5
    mass_damping: NotNegative = 0.0
    stiffness_damping: NotNegative = 0.0

    def __post_init__(self) -> None:
        if not self.parts:
            raise ValueError("parts must be at least one; found none. Add [[parts]].")
        if self.dimensions == 2:
            for number, part in enumerate(self.parts):
                part.require_planar(f"parts.{number}")
            self._require_planar_loads()
        if self.hourglass > STIFFEST_HOURGLASS:
            raise ValueError(
                f"hourglass must be at most {STIFFEST_HOURGLASS:g}, for stiffer patterns vibrate "
                f"faster than the step allows; found {self.hourglass:g}. Lower it (0.05 is usual)."
            )

    def _require_planar_loads(self) -> None:
        """Refuse what would push nodes out of the plane, along which they do not move."""
        along = {"gravity": self.gravity}
        along |= {f"rigid_walls.{k}.normal": wall.normal for k, wall in enumerate(self.rigid_walls)}
        for name, vector in along.items():
            if vector[1] != 0.0:
                raise ValueError(
                    f"{name} must be along x and z in two dimensions; found {list(vector)}. Set "
                    "its y to 0, or dimensions = 3."
                )
