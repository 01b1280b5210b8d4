"""What a run of a lattice will need, estimated without building it."""

import math

from quintet.components.particle_dynamics.integrators import LIMIT, damped_step
from quintet.components.particle_dynamics.params import ParticleLatticeParams
from quintet.components.particle_dynamics.potential import (
    force_table,
    highest_frequency,
    seven_roots,
)
from quintet.interfaces.manifest import Plan

RATE = 5e6  # points stepped per second and thread
BYTES = 500.0  # of a point


def plan(params: ParticleLatticeParams) -> Plan:
    """What a run will need."""
    lattice, roots = params.lattice, params.seven_roots
    if roots is not None and roots.top_frequency is not None:
        frequency = 2.0 * math.pi * roots.top_frequency
    else:
        table = params.force_table
        assert table is not None or roots is not None
        law = (
            seven_roots(roots, lattice.spacing, roots.amplitude or 1.0)
            if roots is not None
            else force_table(str(table))
        )
        frequency = highest_frequency(law, lattice.spacing, lattice.mass)
    tether = max((bath.tether for bath in params.baths), default=0.0)
    frequency = math.sqrt(frequency**2 + tether / lattice.mass)
    if params.drive is not None:
        frequency = max(frequency, 2.0 * math.pi * params.drive.frequency)
    step = damped_step(params.damping, lattice.mass, lattice.count, params.integrator)
    if frequency > 0.0:
        step = min(step, params.courant * LIMIT[params.integrator] / frequency)
    return Plan(lattice.count, params.substeps * step, RATE / params.substeps, BYTES)
