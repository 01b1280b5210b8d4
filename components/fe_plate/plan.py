"""What a run of a structure will need: elements, step and time, estimated without building it."""

from quintet.components.fe_plate.meshes.params import mesh_notes
from quintet.components.fe_plate.params import FePlateParams
from quintet.components.fe_plate.points import integration_notes, points_of
from quintet.interfaces.manifest import Plan

RATE = 5e6  # elements stepped per second and thread
BYTES = 1000.0  # of an element


def plan(params: FePlateParams) -> Plan:
    """What a run will need."""
    count = sum(part.count for part in params.parts)
    points = points_of(params)
    return Plan(
        count,
        min(part.expected_step for part in params.parts),
        RATE / points,
        BYTES * points,
        notes=(*mesh_notes(params.parts), *integration_notes(params)),
    )
