"""What a run of conduction will need, estimated without building it."""

import math
from collections.abc import Iterator

from quintet.components.fe_plate.heat.params import FeHeatParams
from quintet.components.fe_plate.meshes.params import mesh_notes
from quintet.components.fe_plate.meshes.set_names import Place, refuse_unknown_sets
from quintet.interfaces.manifest import Plan

RATE = 2e5  # elements stepped per second and thread
BYTES = 700.0  # of an element


def plan(params: FeHeatParams) -> Plan:
    """What a run will need."""
    notes = mesh_notes(params.parts)
    refuse_unknown_sets(params.parts, params.node_sets, _selections(params))
    count = sum(part.count for part in params.parts)
    return Plan(count, params.longest_step or math.inf, RATE, BYTES, notes=notes)


def _selections(params: FeHeatParams) -> Iterator[Place]:
    """Yield all that chooses nodes or faces of the mesh."""
    held = params.fixed_temperatures
    yield from ((f"fixed_temperatures.{n}", fixed) for n, fixed in enumerate(held))
    yield from ((f"coupled_faces.{n}", faces) for n, faces in enumerate(params.coupled_faces))
    yield from ((f"fluxes.{n}.faces", flux.faces) for n, flux in enumerate(params.fluxes))
