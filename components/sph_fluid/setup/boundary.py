"""Walls of a fluid's tank, what stands in it, and how both act on the fluid."""

from dataclasses import field
from typing import ClassVar, Literal

from quintet.components.shared.geometry.bounds import Bounds
from quintet.components.shared.geometry.shapes import Box
from quintet.components.sph_fluid.setup.boundary_meshes import BoundaryMesh
from quintet.components.sph_fluid.setup.damping_zones import DampingZone
from quintet.components.sph_fluid.setup.geometry import FACES, Axis, Exponent, Face, UprightFace
from quintet.components.sph_fluid.setup.inflow_outflow import Inflow, Outflow
from quintet.components.sph_fluid.setup.motion import Motion
from quintet.components.sph_fluid.setup.pistons import Piston
from quintet.interfaces.params import Fraction, NotNegative, Positive, Vector, parameters


@parameters
class Boundary:
    """Walls of a tank, what stands in it, and how they and moving surfaces act on the fluid.

    Parameters
    ----------
    method
        Dynamic boundary particles (Crespo et al. 2007; dbc), modified ones whose density is
        mirrored (English et al. 2022; mdbc), or a contact potential in place of their pressure
        (Vignjevic et al. 2006).
    walls
        The inside of a tank, a box.
    open_faces
        Faces that the tank lacks.
    symmetry
        Upright faces of the tank that are planes of symmetry, without walls.
    periodic
        Axes along which the tank repeats: fluid that leaves at one face enters at the opposite one.
        Gravity along x or y then drives the flow; on one rank.
    inflow
        Open faces through which fluid enters; on one rank.
    outflow
        Open faces through which fluid leaves; on one rank.
    wall_velocity : m/s
        Velocities of faces that move in their own planes, like belts.
    obstacles
        Boxes that stand still in the tank.
    meshes
        Tanks and obstacles from files, with or without walls; in three dimensions.
    motion
        How the tank with all that stands in it moves; the fluid is computed in its frame.
    pistons
        Parts of the boundary that move by themselves, while the others stand.
    damping
        Zones that damp the fluid's motion, so that waves end there.
    wall_offset : 1
        Spacings from a wall's face out to its first particles; 0.5 with mdbc.
    sample_depth : 1
        Spacings from a moving surface in to its outermost samples; 0.5 with mdbc.
    wall_viscosity_factor : 1
        Share of the viscosity that acts between the fluid and walls or samples: 0 lets it slip.
    lubrication_films
        Whether films press in gaps that are too narrow for particles alone; with mdbc, in three
        dimensions. With auto from when a wet body comes near to a wall or to another.
    roughness : m
        Least width that a film has between faces that touch.
    potential_stiffness : Pa
        K Δpᵈ of the contact potential; without it, what holds the pressure of water at rest.
    potential_exponent : 1
        n, how much the contact potential steepens towards the wall.
    """

    RENAMED: ClassVar = {
        "open": "open_faces",
        "standoff": "wall_offset",
        "inset": "sample_depth",
        "grip": "wall_viscosity_factor",
        "gaps": "lubrication_films",
    }

    method: Literal["dbc", "mdbc", "potential"] = "mdbc"
    walls: Box | None = None
    open_faces: tuple[Face, ...] = ("z+",)
    symmetry: tuple[UprightFace, ...] = ()
    periodic: tuple[Axis, ...] = ()
    inflow: tuple[Inflow, ...] = ()
    outflow: tuple[Outflow, ...] = ()
    wall_velocity: dict[Face, Vector] = field(default_factory=dict)
    obstacles: tuple[Box, ...] = ()
    meshes: tuple[BoundaryMesh, ...] = ()
    motion: Motion | None = None
    pistons: tuple[Piston, ...] = ()
    damping: tuple[DampingZone, ...] = ()
    wall_offset: Positive = 0.5
    sample_depth: NotNegative = 0.5
    wall_viscosity_factor: Fraction = 1.0
    lubrication_films: bool | Literal["auto"] = "auto"
    roughness: Positive = 5e-4
    potential_stiffness: Positive | None = None
    potential_exponent: Exponent = 1

    @property
    def tank(self) -> Bounds | None:
        """Lowest and highest corner [m] of the walls."""
        return None if self.walls is None else self.walls.bounds

    @property
    def is_still(self) -> bool:
        """Whether nothing comes or goes, and nothing of the boundary moves."""
        comes_or_goes = self.inflow or self.outflow
        return not (comes_or_goes or self.wall_velocity or self.motion or self.pistons)

    @property
    def solids(self) -> tuple[Bounds, ...]:
        """Lowest and highest corners [m] of the obstacles."""
        return tuple(box.bounds for box in self.obstacles)

    @property
    def moved_solids(self) -> tuple[Bounds, ...]:
        """Lowest and highest corners [m] of the obstacles that are pistons."""
        numbers = [piston.number("obstacles") for piston in self.pistons]
        return tuple(self.solids[number] for number in numbers if number >= 0)

    @property
    def moved_meshes(self) -> tuple[BoundaryMesh, ...]:
        """Meshes that are pistons."""
        numbers = [piston.number("meshes") for piston in self.pistons]
        return tuple(self.meshes[number] for number in numbers if number >= 0)

    def closed_faces(self, dimensions: int) -> tuple[Face, ...]:
        """Faces at which the tank has wall particles."""
        without = {*self.open_faces, *self.symmetry, *(("y-", "y+") if dimensions == 2 else ())}
        return tuple(f for f in FACES if f not in without and f[0] not in self.periodic)

    def around(self, thickness: float) -> Bounds | None:
        """Lowest and highest corner of the tank and of walls so thick [m] at its closed faces."""
        if self.tank is None:
            return None
        lower, upper = (
            tuple(thickness if f"{axis}{side}" in self.closed_faces(3) else 0.0 for axis in "xyz")
            for side in "-+"
        )
        (x, y, z), (u, v, w) = self.tank
        lowest = (x - lower[0], y - lower[1], z - lower[2])
        return lowest, (u + upper[0], v + upper[1], w + upper[2])

    def why_no_films(self, dimensions: int) -> str:
        """Why there can be no films in narrow gaps; "" if there can."""
        if self.pistons:
            return "films are not available with boundary.pistons"
        if self.method != "mdbc":
            return f"films are not available with boundary.method {self.method}"
        if dimensions == 2:
            return "films are not available in two dimensions"
        if self.symmetry:
            return "films are not available with boundary.symmetry"
        if self.periodic:
            return "films are not available with boundary.periodic"
        return ""
