"""What follows from a fluid's parameters: the tank's closed faces, depth, gravity at rest."""

import math
from typing import TYPE_CHECKING, Annotated, Literal, get_args

from pydantic import Field

from quintet.components.shared.geometry.box_faces import box
from quintet.components.shared.geometry.shapes import Bounds
from quintet.interfaces.component import Array
from quintet.interfaces.params import Number, Vector

if TYPE_CHECKING:
    from quintet.components.sph_fluid.params import SphFluidParams
    from quintet.components.sph_fluid.setup.shapes import FluidRegion

Box = Bounds
Spot = tuple[Number, Number]  # x and y, m
Axis = Literal["x", "y", "z"]
Face = Literal["x-", "x+", "y-", "y+", "z-", "z+"]
UprightFace = Literal["x-", "x+", "y-", "y+"]
Exponent = Annotated[int, Field(ge=1, le=8)]
Smoothing = Annotated[float, Field(ge=1.0, le=3.0)]

FACES = get_args(Face)


def cells(box: Box, params: "SphFluidParams") -> tuple[int, int, int]:
    """Whole number of particles along each edge of a box."""
    low, high = box
    x, y, z = (max(1, round((b - a) / params.spacing)) for a, b in zip(low, high, strict=True))
    return (x, y, z) if params.dimensions == 3 else (x, 1, z)


def fluid_boxes(params: "SphFluidParams") -> tuple[Box, ...]:
    """Boxes of fluid, and those around its other shapes."""
    return *params.boxes, *(shape.bounds for shape in params.shapes)


def named_boxes(params: "SphFluidParams") -> list[tuple[str, Box]]:
    """Boxes of fluid by their names in a scene."""
    named = enumerate(params.fluid)
    return [(f"fluid[{k}]", region.bounds) for k, region in named if region.shape == "box"]


def named_shapes(params: "SphFluidParams") -> "list[tuple[str, FluidRegion]]":
    """Fluid in other shapes by its names in a scene."""
    named = enumerate(params.fluid)
    return [(f"fluid[{k}]", region) for k, region in named if region.shape != "box"]


def closed_faces(params: "SphFluidParams") -> tuple[Face, ...]:
    """Faces at which the tank has wall particles."""
    edge = params.boundary
    sides = ("y-", "y+") if params.dimensions == 2 else ()
    return tuple(face for face in FACES if face not in (*edge.open_faces, *edge.symmetry, *sides))


def wall_layers(params: "SphFluidParams") -> int:
    """Layers of wall particles: one that repels, or as many as a kernel meets."""
    return 1 if params.boundary.method == "dbc" else math.ceil(2.0 * params.smoothing)


def tank(params: "SphFluidParams") -> Box | None:
    """Box around the tank on whose outside, half a cell off, the wall particles lie."""
    if params.boundary.tank is None:
        return None
    (x, y, z), (u, v, w) = params.boundary.tank
    beyond = (params.boundary.wall_offset - 0.5) * params.spacing
    out = dict.fromkeys(closed_faces(params), beyond)
    return (
        (x - out.get("x-", 0.0), y - out.get("y-", 0.0), z - out.get("z-", 0.0)),
        (u + out.get("x+", 0.0), v + out.get("y+", 0.0), w + out.get("z+", 0.0)),
    )


def wall_faces(params: "SphFluidParams") -> list[Array]:
    """Corners (4, 3) m of each closed face of the tank, and of each face of the obstacles."""
    edge = params.boundary
    found = box(*edge.tank, closed_faces(params)) if edge.tank else []
    sides = [face for face in FACES if params.dimensions == 3 or face[0] != "y"]
    return found + [face for one in edge.solids for face in box(*one, sides)]


def slab_thickness(params: "SphFluidParams") -> float:
    """Of the slab [m] that a particle's mass is counted over; 1 in three dimensions."""
    low, high = fluid_boxes(params)[0]
    return high[1] - low[1] if params.dimensions == 2 else 1.0


def hydrostatic_gravity(params: "SphFluidParams") -> Vector:
    """Gravity [m/s2], but none along axes on which the tank is open below: fluid falls."""
    if params.boundary.tank is None:
        return params.gravity
    pairs = zip("xyz", params.gravity, strict=True)
    below = [f"{axis}{'+' if g > 0.0 else '-'}" for axis, g in pairs]
    closed = closed_faces(params)
    x, y, z = (g if face in closed else 0.0 for face, g in zip(below, params.gravity, strict=True))
    return x, y, z


def levels(box: Box, gravity: Vector) -> tuple[float, float]:
    """Lowest and highest level [m] of a box, measured against gravity [m/s2]."""
    size = math.hypot(*gravity) or 1.0
    pairs = [(-low * g, -high * g) for low, high, g in zip(*box, gravity, strict=True)]
    return sum(map(min, pairs)) / size, sum(map(max, pairs)) / size


def depth(params: "SphFluidParams") -> float:
    """Extent of all the fluid along its gravity [m]; none without any."""
    gravity = hydrostatic_gravity(params)
    if not any(gravity):
        return 0.0
    found = [level for box in fluid_boxes(params) for level in levels(box, gravity)]
    return max(found) - min(found)
