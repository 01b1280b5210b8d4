"""Arrays of a conducting body: the matrix, fixed nodes, and temperatures."""

from typing import NamedTuple

from quintet.components.fe_plate.meshes.arrays import Array, Whole
from quintet.components.fe_plate.meshes.mesh import Mesh


class Matrix(NamedTuple):
    """Conductances between nodes, row by row, columns in rising order."""

    first: Whole  # (n + 1,) entries of row i: first[i] ... first[i + 1] - 1
    column: Array  # (entries,) 4-byte whole numbers
    value: Array  # (entries,) W/K, negative between nodes that conduct to each other
    diagonal: Array  # (n,) W/K


class Model(NamedTuple):
    """What never changes; n nodes, p parts."""

    mesh: Mesh
    conductance: Matrix
    capacity: Array  # (n,) J/K
    volume: Array  # (n,) m3, that a node stands for
    part: Whole  # (n,)
    free: Array  # (n,) 1, or 0 of nodes that are held
    holder: Whole  # (n,) number of what holds a node, -1 of none
    source: Array  # (n,) W, of fluxes


class State(NamedTuple):
    """What changes."""

    temperature: Array  # (n,) K
    start: Array  # (n,) K, as the run began
    heat: Array  # (nodes of the surface,) W, of partners
    held: Array  # (h,) W, mean flow of the last step from what holds nodes into the body
    outside: Array  # (1,) J, heat of fluxes and of what holds nodes since the start
    judged: Array  # (p, 2) K, 1: largest change of temperature; longest step that was too long
