"""What a run of a structure will need: elements, step and time, estimated without building it."""

from collections.abc import Iterator

from quintet.components.fe_plate.meshes.params import mesh_notes
from quintet.components.fe_plate.meshes.selections import Faces
from quintet.components.fe_plate.meshes.set_names import Place, refuse_unknown_sets
from quintet.components.fe_plate.params import FePlateParams
from quintet.components.fe_plate.points import integration_notes, points_of
from quintet.interfaces.manifest import Plan

RATE = 5e6  # elements stepped per second and thread
BYTES = 1000.0  # of an element


def plan(params: FePlateParams) -> Plan:
    """What a run will need."""
    notes = mesh_notes(params.parts)
    refuse_unknown_sets(params.parts, params.node_sets, _selections(params))
    count = sum(part.count for part in params.parts)
    points = points_of(params)
    return Plan(
        count,
        min(part.expected_step for part in params.parts),
        RATE / points,
        BYTES * points,
        notes=(*notes, *integration_notes(params)),
    )


def _selections(params: FePlateParams) -> Iterator[Place]:
    """Yield all that chooses nodes or elements of the mesh."""
    gauges = params.gauges
    yield from ((f"fixed.{n}", fixed) for n, fixed in enumerate(params.fixed))
    yield from ((f"coupled_faces.{n}", faces) for n, faces in enumerate(params.coupled_faces))
    yield from ((f"pressures.{n}.faces", load.faces) for n, load in enumerate(params.pressures))
    for n, name in enumerate(gauges.node_set_gauges):
        yield f"gauges.node_set_gauges.{n}", Faces(node_set=name)
    for n, elements in enumerate(gauges.element_set_gauges):
        yield f"gauges.element_set_gauges.{n}", elements
