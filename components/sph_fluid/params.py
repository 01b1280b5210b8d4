"""What a scene may say of a weakly compressible fluid."""

from typing import ClassVar, Literal

from pydantic import NonNegativeInt

from quintet.components.shared.geometry.bounds import Bounds
from quintet.components.sph_fluid.setup import checks
from quintet.components.sph_fluid.setup.boundary import Boundary
from quintet.components.sph_fluid.setup.boundary_meshes import Filling
from quintet.components.sph_fluid.setup.gauge_places import Gauges
from quintet.components.sph_fluid.setup.geometry import Face, Smoothing, levels
from quintet.components.sph_fluid.setup.initial import InitialFields
from quintet.components.sph_fluid.setup.mass import check_mass, mass_notes, particle_volume
from quintet.components.sph_fluid.setup.shapes import FluidRegion
from quintet.components.sph_fluid.setup.standing_wave import StandingWave
from quintet.components.sph_fluid.setup.viscosity import Viscosity
from quintet.interfaces.materials.filling import MaterialName
from quintet.interfaces.params import Fraction, NotNegative, Positive, Vector, parameters


@parameters
class SphFluidParams:
    """A fluid that fills boxes, in an open tank; SI.

    Edges are cut into round(edge / spacing) cells with a particle in the middle of each; all
    particles have the same mass, that of the boxes at `density` over their number. In two
    dimensions, x and z, all boxes are one slab between frictionless planes, a single layer of
    particles.

    Parameters
    ----------
    material
        Name of a liquid, whose density and kinematic viscosity stand for those that are not given.
    spacing : m
        Between particles.
    sound_speed : m/s
        Artificial, ten times the largest velocity or more, and at least 10 √(g depth).
    fluid
        Boxes and other shapes full of fluid.
    initial
        Velocity and density of the fluid at the start, where it is not at rest.
    lost_limit : 1
        Share of the fluid that may be lost: more, and the run ends. Without it any may.
    remove_inside_bodies
        Whether fluid that is inside joined bodies at the start is removed; with mdbc.
    dimensions
        In two: x and z.
    kernel
        Cubic spline; quintic spline, whose rows of particles slide most easily; or Wendland's C2,
        which keeps particles apart and calm.
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

    MATERIAL: ClassVar = {"density": "density", "viscosity.kinematic": "kinematic_viscosity"}
    material: MaterialName | None = None
    spacing: Positive
    sound_speed: Positive
    fluid: tuple[FluidRegion, ...] = ()
    initial: InitialFields | None = None
    lost_limit: Fraction | None = None
    remove_inside_bodies: bool = False
    dimensions: Literal[2, 3] = 3
    kernel: Literal["cubic", "quintic", "wendland"] = "cubic"
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
        """Refuse what cannot be computed."""
        if not self.fluid:
            raise ValueError("fluid must have at least one box; found none. Add a box.")
        boundary, spacing, dimensions = self.boundary, self.spacing, self.dimensions
        checks.check_boxes(self.fluid, spacing)
        check_mass(self.fluid, spacing, dimensions)
        checks.check_walls(boundary, self.fluid, spacing, dimensions)
        checks.check_lost_limit(self.lost_limit, boundary)
        checks.check_obstacles(boundary, self.fluid, spacing, dimensions)
        checks.check_sound(self.sound_speed, self.hydrostatic_gravity, self.depth)
        if dimensions == 2:
            walls = () if boundary.tank is None else (boundary.tank,)
            checks.check_slab([*self.extents, *walls, *boundary.solids], self.gravity)
        pair_range = 3.0 * self.smoothing_length
        checks.check_symmetry(boundary, dimensions, self.gravity, pair_range, spacing)
        if boundary.periodic:
            self._check_periodic(pair_range)
        if boundary.inflow or boundary.outflow:
            self._check_flow()
        checks.check_moved(boundary)
        checks.check_method(boundary, dimensions)
        if boundary.motion is not None:
            # Left out of scenes whose tank stands still.
            from quintet.components.sph_fluid.setup.motion_checks import check_motion

            check_motion(boundary, boundary.motion, dimensions)
        if boundary.pistons:
            self._check_pistons()
        if boundary.damping:
            # Left out of scenes without damping zones.
            from quintet.components.sph_fluid.setup.wave_checks import check_damping

            check_damping(boundary, self.extents, dimensions, spacing)
        self._check_methods()
        self.gauges.check(boundary, spacing, dimensions, 2.0 * self.smoothing_length)
        if self.shapes:
            # Left out of scenes whose fluid is in boxes.
            from quintet.components.sph_fluid.setup.shape_checks import check_shapes

            check_shapes(self.fluid, boundary.solids, spacing, dimensions)
        if boundary.meshes:
            self._check_meshes()
        if self.initial is not None:
            self.initial.check(self.extents, self.density, self.wave is not None)
        if self.wave is not None:
            self.wave.check(self.boxes, self.gravity)
            checks.check_wave_resolution(self.depth, spacing)

    def _check_flow(self) -> None:
        # Left out of scenes whose fluid neither comes nor goes.
        from quintet.components.sph_fluid.setup.flow_checks import check_buffers, check_pressures
        from quintet.components.sph_fluid.setup.inflow_outflow import check_flow

        edge = self.boundary
        check_flow(edge.inflow, edge.outflow, edge.tank, edge.open_faces, self.dimensions)
        assert edge.tank is not None
        check_buffers(self.passages, edge.tank, edge.solids, self.spacing, self.smoothing)
        fluid = (self.density, self.sound_speed, self.negative_pressure)
        check_pressures(edge.outflow, *fluid)

    def _check_periodic(self, pair_range: float) -> None:
        # Left out of scenes whose tank does not repeat.
        from quintet.components.sph_fluid.setup.periodic_checks import check_periodic

        check_periodic(self.boundary, self.dimensions, self.gravity, pair_range, self.spacing)
        if self.gauges.front_gauge in self.boundary.periodic:
            raise ValueError(
                "gauges.front_gauge must not lie along an axis on which the tank repeats, where "
                f"nothing is furthest; found {self.gauges.front_gauge}. Remove it."
            )

    def _check_pistons(self) -> None:
        # Left out of scenes without pistons.
        from quintet.components.sph_fluid.setup.piston_checks import check_pistons

        check_pistons(self.boundary, self.dimensions, self.spacing)
        if any(piston.waves for piston in self.boundary.pistons):
            # Left out of scenes without wave makers.
            from quintet.components.sph_fluid.setup.wave_checks import check_waves

            check_waves(self.boundary, self.extents, self.gravity, self.spacing)

    def _check_methods(self) -> None:
        """Options are asked for with what they need."""
        if self.remove_inside_bodies and not self.mirrored:
            raise ValueError(
                "remove_inside_bodies needs boundary.method mdbc, whose samples say where the "
                f"surface is; found {self.boundary.method}. Set method, or cut the fluid."
            )
        if self.acoustic_damper > 0.0 and self.integration != "symplectic":
            raise ValueError(
                "acoustic_damper needs integration symplectic, whose step limit with it is known; "
                f"found acoustic_damper {self.acoustic_damper} and integration "
                f"{self.integration}. Set integration, or remove acoustic_damper."
            )

    def _check_meshes(self) -> None:
        """Boundaries from files suit the fluid."""
        # Left out of scenes without them, and of those without other shapes.
        from quintet.components.sph_fluid.setup.mesh_checks import (
            check_meshes,
            mesh_surfaces,
            region_points,
        )

        if self.staggered:
            raise ValueError(
                "staggered is not available with boundary.meshes, for rows move towards the "
                "surfaces; found both. Remove one of them."
            )
        places = region_points(self.fluid, self.spacing)
        gauges = self.gauges.fluid_points
        check_meshes(self.boundary, self.mesh_filling, self.dimensions, places, gauges)
        if self.passages and self.boundary.tank:
            # Left out of scenes whose fluid neither comes nor goes.
            from quintet.components.sph_fluid.setup.flow_checks import check_meshes_in_buffers

            tank, surfaces = self.boundary.tank, mesh_surfaces(self.boundary, self.mesh_filling)
            check_meshes_in_buffers(self.passages, tank, surfaces, self.smoothing)

    @property
    def mesh_filling(self) -> Filling:
        """How wall particles are placed behind boundaries from files."""
        dry = [
            ("xyz".index(face[0]), self.boundary.tank["-+".index(face[1])]["xyz".index(face[0])])
            for face in (self.closed_faces if self.boundary.tank else ())
            if self.boundary.tank
        ]
        reach = 2.0 * self.smoothing_length  # the radius of the kernel
        offset, tank = self.boundary.wall_offset, self.boundary.tank
        around = self.boundary.around(reach + offset * self.spacing)
        return Filling(self.spacing, reach, offset, tuple(dry), tank, around)

    @property
    def boxes(self) -> tuple[Bounds, ...]:
        """Lowest and highest corners [m] of the fluid in boxes."""
        return tuple(region.bounds for region in self.fluid if region.shape == "box")

    @property
    def shapes(self) -> tuple[FluidRegion, ...]:
        """Fluid in other shapes."""
        return tuple(region for region in self.fluid if region.shape != "box")

    @property
    def extents(self) -> tuple[Bounds, ...]:
        """Boxes of fluid, and those around its other shapes."""
        return *self.boxes, *(shape.bounds for shape in self.shapes)

    @property
    def passages(self) -> list[Face]:
        """Faces through which fluid comes, then those through which it goes."""
        entrances = [passage.face for passage in self.boundary.inflow]
        return entrances + [passage.face for passage in self.boundary.outflow]

    @property
    def closed_faces(self) -> tuple[Face, ...]:
        """Faces at which the tank has wall particles."""
        return self.boundary.closed_faces(self.dimensions)

    @property
    def notes(self) -> tuple[str, ...]:
        """What a user should read of the mass of particles, viscosity, meshes and absorption."""
        masses = mass_notes(self.fluid, self.spacing, self.dimensions)
        return *masses, *self.viscosity.notes, *self._mesh_notes(), *self._wave_notes()

    def _wave_notes(self) -> tuple[str, ...]:
        if not any(piston.absorbs for piston in self.boundary.pistons):
            return ()
        # Left out of scenes without wave makers.
        from quintet.components.sph_fluid.setup.wave_checks import absorption_notes

        return absorption_notes(self.boundary)

    def _mesh_notes(self) -> tuple[str, ...]:
        if not self.boundary.meshes:
            return ()
        # Left out of scenes without boundaries from files.
        from quintet.components.sph_fluid.setup.mesh_checks import mesh_notes

        return mesh_notes(self.boundary, self.mesh_filling)

    @property
    def particle_volume(self) -> float:
        """Volume [m3] of a particle at rest; area [m2] in two dimensions."""
        return particle_volume(self.fluid, self.spacing, self.dimensions)

    @property
    def slab_thickness(self) -> float:
        """Of the slab [m] that a particle's mass is counted over; 1 in three dimensions."""
        low, high = self.extents[0]
        return high[1] - low[1] if self.dimensions == 2 else 1.0

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
        if self.boundary.tank is None:
            return self.gravity
        below = [f"{a}{'+' if g > 0.0 else '-'}" for a, g in zip("xyz", self.gravity, strict=True)]
        pairs = zip(below, self.gravity, strict=True)
        x, y, z = (g if face in self.closed_faces else 0.0 for face, g in pairs)
        return x, y, z

    @property
    def depth(self) -> float:
        """Extent of all the fluid along its gravity [m]; none without any."""
        gravity = self.hydrostatic_gravity
        if not any(gravity):
            return 0.0
        heights = [level for box in self.extents for level in levels(box, gravity)]
        return max(heights) - min(heights)
