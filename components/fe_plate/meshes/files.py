"""Meshes of solids from files: of LS-DYNA, or in any format that meshio reads.

Nothing is imported unless a scene names a file.
"""

from collections import Counter
from functools import cache
from pathlib import Path
from typing import NamedTuple

import numpy as np

from quintet.components.fe_plate.meshes.abaqus import require_readable
from quintet.components.fe_plate.meshes.arrays import Array, Whole
from quintet.components.fe_plate.meshes.coincidence import first_at_place, pieces
from quintet.components.fe_plate.meshes.nastran import (
    SUFFIXES,
    require_basic_coordinates,
    require_complete,
)
from quintet.components.fe_plate.meshes.source import (
    FOUR_NODES,
    HEXAHEDRON,
    SOLIDS,
    Source,
    as_source,
    of_parts,
    with_midside_nodes,
)
from quintet.components.fe_plate.meshes.tetrahedra import NODES, incomplete_faces, least_spacing
from quintet.interfaces.errors import SceneError


class FileMesh(NamedTuple):
    """What is used of a file: nodes of its elements alone."""

    node: Array  # (n, 3), in units of the file
    corner: Whole  # (e, 8) nodes of hexahedra, or (e, 10) of tetrahedra
    sets: dict[str, Whole]  # nodes (k,) of each named set
    groups: dict[str, Whole]  # elements (k,) of each named set
    notes: tuple[str, ...]  # of what is left out
    velocity: Array | None = None  # (n, 3) at the start, in units of the file


@cache
def read(file: str, coincident: str = "refuse", parts: tuple[int | str, ...] = ()) -> FileMesh:
    """Read the solids of a kind, their nodes, and the sets of both that the file names.

    Parameters
    ----------
    file
    coincident
        Whether nodes of different elements at the same place are refused ("refuse"), joined
        ("join"), or left apart ("keep").
    parts
        Parts, or sets of elements, that are read; all if none are named.
    """
    name, source = Path(file).name, _parsed(file)
    source = of_parts(name, source, parts) if parts else _all_parts(name, source)
    if _kind(name, source) == FOUR_NODES:
        source = with_midside_nodes(name, source)
    solids = [block.data for block in source.cells if block.type in SOLIDS and len(block.data)]
    corner: Whole = np.concatenate(solids).astype(np.int64)
    points = source.points
    notes = [*source.notes, *_left_out(name, source, np.unique(corner))]
    same = np.arange(len(points))
    if coincident != "keep":
        same = _same_places(name, points, corner, coincident)
        corner = same[corner]
    used, number = np.unique(corner, return_inverse=True)
    corner = number.reshape(corner.shape)
    if (count := pieces(corner, len(used))) > 1:
        notes.append(
            f"mesh {name}: it is in {count} pieces that share no node; they do not feel each other."
        )
    sets = {}
    for key, nodes in source.point_sets.items():
        members = np.unique(same[np.asarray(nodes, np.int64)])
        sets[key] = np.flatnonzero(np.isin(used, members))
        if (lost := len(members) - len(sets[key])) and not parts:
            notes.append(f"mesh {name}: {lost} nodes of its set {key} belong to no solid.")
    for key, nodes in _marked(source).items():
        if key not in sets:
            members = np.unique(same[nodes])
            sets[key] = np.flatnonzero(np.isin(used, members))
            notes.append(
                f"mesh {name}: its set {key} of faces or edges names the {len(sets[key])} nodes on "
                "them."
            )
    notes += _incomplete(name, corner, sets)
    groups = _groups(name, source, notes)
    velocity = None if source.velocity is None else source.velocity[used]
    return FileMesh(points[used], corner, sets, groups, tuple(notes), velocity)


def _incomplete(name: str, corner: Whole, sets: dict[str, Whole]) -> list[str]:
    """Notes of sets that hold faces of tetrahedra by their corners alone."""
    if corner.shape[1] != NODES:
        return []
    counts = {key: incomplete_faces(corner, nodes) for key, nodes in sets.items()}
    return [
        f"mesh {name}: its set {key} has all corners of {faces} outer faces, but lacks {lacking} "
        "nodes in the middles of their edges: `fixed` leaves these free, and the faces are not "
        "selected. Export the set with all nodes, if it shall hold the faces."
        for key, (faces, lacking) in counts.items()
        if faces
    ]


def _parsed(file: str) -> Source:
    """Read a file of LS-DYNA, or another by meshio."""
    path = Path(file)
    if path.suffix.lower() in (".k", ".key"):
        # Scenes with other files do not import it.
        from quintet.components.fe_plate.meshes.ls_dyna.deck import read_deck

        return read_deck(path)
    try:
        # Scenes without mesh files do not need it, nor have it installed.
        import meshio
    except ImportError as error:
        raise SceneError(
            f"file {path.name}: meshes are read by meshio, which is not installed. "
            "pip install quintet[meshes]."
        ) from error
    suffix = path.suffix.lower()
    if suffix == ".inp" and path.is_file():
        require_readable(path)
    if suffix in SUFFIXES and path.is_file():
        require_complete(path)
    try:
        mesh = meshio.read(file)
        source = as_source(mesh)
    except (Exception, SystemExit) as error:  # of any kind: each format has its own
        raise SceneError(
            f"file {path.name} must be a mesh that meshio reads; reading it found "
            f"{type(error).__name__}: {error}. Convert it."
        ) from error
    if suffix in SUFFIXES:
        require_basic_coordinates(path, mesh)
    return source


