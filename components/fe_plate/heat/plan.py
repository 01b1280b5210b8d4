"""What a run of conduction will need, estimated without building it."""

import math

from quintet.components.fe_plate.heat.params import FeHeatParams
from quintet.components.fe_plate.meshes.params import mesh_notes
from quintet.interfaces.manifest import Plan

RATE = 2e5  # elements stepped per second and thread
BYTES = 700.0  # of an element


def plan(params: FeHeatParams) -> Plan:
    """What a run will need."""
    count = sum(part.count for part in params.parts)
    notes = mesh_notes(params.parts)
    return Plan(count, params.longest_step or math.inf, RATE, BYTES, notes=notes)
