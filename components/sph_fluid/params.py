"""What a scene may say of a weakly compressible fluid."""

from dataclasses import field
from typing import ClassVar, Literal

from pydantic import NonNegativeInt

from quintet.components.shared.geometry.shapes import Bounds, Box
from quintet.components.sph_fluid.setup import geometry
from quintet.components.sph_fluid.setup.checks import check
from quintet.components.sph_fluid.setup.expressions import Expression
from quintet.components.sph_fluid.setup.geometry import (
    Axis,
    Exponent,
    Face,
    Smoothing,
    Spot,
    UprightFace,
)
from quintet.components.sph_fluid.setup.shapes import FluidRegion
from quintet.components.sph_fluid.setup.standing_wave import StandingWave
from quintet.interfaces.params import (
    DataFile,
    Fraction,
    NotNegative,
    Positive,
    Vector,
    parameters,
)

USUAL_ALPHA = 0.1


@parameters
class Viscosity:
    """How a fluid is viscous.

    Parameters
    ----------
    artificial : 1
        α of Monaghan's artificial viscosity (1992, eq. 4.2); without it 0.1, or 0 where
        `kinematic` is given.
    kinematic : m2/s
        ν, the kinematic viscosity of the fluid itself.
    form
        How `kinematic` acts: as a Laplacian (Lo & Shao 2002), close beside walls; or along the
        line between particles (Monaghan & Gingold 1983), without which a free surface is not free
        of stress.
    """

    artificial: NotNegative | None = None
    kinematic: NotNegative = 0.0
    form: Literal["laplacian", "stress"] = "laplacian"

    @property
    def alpha(self) -> float:
        """α of the artificial viscosity: none beside the fluid's own if it is not given."""
        if self.artificial is None:
            return 0.0 if self.kinematic else USUAL_ALPHA
        return self.artificial


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
    wall_velocity : m/s
        Velocities of faces that move in their own planes, like belts.
    obstacles
        Boxes that stand still in the tank.
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
    wall_velocity: dict[Face, Vector] = field(default_factory=dict)
    obstacles: tuple[Box, ...] = ()
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
    def solids(self) -> tuple[Bounds, ...]:
        """Lowest and highest corners [m] of the obstacles."""
        return tuple(box.bounds for box in self.obstacles)


@parameters
class Gauges:
    """What is measured in a fluid; each gauge is a port of its own.

    Parameters
    ----------
    pressure_gauges : m
        Points at which the pressure is given [Pa].
    level_gauges : m
        x and y of the verticals on which the surface's height is given [m].
    front_gauge
        Axis along which the position of the furthest fluid is given [m].
    motion_gauge
        Whether the largest speed [m/s], energies [J] and the centre of mass [m] are given.
    """

    RENAMED: ClassVar = {"front": "front_gauge"}

    pressure_gauges: tuple[Vector, ...] = ()
    level_gauges: tuple[Spot, ...] = ()
    front_gauge: Axis | None = None
    motion_gauge: bool = False


@parameters
class InitialFields:
    """How the fluid moves at the start, and how dense it is.

    Expressions are of x, y and z [m], as "0.1 * sin(2 * pi * x)": numbers, pi, + - * / **, sin,
    cos, tan, sinh, cosh, tanh, exp, log, sqrt, abs, atan2, hypot, min, max, where(a < b, c, d).
    A table is a CSV file whose first line names its columns: of x, y, z [m] those that it depends
    on, of u, v, w [m/s] and density [kg/m3] what it gives. Its rows are the points of a rectangular
    grid; between them it is linear, beyond them as at its edge.

    Parameters
    ----------
    velocity : m/s
        Along x, y and z, each a number or an expression.
    density : kg/m3
        A number or an expression, within 10 % of ρ₀: pressure follows from it by Tait's equation,
        the mass of particles does not. Without it pressure is hydrostatic.
    table
        Name of a table, beside the scene.
    """

    velocity: tuple[Expression, Expression, Expression] | None = None
    density: Expression | None = None
    table: DataFile | None = None


