"""A mesh as it stands in a file, in the shape in which meshio returns one, with more beside."""

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np

from quintet.components.fe_plate.meshes.arrays import Array, Whole
from quintet.components.fe_plate.meshes.tetrahedra import raised
from quintet.interfaces.errors import SceneError
from quintet.interfaces.params import unknown

HEXAHEDRON, TETRAHEDRON, FOUR_NODES = "hexahedron", "tetra10", "tetra"
SOLIDS = (HEXAHEDRON, TETRAHEDRON, FOUR_NODES)  # kinds that are read
RINGS = {"triangle": [(0, 1), (1, 2), (2, 0)], "line": [(0, 1)]}  # edges of faces and lines


class Cells(NamedTuple):
    """Elements of one kind."""

    type: str
    dim: int
    data: Whole  # (e, c) corners


def _accept(rows: Whole) -> None:
    """Accept all solids."""


class Source(NamedTuple):
    """Points, cells and sets; of sets of cells the rows in each block of cells, or None."""

    points: Array  # (p, 3)
    cells: Sequence[Cells]
    point_sets: dict[str, Whole]
    cell_sets: dict[str, list[Whole | None]]
    velocity: Array | None = None  # (p, 3) in units of the file
    notes: tuple[str, ...] = ()
    foreign: dict[str, int] = {}  # noqa: RUF012, never written; blocks of other elements, unread
    check: Callable[[Whole], None] = _accept  # of hexahedra by their rows; raises SceneError


def as_source(mesh: Any) -> Source:
    """Return what meshio has read."""
    raw = np.asarray(mesh.points, np.float64)
    points = np.zeros((len(raw), 3))
    points[:, : raw.shape[1]] = raw
    cells = [Cells(block.type, block.dim, np.asarray(block.data, np.int64)) for block in mesh.cells]
    # "gmsh:bounding_entities" lists entities of the geometry, not rows of cells.
    cell_sets = {key: rows for key, rows in mesh.cell_sets.items() if not key.startswith("gmsh:")}
    # Gmsh 2.2 has a number of each cell in place of sets, and names of the numbers.
    if (numbers := mesh.cell_data.get("gmsh:physical")) is not None:
        for key, (tag, dim) in mesh.field_data.items():
            pairs = zip(mesh.cells, numbers, strict=True)
            rows = [np.flatnonzero((tags == tag) & (block.dim == dim)) for block, tags in pairs]
            cell_sets.setdefault(key, rows)
    return Source(points, cells, dict(mesh.point_sets), cell_sets)


def of_parts(name: str, source: Source, parts: Sequence[int | str]) -> Source:
    """Keep only the cells of the named parts, and the faces and edges on them.

    Sets keep those of their cells that are left.

    Parameters
    ----------
    name
        Of the file.
    source
    parts
        Numbers of LS-DYNA parts, or names of sets of cells.
    """
    chosen = [np.zeros(len(block.data), bool) for block in source.cells]
    for part in parts:
        key = f"part {part}" if f"part {part}" in source.cell_sets else str(part)
        if key not in source.cell_sets:
            raise SceneError(unknown(f"file {name}: part {part}", str(part), source.cell_sets))
        for flags, rows in zip(chosen, source.cell_sets[key], strict=True):
            if rows is not None:
                flags[rows] = True
    for block, flags in zip(source.cells, chosen, strict=True):
        if block.type == HEXAHEDRON:
            source.check(np.flatnonzero(flags))
    solids = [
        block.data[flags].ravel()
        for block, flags in zip(source.cells, chosen, strict=True)
        if block.dim == 3
    ]
    has_solid = np.zeros(len(source.points), bool)
    has_solid[np.concatenate([*solids, np.zeros(0, np.int64)])] = True
    for block, flags in zip(source.cells, chosen, strict=True):
        if block.dim < 3:
            flags |= has_solid[block.data].all(axis=1)
    cells = [
        block._replace(data=block.data[flags])
        for block, flags in zip(source.cells, chosen, strict=True)
    ]
    sets: dict[str, list[Whole | None]] = {}
    for key, blocks in source.cell_sets.items():
        pairs = zip(blocks, chosen, strict=True)
        sets[key] = [None if rows is None else _kept(rows, flags) for rows, flags in pairs]
    whole = sum(len(block.data) for block in source.cells)
    left = whole - sum(len(block.data) for block in cells)
    note = f"mesh {name}: {left} elements of other parts are left out."
    return source._replace(cells=cells, cell_sets=sets, notes=(*source.notes, note), foreign={})


def _kept(rows: Whole, flags: np.ndarray) -> Whole:
    """New numbers of those rows that are kept."""
    numbers = np.cumsum(flags) - 1
    rows = np.asarray(rows, np.int64)
    return np.asarray(numbers[rows[flags[rows]]], np.int64)


def with_midside_nodes(name: str, source: Source) -> Source:
    """Make tetrahedra of ten nodes from those of four.

    A new node belongs to the sets of nodes that both ends of its edge belong to, and to the faces
    and lines in whose edges it stands; it has the mean velocity of the ends.
    """
    at = [number for number, block in enumerate(source.cells) if block.type == FOUR_NODES]
    corner = np.concatenate([source.cells[number].data for number in at])
    points, nodes, ends = raised(source.points, corner)
    cells, first = list(source.cells), 0
    for number in at:
        count = len(cells[number].data)
        cells[number] = Cells(TETRAHEDRON, 3, nodes[first : first + count])
        first += count
    for number, block in enumerate(cells):
        if block.type in RINGS:  # the type stays, as notes count what the file has
            cells[number] = block._replace(data=_with_middles(block, ends, len(source.points)))
    sets = {}
    for key, members in source.point_sets.items():
        rows = np.unique(np.asarray(members, np.int64))
        both = np.isin(ends, rows).all(axis=1)
        sets[key] = np.append(rows, len(source.points) + np.flatnonzero(both))
    velocity = source.velocity
    if velocity is not None:
        velocity = np.concatenate([velocity, velocity[ends].mean(axis=1)])
    note = (
        f"mesh {name}: {len(corner)} tetrahedra of four nodes got {len(ends)} more in the middles "
        "of their edges; curved surfaces stay as they were cut. A new node is in the sets that "
        "both ends of its edge are in."
    )
    return source._replace(
        points=points, cells=cells, point_sets=sets, velocity=velocity, notes=(*source.notes, note)
    )


def _with_middles(block: Cells, ends: Whole, points: int) -> Whole:
    """Nodes of triangles or lines, and behind them the new ones in the middles of their edges.

    The nodes `points` and above stand in the middles of the edges `ends` (m, 2), in rising order.
    An edge of no solid has no new node; its first end stands there again.
    """
    pairs = np.sort(block.data[:, RINGS[block.type]], axis=2)  # (f, edges, 2)
    keys, wanted = (rows[..., 0] * points + rows[..., 1] for rows in (ends, pairs))
    at = np.minimum(np.searchsorted(keys, wanted), len(keys) - 1)
    middles = np.where(keys[at] == wanted, points + at, pairs[..., 0])
    return np.concatenate([block.data, middles], axis=1)
