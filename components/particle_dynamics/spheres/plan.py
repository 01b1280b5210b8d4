"""What a run of spheres will need, estimated without building it."""

import math

from quintet.components.particle_dynamics.spheres.params import ParticleSpheresParams
from quintet.interfaces.manifest import Plan

RATE = 5e6  # spheres stepped per second and thread
BYTES = 500.0  # of a sphere


def plan(params: ParticleSpheresParams) -> Plan:
    """What a run will need."""
    count = sum(sphere.count for sphere in params.spheres)
    return Plan(count, params.longest_step or math.inf, RATE, BYTES)
