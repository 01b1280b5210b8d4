"""How many particles a scene asks for, without making them; needs numpy alone."""

import math

from quintet.components.sph_fluid.boundary.obstacles import count_obstacle_points
from quintet.components.sph_fluid.params import SphFluidParams
from quintet.components.sph_fluid.setup.geometry import FACES, Box, closed_faces, tank, wall_layers


def cells(box: Box, params: SphFluidParams) -> tuple[int, int, int]:
    """Whole number of particles along each edge of a box."""
    low, high = box
    x, y, z = (max(1, round((b - a) / params.spacing)) for a, b in zip(low, high, strict=True))
    return (x, y, z) if params.dimensions == 3 else (x, 1, z)


def particles(params: SphFluidParams) -> int:
    """Fluid and wall particles, counted without making any."""
    fluid = sum(math.prod(cells(box, params)) for box in params.fluid)
    fluid += count_obstacle_points(params)
    box = tank(params)
    if box is None:
        return fluid
    inside = cells(box, params)
    outside = [n + sum(shut) for n, shut in zip(inside, layers_beyond(params), strict=True)]
    return fluid + math.prod(outside) - math.prod(inside)


def layers_beyond(params: SphFluidParams) -> list[tuple[int, int]]:
    """Layers of wall particles beyond the lower and the upper face, along each axis."""
    closed, layers = closed_faces(params), wall_layers(params)
    beyond = {face: layers if face in closed else 0 for face in FACES}
    return [(beyond[f"{x}-"], beyond[f"{x}+"]) for x in "xyz"]
