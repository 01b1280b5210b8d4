"""What a scene may say of a weakly compressible fluid."""

import math
from dataclasses import field
from typing import Annotated, Literal, get_args

from pydantic import Field, NonNegativeInt

from quintet.components.sph_fluid.wave import Wave
from quintet.interfaces.params import Fraction, NotNegative, Number, Positive, Vector, parameters

Box = tuple[Vector, Vector]  # lowest and highest corner, m
Spot = tuple[Number, Number]  # x and y, m
Axis = Literal["x", "y", "z"]
Face = Literal["x-", "x+", "y-", "y+", "z-", "z+"]
Upright = Literal["x-", "x+", "y-", "y+"]

Exponent = Annotated[int, Field(ge=1, le=8)]

FACES = get_args(Face)


@parameters
class SphFluidParams:
    """A fluid that fills boxes, in an open tank; SI.

    Edges are cut into round(edge / spacing) cells with a particle in the middle of each; every
    particle has mass density · spacing³. In two dimensions, x and z, all boxes are one slab
    between frictionless planes, a single layer of particles.
    """

    spacing: Positive  # m, between particles
    sound_speed: Positive  # m/s, artificial: ten times the largest velocity
    fluid: tuple[Box, ...]  # m, boxes full of fluid
    dimensions: Literal[2, 3] = 3  # 2: x and z
    walls: Box | None = None  # m, the inside of a tank
    open: tuple[Face, ...] = ("z+",)  # faces that the tank lacks
    symmetry: tuple[Upright, ...] = ()  # faces that are planes of symmetry, without walls
    wall_velocity: dict[Face, Vector] = field(default_factory=dict)  # m/s, of faces like belts
    obstacles: tuple[Box, ...] = ()  # m, boxes that stand still in the tank
    kernel: Literal["cubic", "wendland"] = "cubic"  # Wendland's keeps particles apart and calm
    smoothing: Positive = 1.5  # 1, smoothing length / spacing
    staggered: bool = False  # whether rows along x start moved against each other
    density: Positive = 1000.0  # kg/m3, at no pressure
    gravity: Vector = (0.0, 0.0, -9.81)  # m/s2
    viscosity: NotNegative = 0.1  # 1, α of Monaghan's artificial viscosity
    laminar: NotNegative = 0.0  # m2/s, kinematic viscosity of the fluid itself
    friction: Literal["laplacian", "stress"] = "laplacian"  # how `laminar` acts
    diffusion: NotNegative = 0.0  # 1, δ of Fourtakas' diffusion of density; 0.1 is usual
    damper: NotNegative = 0.0  # 1, ζ of a bulk viscosity ζ h c₀ that damps sound; 1 is much
    grip: Fraction = 1.0  # 1, share of the viscosity that acts between fluid and walls or samples
    boundary: Literal["dbc", "mdbc", "potential"] = "dbc"  # dynamic wall particles, or mirrored
    # ones, or a contact potential in place of their pressure
    potential_stiffness: Positive | None = None  # Pa, K Δpᵈ; else what holds the water's pressure
    potential_exponent: Exponent = 1  # 1, n: how much it steepens towards the wall
    gaps: bool = False  # whether films press in gaps too narrow for particles alone; with mdbc
    roughness: Positive = 5e-4  # m, least width that a film has between faces that touch
    standoff: Positive = 0.5  # 1, spacings from a wall's face out to its particles
    inset: NotNegative = 0.5  # 1, spacings from a moving surface in to its outermost samples
    tension: bool = False  # whether pressure may fall below zero
    xsph: Fraction = 0.0  # 1, ε: how far particles move with their neighbours' mean velocity
    shepard_every: NonNegativeInt = 0  # steps between two Shepard filters of the density; 0: none
    precision: Literal["float64", "float32"] = "float64"  # in which pairs are computed
    integration: Literal["extrapolated", "symplectic"] = "extrapolated"  # one pass over pairs in a
    # step, or two and second order
    courant: Positive = 0.2  # 1, step / (time that sound takes through a smoothing length)
    wave: Wave | None = None  # standing on the fluid at the start
    pressure_gauges: tuple[Vector, ...] = ()  # m, points whose pressure is given
    level_gauges: tuple[Spot, ...] = ()  # m, x and y above which the surface's height is given
    front: Axis | None = None  # along which the furthest fluid is given
    motion_gauge: bool = False  # whether largest speed, energies, centre of mass are given

    def __post_init__(self) -> None:
        """Check what concerns several values at once."""
        if not self.fluid:
            raise ValueError("fluid must have at least one box; found none. Add a box.")
        if not 1.0 <= self.smoothing <= 3.0:
            raise ValueError(
                f"smoothing must be from 1 to 3 spacings; found {self.smoothing}. Use 1.2 to 2."
            )
        self._check_boxes()
        self._check_walls()
        self._check_obstacles()
        self._check_sound()
        self._check_slab()
        self._check_symmetry()
        if self.mirrored and (self.standoff, self.inset) != (0.5, 0.5):
            raise ValueError(
                "boundary mdbc puts its particles half a spacing behind the face; found standoff "
                f"{self.standoff} and inset {self.inset}. Remove them, or use dbc."
            )
        if self.damper > 0.0 and self.integration != "symplectic":
            raise ValueError(
                "damper needs integration symplectic, whose step limit with it is known; found "
                f"damper {self.damper} and integration {self.integration}. Set integration, or "
                "remove damper."
            )
        if self.potential_stiffness is not None and self.boundary == "dbc":
            raise ValueError(
                "potential_stiffness belongs to boundary potential, or mdbc with links that choose "
                f"it; found {self.boundary}. Remove it, or set boundary."
            )
        if self.wave is not None:
            self.wave.check(self.fluid, self.gravity)

    def _check_boxes(self) -> None:
        for number, box in enumerate(self.fluid):
            _check_corners(f"fluid[{number}]", box, self.spacing)
            for other, earlier in enumerate(self.fluid[:number]):
                if _overlap(box, earlier, 1e-6 * self.spacing):
                    raise ValueError(
                        f"fluid[{number}] must not overlap fluid[{other}]; found {box} and "
                        f"{earlier}. Cut one of them."
                    )

    def _check_walls(self) -> None:
        if self.walls is None:
            return
        _check_corners("walls", self.walls, self.spacing)
        low, high = self.walls
        room = 1e-6 * self.spacing
        for number, box in enumerate(self.fluid):
            for axis, name in enumerate("xyz"):
                below = box[0][axis] < low[axis] - room and f"{name}-" not in self.open
                above = box[1][axis] > high[axis] + room and f"{name}+" not in self.open
                if below or above:
                    raise ValueError(
                        f"fluid[{number}] must be inside the walls along {name}, "
                        f"{low[axis]} to {high[axis]} m; found {box[0][axis]} to "
                        f"{box[1][axis]} m. Move the box, or add the face to open."
                    )

        for face, velocity in self.wall_velocity.items():
            if face not in self.shut or velocity["xyz".index(face[0])] != 0.0:
                raise ValueError(
                    f"wall_velocity.{face} must lie in a face that the tank has, "
                    f"{', '.join(self.shut)}; found {velocity} m/s. Shut the face, or leave its "
                    f"{face[0]} 0."
                )
        if self.gaps and not self.mirrored:
            raise ValueError(
                "gaps needs boundary mdbc, whose samples know the pressure at a gap's rim; found "
                f"{self.boundary}. Set boundary, or leave gaps out."
            )

    def _check_slab(self) -> None:
        boxes = [*self.fluid, *([] if self.walls is None else [self.walls])]
        sides = {(low[1], high[1]) for low, high in boxes}
        if self.dimensions == 2 and (len(sides) > 1 or self.gravity[1] != 0.0):
            raise ValueError(
                "in two dimensions, x and z, all boxes must reach over the same y, and gravity has "
                f"no y; found y from {sorted(sides)} and gravity {self.gravity}. Correct them, or "
                "set dimensions to 3."
            )

    def _check_symmetry(self) -> None:
        for face in self.symmetry:
            axis, name = "xyz".index(face[0]), f"symmetry: {face}"
            if self.walls is None or face in self.open:
                raise ValueError(
                    f"{name} must be a face of the tank; found walls {self.walls} and open "
                    f"{self.open}. Give walls, or take the face out of one of the two."
                )
            if self.dimensions == 2 and face[0] == "y":
                raise ValueError(
                    f"{name} must be x- or x+ in two dimensions, where both sides along y are "
                    "planes already. Remove it."
                )
            if self.gravity[axis] != 0.0:
                raise ValueError(
                    f"{name} must have gravity in its plane; found {self.gravity} m/s2. Turn "
                    "gravity, or make the face a wall."
                )
            low, high = self.walls[0][axis], self.walls[1][axis]
            both = {f"{face[0]}-", f"{face[0]}+"} <= set(self.symmetry)
            if both and high - low < (least := 3.0 * self.length):
                # What is behind one plane would be mirrored in the other.
                raise ValueError(
                    f"{name} must be {least:g} m or more, 3 smoothing lengths, from the opposite "
                    f"plane; found {high - low:g} m. Widen the tank, or refine the spacing."
                )
            for number, box in enumerate(self.obstacles):
                if min(box[0][axis] - low, high - box[1][axis]) < -1e-6 * self.spacing:
                    raise ValueError(
                        f"{name}, {face[0]} from {low:g} to {high:g} m, must not cut "
                        f"obstacles[{number}]; found {box}. Cut the box there."
                    )
        if self.symmetry and self.gaps:
            raise ValueError(
                f"gaps knows no planes of symmetry; found gaps and symmetry {self.symmetry}. "
                "Leave one out."
            )

    @property
    def thickness(self) -> float:
        """Of the slab [m] that a particle's mass is counted over; 1 in three dimensions."""
        low, high = self.fluid[0]
        return high[1] - low[1] if self.dimensions == 2 else 1.0

    @property
    def shut(self) -> tuple[Face, ...]:
        """Faces at which the tank has wall particles."""
        sides = ("y-", "y+") if self.dimensions == 2 else ()
        return tuple(face for face in FACES if face not in (*self.open, *self.symmetry, *sides))

    @property
    def mirrored(self) -> bool:
        """Whether walls take their density from mirror points."""
        return self.boundary == "mdbc"

    @property
    def layers(self) -> int:
        """Layers of wall particles: one that repels, or as many as a kernel meets."""
        return 1 if self.boundary == "dbc" else math.ceil(2.0 * self.smoothing)

    def _check_obstacles(self) -> None:
        least = 2.0 * self.standoff * self.spacing
        for number, box in enumerate(self.obstacles):
            name = f"obstacles[{number}]"
            _check_corners(name, box, self.spacing)
            if (width := min(b - a for a, b in zip(*box, strict=True))) < least:
                raise ValueError(
                    f"{name} must be at least {least:g} m across, twice the standoff; found "
                    f"{width:g} m. Refine the spacing, or lower standoff."
                )
            for other, water in enumerate(self.fluid):
                if _overlap(box, water, 1e-6 * self.spacing):
                    raise ValueError(
                        f"{name} must not overlap fluid[{other}]; found {box} and {water}. "
                        "Cut the fluid."
                    )

    @property
    def tank(self) -> Box | None:
        """Box around the tank on whose outside, half a cell off, the wall particles lie."""
        if self.walls is None:
            return None
        (x, y, z), (u, v, w) = self.walls
        out = {face: (self.standoff - 0.5) * self.spacing for face in self.shut}
        return (
            (x - out.get("x-", 0.0), y - out.get("y-", 0.0), z - out.get("z-", 0.0)),
            (u + out.get("x+", 0.0), v + out.get("y+", 0.0), w + out.get("z+", 0.0)),
        )

    def _check_sound(self) -> None:
        needed = 10.0 * math.sqrt(math.hypot(*self.weight) * self.depth)
        if self.sound_speed < needed:
            raise ValueError(
                f"sound_speed must be at least 10 sqrt(g depth) = {needed:.4g} m/s for the fluid's "
                f"depth of {self.depth:.4g} m; found {self.sound_speed}. Raise it; twice that "
                "suits a dam break."
            )

    @property
    def length(self) -> float:
        """Smoothing length [m]."""
        return self.smoothing * self.spacing

    @property
    def depth(self) -> float:
        """Extent of all the fluid along its weight [m]; none without any."""
        if not any(self.weight):
            return 0.0
        levels = [level for box in self.fluid for level in self.levels(box)]
        return max(levels) - min(levels)

    @property
    def weight(self) -> Vector:
        """Gravity [m/s2], but none along axes on which the tank is open below: fluid falls."""
        if self.walls is None:
            return self.gravity
        below = [
            f"{axis}{'+' if g > 0.0 else '-'}" for axis, g in zip("xyz", self.gravity, strict=True)
        ]
        x, y, z = (
            g if face in self.shut else 0.0 for face, g in zip(below, self.gravity, strict=True)
        )
        return x, y, z

    def levels(self, box: Box) -> tuple[float, float]:
        """Lowest and highest level of a box, measured against its weight [m]."""
        size = math.hypot(*self.weight) or 1.0
        pairs = [(-low * g, -high * g) for low, high, g in zip(*box, self.weight, strict=True)]
        return sum(map(min, pairs)) / size, sum(map(max, pairs)) / size


def _check_corners(name: str, box: Box, spacing: float) -> None:
    low, high = box
    if any(b - a < 0.5 * spacing for a, b in zip(low, high, strict=True)):
        raise ValueError(
            f"{name} must go from its lowest to its highest corner, half a spacing or more along "
            f"each axis; found {low} to {high} m. Exchange the corners, or widen it."
        )


def _overlap(one: Box, other: Box, room: float) -> bool:
    return all(
        min(one[1][axis], other[1][axis]) - max(one[0][axis], other[0][axis]) > room
        for axis in range(3)
    )
