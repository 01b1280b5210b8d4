"""A conducting body as its parameters describe it: mesh, conductances, fixed temperatures."""

import numpy as np
from numpy.typing import NDArray

from quintet.components.fe_plate.heat.kernels import pattern, write_matrix
from quintet.components.fe_plate.heat.laws import face_shares
from quintet.components.fe_plate.heat.params import FeHeatParams, FixedTemperature
from quintet.components.fe_plate.heat.state import Matrix, Model, State
from quintet.components.fe_plate.meshes.arrays import Array, Whole
from quintet.components.fe_plate.meshes.mesh import Mesh, chosen, faces_in, incident, mesh
from quintet.components.shared.search.nearest import nearest_rows
from quintet.interfaces.errors import SceneError


def build(params: FeHeatParams) -> Model:
    """Build all that never changes."""
    grid = mesh(params.parts, 3, params.node_sets)
    nodes = len(grid.node)
    begin, at = incident(grid.corner, nodes)
    first, column = pattern(grid.corner, begin, at)
    matrix = Matrix(first, column, np.empty(len(column)), np.empty(nodes))
    conductivity = np.array([part.conductivity for part in params.parts])[grid.part]
    capacity = np.array([part.capacity for part in params.parts])[grid.part]
    nodal, volume = np.empty(nodes), np.empty(nodes)
    worst = write_matrix(grid.node, grid.corner, conductivity, capacity, matrix, nodal, volume)
    if worst >= 0:
        middle = np.array2string(grid.node[grid.corner[worst]].mean(axis=0), precision=4)
        raise SceneError(
            f"element {worst} at {middle} m must have a volume above 0 at each of its points; it "
            "has not: it is inside out. Turn its corners, or mesh it again."
        )
    part = np.empty(nodes, np.int64)
    part[grid.corner] = grid.part[:, None]
    holder = _holders(params, grid)
    _require_held(params, part, holder)
    free = (holder < 0).astype(np.float64)
    return Model(grid, matrix, nodal, volume, part, free, holder, _sources(params, grid))


def _holders(params: FeHeatParams, grid: Mesh) -> Whole:
    """Number of what holds each node (n,), -1 of none."""
    holder = np.full(len(grid.node), -1)
    for number, fixed in enumerate(params.fixed_temperatures):
        rows = _held_by(fixed, grid, f"fixed_temperatures.{number}")
        if not rows.any():
            raise SceneError(
                f"fixed_temperatures.{number}: it must hold a node; it holds none. {fixed.cure}"
            )
        holder[rows] = number
    return holder


def _held_by(fixed: FixedTemperature, grid: Mesh, where: str) -> NDArray[np.bool_]:
    if fixed.point is None:
        return chosen(grid, fixed, where)
    return np.asarray(np.arange(len(grid.node)) == nearest_rows(grid.node, [fixed.point]))


def _require_held(params: FeHeatParams, part: Whole, holder: Whole) -> None:
    """Refuse what has no steady temperature."""
    for number in range(len(params.parts)):
        if params.steady and not (holder[part == number] >= 0).any():
            raise SceneError(
                f"parts.{number}: a steady part needs a fixed temperature somewhere; it has "
                "none. Add fixed_temperatures, or leave out steady."
            )


def _sources(params: FeHeatParams, grid: Mesh) -> Array:
    """Heat (n,) W of all fluxes at each node."""
    sources = np.zeros(len(grid.node))
    for number, entry in enumerate(params.fluxes):
        faces = faces_in(grid, [entry.faces], f"fluxes.{number}")
        if not len(faces):
            raise SceneError(
                f"fluxes.{number}: it must hold an outer face; it holds none. {entry.faces.cure}"
            )
        side = grid.side[faces]
        np.add.at(sources, side, entry.flux * face_shares(grid.node[side]))
    return sources


def initial_state(params: FeHeatParams, model: Model, surface: int) -> State:
    """Temperatures of the parts at the start, and fixed ones."""
    temperature = np.array([part.temperature for part in params.parts])[model.part]
    hold(params, model, temperature)
    judged = np.zeros((len(params.parts), 2))
    start = temperature.copy()
    held = np.zeros(len(params.fixed_temperatures))
    return State(temperature, start, np.zeros(surface), held, np.zeros(1), judged)


def hold(params: FeHeatParams, model: Model, temperature: Array) -> None:
    """Write the fixed ones into the temperatures (n,) K."""
    held = np.array([fixed.temperature for fixed in params.fixed_temperatures], float)
    is_held = model.holder >= 0
    temperature[is_held] = held[model.holder[is_held]]