def _all_parts(name: str, source: Source) -> Source:
    """Return all that a file has; refuse elements that are not read."""
    if source.foreign:
        raise SceneError(
            f"file {name} must have no other elements than solids, for they would be left out; "
            f"found keywords: {_listed(Counter(source.foreign))}. Remove them, or name the parts "
            "that are solids in the key parts."
        )
    for block in source.cells:
        if block.type == HEXAHEDRON:
            source.check(np.arange(len(block.data)))
    return source


def _kind(name: str, source: Source) -> str:
    """Kind of all solids, hexahedra or tetrahedra; others, and those of several, are refused."""
    kinds, solids = Counter[str](), Counter[str]()
    for block in source.cells:
        kinds[block.type] += len(block.data)
        if block.dim == 3:
            solids[block.type] += len(block.data)
    kinds, solids = +kinds, +solids
    read_kinds = [kind for kind in SOLIDS if solids[kind]]
    if not read_kinds:
        raise SceneError(
            f"file {name} must have elements of kind hexahedron, tetra10 or tetra; found "
            f"{_listed(kinds) or 'none'}. Mesh it with 8-node solids, or with tetrahedra."
        )
    kind = read_kinds[0]
    if others := solids - Counter({kind: solids[kind]}):
        raise SceneError(
            f"file {name} must have no other solids than {kind}, for they would be holes; found "
            f"{_listed(others)} beside {solids[kind]} {kind}. Mesh it with one kind alone, or name "
            "parts of one kind in the key parts."
        )
    return kind


def _left_out(name: str, source: Source, used: Whole) -> list[str]:
    """Notes of faces, edges and points beside the solids; shells and beams are refused."""
    marks, lost = Counter[str](), Counter[str]()
    for block in source.cells:
        if block.type in SOLIDS or not len(block.data):
            continue
        data = np.asarray(block.data)
        beside = np.isin(data, used).all(axis=1) if block.dim else np.ones(len(data), bool)
        marks[block.type] += int(beside.sum())
        lost[block.type] += int((~beside).sum())
    if lost := +lost:
        raise SceneError(
            f"file {name} must have no shells or beams, for they would be left out; found "
            f"{_listed(lost)} with nodes that belong to no solid. Remove them, or mesh them with "
            "solids."
        )
    if not +marks:
        return []
    return [
        f"mesh {name}: {_listed(+marks)} lie on faces of its solids. They name nodes in sets, and "
        "are not used as elements."
    ]


def _listed(kinds: Counter[str]) -> str:
    return ", ".join(f"{count} {kind}" for kind, count in sorted(kinds.items()))


def _same_places(name: str, points: Array, corner: Whole, coincident: str) -> Whole:
    """Node (p,) that stands for each point of the file: the first of those at its place."""
    used, number = np.unique(corner, return_inverse=True)
    shortest = least_edge(points[used], number.reshape(corner.shape))
    if not (np.isfinite(points[used]).all() and shortest > 0.0):  # which is refused elsewhere
        return np.arange(len(points))
    first = used[first_at_place(points[used], shortest)]
    doubled = int((first != used).sum())
    if doubled and coincident == "refuse":
        where = np.array2string(points[used[np.argmax(first != used)]], precision=4)
        raise SceneError(
            f"file {name} must not have two nodes at one place, for elements are joined by the "
            f"nodes they share; found {doubled} such nodes, one at {where} in units of the file. "
            'Set coincident_nodes = "join" of the mesh, or "keep" if they shall part (a crack).'
        )
    same = np.arange(len(points))
    same[used] = first
    return same


def _marked(source: Source) -> dict[str, Whole]:
    """Points on the faces, edges and points of each named set that has no solids."""
    marked = {}
    for key, blocks in source.cell_sets.items():
        nodes = []
        for block, rows in zip(source.cells, blocks, strict=True):
            members = np.asarray([] if rows is None else rows, np.int64)
            if len(members) and block.dim == 3:
                break
            nodes.append(np.asarray(block.data, np.int64)[members].ravel())
        else:
            if sum(map(len, nodes)):
                marked[key] = np.concatenate(nodes)
    return marked


def _groups(name: str, source: Source, notes: list[str]) -> dict[str, Whole]:
    """Solids of each named set of elements, counted through all blocks of solids."""
    groups, marked = {}, _marked(source)
    for key, blocks in source.cell_sets.items():
        if key in marked:
            continue
        rows, first, lost = [np.zeros(0, np.int64)], 0, 0
        for block, chosen in zip(source.cells, blocks, strict=True):
            members = np.asarray([] if chosen is None else chosen, np.int64)
            if block.type in SOLIDS:
                rows.append(first + members)
                first += len(block.data)
            else:
                lost += len(members)
        groups[key] = np.concatenate(rows)
        if lost:
            notes.append(f"mesh {name}: {lost} members of its set {key} are no solids.")
    return groups


def least_edge(node: Array, corner: Whole) -> float:
    """Shortest edge of hexahedra (e, 8) or quadrilaterals (e, 4); half of one of tetrahedra."""
    if corner.shape[1] == NODES:
        return least_spacing(node, corner)
    x = node[corner]
    if x.shape[1] == 4:
        return float(np.linalg.norm(x - np.roll(x, 1, axis=1), axis=2).min())
    rings = [x[:, :4], x[:, 4:]]
    along = [np.linalg.norm(ring - np.roll(ring, 1, axis=1), axis=2).min() for ring in rings]
    return float(min(*along, np.linalg.norm(x[:, :4] - x[:, 4:], axis=2).min()))
