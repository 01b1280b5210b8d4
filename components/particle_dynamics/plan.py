"""What a run of points will need, estimated without making them."""

import math

from quintet.components.particle_dynamics.params import ParticleDynamicsParams
from quintet.components.particle_dynamics.potential import (
    force_table,
    highest_frequency,
    seven_roots,
)
from quintet.interfaces.manifest import Plan

RATE = 5e6  # points stepped per second and thread
BYTES = 500.0  # of a point
# Greatest stable step times the highest frequency; of Yoshida's (Phys. Lett. A 150 (1990) 262)
# where an oscillator's step matrix has a trace of -2.
LIMIT = {"velocity_verlet": 2.0, "yoshida": 1.5734}


def plan(params: ParticleDynamicsParams) -> Plan:
    """What a run will need."""
    lattice, given = params.lattice, params.seven_roots
    if lattice is None:
        count = sum(one.count for one in params.spheres)
        return Plan(count, params.longest_step or math.inf, RATE, BYTES)
    if given is not None and given.top_frequency is not None:
        frequency = 2.0 * math.pi * given.top_frequency
    else:
        table = params.force_table
        assert table is not None or given is not None
        law = (
            seven_roots(given, lattice.spacing, given.amplitude or 1.0)
            if given is not None
            else force_table(str(table))
        )
        frequency = highest_frequency(law, lattice.spacing, lattice.mass)
    tether = max((one.tether for one in params.baths), default=0.0)
    frequency = math.sqrt(frequency**2 + tether / lattice.mass)
    share = params.courant * params.steps_at_once
    step = share * LIMIT[params.integrator] / frequency if frequency > 0.0 else math.inf
    return Plan(lattice.count, step, RATE / params.steps_at_once, BYTES)
