"""A conducting body as its parameters describe it: mesh, conductances, what is held."""

import numpy as np

from quintet.components.fe_plate.heat.kernels import Matrix, pattern, write_matrix
from quintet.components.fe_plate.heat.laws import face_shares
from quintet.components.fe_plate.heat.params import FeHeatParams, FixedTemperature
from quintet.components.fe_plate.heat.state import Model, State
from quintet.components.fe_plate.meshes.arrays import Array, Whole
from quintet.components.fe_plate.meshes.mesh import Mesh, chosen, faces_in, incident, mesh
from quintet.components.fe_plate.params import Faces
from quintet.interfaces.errors import SceneError


def build(params: FeHeatParams) -> Model:
    """Build all that never changes."""
    made = mesh(params.parts, 3, params.node_sets)
    nodes = len(made.node)
    begin, at = incident(made.corner, nodes)
    first, column = pattern(made.corner, begin, at)
    matrix = Matrix(first, column, np.empty(len(column)), np.empty(nodes))
    conductivity = np.array([part.conductivity for part in params.parts])[made.part]
    capacity = np.array([part.capacity for part in params.parts])[made.part]
    nodal, volume = np.empty(nodes), np.empty(nodes)
    worst = write_matrix(made.node, made.corner, conductivity, capacity, matrix, nodal, volume)
    if worst >= 0:
        middle = np.array2string(made.node[made.corner[worst]].mean(axis=0), precision=4)
        raise SceneError(
            f"element {worst} at {middle} m must have a volume above 0 at each of its points; it "
            "has not: it is inside out. Turn its corners, or mesh it anew."
        )
    part = np.empty(nodes, np.int64)
    part[made.corner] = made.part[:, None]
    holder = _holders(params, made)
    _require_held(params, part, holder)
    free = (holder < 0).astype(np.float64)
    return Model(made, matrix, nodal, volume, part, free, holder, _sources(params, made))


def _holders(params: FeHeatParams, made: Mesh) -> Whole:
    """Number of what holds each node (n,), -1 of none."""
    found = np.full(len(made.node), -1)
    for number, one in enumerate(params.held):
        rows = _held_by(one, made, f"held.{number}")
        if not rows.any():
            raise SceneError(f"held.{number}: it must hold a node; it holds none. Correct the box.")
        found[rows] = number
    return found


def _held_by(one: FixedTemperature, made: Mesh, where: str) -> Array:
    if one.point is None:
        box = Faces(lowest=one.lowest, highest=one.highest, node_set=one.node_set)
        return np.asarray(chosen(made, box, where))
    nearest = ((made.node - one.point) ** 2).sum(axis=1)
    return np.asarray(np.arange(len(nearest)) == np.argmin(nearest))


def _require_held(params: FeHeatParams, part: Whole, holder: Whole) -> None:
    """Refuse what has no steady temperature."""
    for number in range(len(params.parts)):
        if params.steady and not (holder[part == number] >= 0).any():
            raise SceneError(
                f"parts.{number}: to be steady it must be held at a temperature somewhere; it is "
                "not. Add held, or let it not be steady."
            )


def _sources(params: FeHeatParams, made: Mesh) -> Array:
    """Heat (n,) W of all fluxes at each node."""
    found = np.zeros(len(made.node))
    for number, one in enumerate(params.fluxes):
        faces = faces_in(made, [one.faces], f"fluxes.{number}")
        if not len(faces):
            raise SceneError(
                f"fluxes.{number}: its box must hold an outer face; none is. Correct the box."
            )
        side = made.side[faces]
        np.add.at(found, side, one.flux * face_shares(made.node[side]))
    return found


def initial_state(params: FeHeatParams, model: Model, surface: int) -> State:
    """Temperatures of the parts at the start, and of what is held."""
    temperature = np.array([one.temperature for one in params.parts])[model.part]
    held = np.array([one.temperature for one in params.held], float)
    is_held = model.holder >= 0
    temperature[is_held] = held[model.holder[is_held]]
    judged = np.zeros((len(params.parts), 2))
    return State(temperature, np.zeros(surface), np.zeros(len(held)), np.zeros(1), judged)
