"""What a run of spheres will need, estimated without building it."""

import math

from quintet.components.particle_dynamics.integrators import LIMIT
from quintet.components.particle_dynamics.spheres.params import ParticleSpheresParams, Sphere
from quintet.interfaces.manifest import Plan

RATE = 5e6  # spheres stepped per second and thread
BYTES = 500.0  # of a sphere


def plan(params: ParticleSpheresParams) -> Plan:
    """What a run will need."""
    count = sum(sphere.count for sphere in params.spheres)
    square = max(sphere.tether / mass(sphere) for sphere in params.spheres)  # 1/s2
    step = params.longest_step or math.inf
    if square > 0.0:
        step = min(step, params.courant * LIMIT[params.integrator] / math.sqrt(square))
    return Plan(count, step, RATE, BYTES)


def mass(sphere: Sphere) -> float:
    """Mass [kg] of a sphere, or of all in a parcel."""
    return sphere.parcel * sphere.density * 4.0 / 3.0 * math.pi * sphere.radius**3
