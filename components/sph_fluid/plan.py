"""What a fluid will need: its particles, counted without making them, and time; numpy alone."""

from quintet.components.sph_fluid.boundary.obstacles import count_obstacle_points, from_meshes
from quintet.components.sph_fluid.boundary.walls import count_wall_points
from quintet.components.sph_fluid.params import SphFluidParams
from quintet.components.sph_fluid.setup.mass import region_masses
from quintet.interfaces.manifest import Plan

SERIAL = 0.05  # share of a step that threads do not shorten: `quintet bench` on 1 and 2 threads


def plan(params: SphFluidParams) -> Plan:
    """What a run will need."""
    # One part in ten: how much velocities add to the speed of sound.
    dt = params.courant * params.smoothing_length / (1.1 * params.sound_speed)
    twice = params.integration == "symplectic"  # two passes over longer lists
    listed = (58.0 if twice else 45.0) * params.smoothing**3  # neighbours, with their margin
    rate = 2e6 * 150 / listed * (0.5 if twice else 1.0) * (0.8 if params.mirrored else 1.0)
    return Plan(particles(params), dt, rate, 180 + 4 * listed, serial=SERIAL)


def particles(params: SphFluidParams) -> int:
    """Fluid and wall particles, counted without making any but those from files."""
    regions = region_masses(params.fluid, params.spacing, params.dimensions)
    fluid = sum(region.particles for region in regions)
    still = count_obstacle_points(params) + count_wall_points(params)
    return fluid + still + len(from_meshes(params)[0])
