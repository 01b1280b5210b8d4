"""What a run of bodies of particles will need: their number, step and time, before any is made."""

from quintet.components.sph_solid.params import SphSolidParams
from quintet.interfaces.manifest import Plan

RATE = 8e5  # particles stepped per second and thread
BYTES = 1500.0  # of a particle


def plan(params: SphSolidParams) -> Plan:
    """What a run will need."""
    return Plan(params.expected_count, params.expected_step, RATE, BYTES)