@parameters
class SphFluidParams:
    """A fluid that fills boxes, in an open tank; SI.

    Edges are cut into round(edge / spacing) cells with a particle in the middle of each; all
    particles have the same mass, that of the boxes at `density` over their number. In two
    dimensions, x and z, all boxes are one slab between frictionless planes, a single layer of
    particles.

    Parameters
    ----------
    spacing : m
        Between particles.
    sound_speed : m/s
        Artificial, ten times the largest velocity or more, and at least 10 √(g depth).
    fluid
        Boxes and other shapes full of fluid.
    initial
        Velocity and density of the fluid at the start, where it is not at rest.
    remove_inside_bodies
        Whether fluid that is inside joined bodies at the start is removed; with mdbc.
    dimensions
        In two: x and z.
    kernel
        Cubic spline, or Wendland's C2, which keeps particles apart and calm.
    smoothing : 1
        Smoothing length over spacing.
    staggered
        Whether rows along x start moved against each other.
    density : kg/m3
        ρ₀, at no pressure.
    gravity : m/s2
        Acceleration of free fall.
    density_diffusion : 1
        δ of the diffusion of density (Fourtakas et al. 2019); 0.1 is usual.
    acoustic_damper : 1
        ζ of a bulk viscosity ζ h c₀ that damps sound; 1 is much. With integration symplectic.
    negative_pressure
        Whether pressure may fall below zero.
    xsph : 1
        ε: how far particles move with their neighbours' mean velocity (Monaghan 1989).
    shepard_every : 1
        Steps between two Shepard filters of the density; 0: none.
    precision
        In which pairs are computed.
    integration
        One pass over pairs in a step, or two and second order (position Verlet).
    courant : 1
        Step over the time that sound takes through a smoothing length.
    viscosity
        How the fluid is viscous.
    boundary
        Walls, what stands in the tank, and how they and moving surfaces act on the fluid.
    gauges
        What is measured.
    wave
        A standing wave on the fluid at the start.
    """

    RENAMED: ClassVar = {
        "shapes": "fluid",
        "viscosity": "viscosity.artificial",
        "laminar": "viscosity.kinematic",
        "friction": "viscosity.form",
        "diffusion": "density_diffusion",
        "damper": "acoustic_damper",
        "tension": "negative_pressure",
        "boundary": "boundary.method",
        "walls": "boundary.walls",
        "open": "boundary.open_faces",
        "symmetry": "boundary.symmetry",
        "wall_velocity": "boundary.wall_velocity",
        "obstacles": "boundary.obstacles",
        "standoff": "boundary.wall_offset",
        "inset": "boundary.sample_depth",
        "grip": "boundary.wall_viscosity_factor",
        "gaps": "boundary.lubrication_films",
        "roughness": "boundary.roughness",
        "potential_stiffness": "boundary.potential_stiffness",
        "potential_exponent": "boundary.potential_exponent",
        "pressure_gauges": "gauges.pressure_gauges",
        "level_gauges": "gauges.level_gauges",
        "front": "gauges.front_gauge",
        "motion_gauge": "gauges.motion_gauge",
    }

    spacing: Positive
    sound_speed: Positive
    fluid: tuple[FluidRegion, ...] = ()
    initial: InitialFields | None = None
    remove_inside_bodies: bool = False
    dimensions: Literal[2, 3] = 3
    kernel: Literal["cubic", "wendland"] = "cubic"
    smoothing: Smoothing = 1.5
    staggered: bool = False
    density: Positive = 1000.0
    gravity: Vector = (0.0, 0.0, -9.81)
    density_diffusion: NotNegative = 0.0
    acoustic_damper: NotNegative = 0.0
    negative_pressure: bool = False
    xsph: Fraction = 0.0
    shepard_every: NonNegativeInt = 0
    precision: Literal["float64", "float32"] = "float64"
    integration: Literal["extrapolated", "symplectic"] = "extrapolated"
    courant: Positive = 0.2
    viscosity: Viscosity = Viscosity()
    boundary: Boundary = Boundary()
    gauges: Gauges = Gauges()
    wave: StandingWave | None = None

    def __post_init__(self) -> None:
        """Check what concerns several values at once."""
        check(self)

    @property
    def boxes(self) -> tuple[Bounds, ...]:
        """Lowest and highest corners [m] of the fluid in boxes."""
        return tuple(region.bounds for region in self.fluid if region.shape == "box")

    @property
    def shapes(self) -> tuple[FluidRegion, ...]:
        """Fluid in other shapes."""
        return tuple(region for region in self.fluid if region.shape != "box")

    @property
    def smoothing_length(self) -> float:
        """Smoothing length h [m]."""
        return self.smoothing * self.spacing

    @property
    def mirrored(self) -> bool:
        """Whether walls take their density from mirror points."""
        return self.boundary.method == "mdbc"

    @property
    def hydrostatic_gravity(self) -> Vector:
        """Gravity [m/s2], but none along axes on which the tank is open below: fluid falls."""
        return geometry.hydrostatic_gravity(self)
