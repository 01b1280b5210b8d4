"""What a fluid will need: its particles, counted without making them, and time; numpy alone."""

import math

from quintet.components.sph_fluid.boundary.obstacles import count_obstacle_points
from quintet.components.sph_fluid.params import SphFluidParams
from quintet.components.sph_fluid.setup.geometry import (
    FACES,
    cells,
    closed_faces,
    tank,
    wall_layers,
)
from quintet.components.sph_fluid.setup.mass import regions
from quintet.interfaces.manifest import Plan


def plan(params: SphFluidParams) -> Plan:
    """What a run will need."""
    # One part in ten: how much velocities add to the speed of sound.
    dt = params.courant * params.smoothing_length / (1.1 * params.sound_speed)
    twice = params.integration == "symplectic"  # two passes over longer lists
    listed = (58.0 if twice else 45.0) * params.smoothing**3  # neighbours, with their margin
    rate = 2e6 * 150 / listed * (0.5 if twice else 1.0) * (0.8 if params.mirrored else 1.0)
    return Plan(particles(params), dt, rate=rate, bytes_per_item=180 + 4 * listed)


def particles(params: SphFluidParams) -> int:
    """Fluid and wall particles, counted without making any."""
    fluid = sum(region.particles for region in regions(params))
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
