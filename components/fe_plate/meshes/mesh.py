"""Meshes of solids: their outer faces, and which elements meet at a node.

Corners 0 to 3 of a hexahedron go round one side, seen from within, and 4 to 7 stand opposite them;
nodes of tetrahedra are those of `meshes.tetrahedra`.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from quintet.components.fe_plate.meshes.arrays import Array, Whole
from quintet.components.fe_plate.meshes.box import box, rectangle
from quintet.components.fe_plate.meshes.coincidence import first_at_place
from quintet.components.fe_plate.meshes.cylinder import cylinder
from quintet.components.fe_plate.meshes.elements import require_one_kind
from quintet.components.fe_plate.meshes.files import least_edge
from quintet.components.fe_plate.meshes.params import MeshedPart
from quintet.components.fe_plate.meshes.selections import Elements, Faces, NodeSet
from quintet.components.fe_plate.meshes.tetrahedra import NODES as TETRAHEDRON
from quintet.components.fe_plate.meshes.tetrahedra import PIECES, outer_triangles, split
from quintet.components.shared.geometry.selections import ByBox, ByBoxOrSet, in_box
from quintet.interfaces.errors import SceneError
from quintet.interfaces.params import unknown

# Corners around each side of an element, seen from outside.
SIDES = np.array(
    [(0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]
)
# Edges of an element in a plane, its inside on the left of the way from x to z.
EDGES = np.array([(1, 0), (2, 1), (3, 2), (0, 3)])
CLOSE = 1e-6  # of the mesh's size: nodes so near a box lie in it


class Mesh(NamedTuple):
    """Nodes and elements of all parts, one part after another."""

    node: Array  # (n, 3) m
    corner: Whole  # (e, 8) nodes of hexahedra, or (e, 10) of tetrahedra
    part: Whole  # (e,)
    # (f, 4) nodes of the outer faces, seen from outside; of edges two, and -1 twice; of tetrahedra
    # four triangles for each face of six nodes, one after another, and -1 once
    side: Whole
    owner: Whole  # (f,) element of each
    sets: dict[str, Whole]  # nodes of each named set, of files and of the scene
    groups: dict[str, Whole]  # elements of each named set of files
    notes: tuple[str, ...] = ()  # of meshes from files
    velocity: Array | None = None  # (n, 3) m/s at the start, of files; None if none has any

    @property
    def has_tetrahedra(self) -> bool:
        """Whether its elements are tetrahedra with ten nodes."""
        return self.corner.shape[1] == TETRAHEDRON


def mesh(parts: Sequence[MeshedPart], dimensions: int = 3, sets: Sequence[NodeSet] = ()) -> Mesh:
    """Make the mesh of some parts."""
    nodes, corners, first, count = [], [], 0, 0
    named: dict[str, Whole] = {}
    groups: dict[str, Whole] = {}
    notes: list[str] = []
    velocities: list[tuple[int, Array]] = []
    for part in parts:
        if dimensions == 2:
            node, corner = rectangle(part)
        elif part.shape == "cylinder":
            node, corner = cylinder(part)
        elif part.shape == "mesh":
            loaded = part.placed()
            node, corner = loaded.node, loaded.corner
            notes += loaded.notes
            if loaded.velocity is not None:
                velocities.append((first, loaded.velocity))
            for name, rows in loaded.sets.items():
                named[name] = np.append(named.get(name, rows[:0]), first + rows)
            for name, rows in loaded.groups.items():
                groups[name] = np.append(groups.get(name, rows[:0]), count + rows)
        else:
            node, corner = box(part)
            if part.tetrahedra:
                node, corner = split(node, corner)
        nodes.append(node)
        corners.append(corner + first)
        first, count = first + len(node), count + len(corner)
    number = np.repeat(np.arange(len(parts)), [len(rows) for rows in corners])
    require_one_kind([rows.shape[1] == TETRAHEDRON for rows in corners])
    corner = np.concatenate(corners)
    outer = outer_sides(corner) if dimensions == 3 else outer_edges(corner)
    node = np.concatenate(nodes)
    _require_apart(node, corner, number, outer[0])
    for place, node_set in enumerate(sets):
        if node_set.name in named:
            raise SceneError(
                f"node_sets.{place}: names must differ; {node_set.name} is the name of another "
                "set, of the scene or of a mesh's file. Rename it."
            )
        named[node_set.name] = np.flatnonzero(inside(node, node_set))
    velocity = _joined(velocities, len(node)) if velocities else None
    return Mesh(node, corner, number, *outer, named, groups, tuple(notes), velocity)


def _joined(velocities: list[tuple[int, Array]], nodes: int) -> Array:
    """Velocities (n, 3) m/s of all nodes, from those of some parts and the first node of each."""
    joined = np.zeros((nodes, 3))
    for first, velocity in velocities:
        joined[first : first + len(velocity)] = velocity
    return joined


def _require_apart(node: Array, corner: Whole, part: Whole, side: Whole) -> None:
    """Refuse parts that seem to be joined: their nodes lie at the same places."""
    if not part[-1]:
        return
    outer = np.unique(side[side >= 0])
    part_of = np.zeros(len(node), np.int64)
    part_of[corner] = part[:, None]
    planar = bool((corner[0, :4] == corner[0, 4:8]).all())
    shortest = least_edge(node, corner[:, :4] if planar else corner)
    first = outer[first_at_place(node[outer], shortest)]
    shared = np.flatnonzero(part_of[first] != part_of[outer])
    if len(shared):
        k = shared[0]
        pair = sorted((part_of[first[k]], part_of[outer[k]]))
        raise SceneError(
            f"parts.{pair[0]} and parts.{pair[1]}: parts must not touch, for they are not joined "
            f"and do not feel each other; {len(shared)} of their nodes lie at the same places, one "
            f"at {np.array2string(node[outer[k]], precision=4)} m. Make them one mesh, or leave "
            "a gap between them."
        )


def outer_sides(corner: Whole) -> tuple[Whole, Whole]:
    """Sides (f, 4) that belong to one element alone, and that element (f,); see `Mesh.side`."""
    if corner.shape[1] == TETRAHEDRON:
        return outer_triangles(corner)
    side = corner[:, SIDES].reshape(-1, 4)
    owner = np.repeat(np.arange(len(corner)), len(SIDES))
    _, first, count = np.unique(
        np.sort(side, axis=1), axis=0, return_index=True, return_counts=True
    )
    outer = np.sort(first[count == 1])
    return side[outer], owner[outer]


def outer_edges(corner: Whole) -> tuple[Whole, Whole]:
    """Edges (f, 4) of elements in a plane, -1 twice behind their nodes, and their elements (f,)."""
    edge = corner[:, EDGES].reshape(-1, 2)
    owner = np.repeat(np.arange(len(corner)), len(EDGES))
    _, first, count = np.unique(
        np.sort(edge, axis=1), axis=0, return_index=True, return_counts=True
    )
    outer = np.sort(first[count == 1])
    return np.pad(edge[outer], ((0, 0), (0, 2)), constant_values=-1), owner[outer]


def chosen(mesh: Mesh, by: ByBoxOrSet, where: str) -> NDArray[np.bool_]:
    """Which nodes lie in a box, or belong to a set."""
    if not by.node_set:
        return inside(mesh.node, by)
    if by.node_set not in mesh.sets:
        raise SceneError(unknown(f"{where}: node_set {by.node_set}", by.node_set, mesh.sets))
    nodes = np.zeros(len(mesh.node), bool)
    nodes[mesh.sets[by.node_set]] = True
    return nodes


def elements_of(mesh: Mesh, by: Elements, where: str) -> Whole:
    """Numbers of the elements all of whose corners lie in a box, or belong to a set."""
    if not by.element_set:
        return np.flatnonzero(chosen(mesh, by, where)[mesh.corner].all(axis=1))
    if by.element_set not in mesh.groups:
        wrong = f"{where}: element_set {by.element_set}"
        raise SceneError(unknown(wrong, by.element_set, mesh.groups))
    return mesh.groups[by.element_set]


def inside(points: Array, box: ByBox | ByBoxOrSet) -> NDArray[np.bool_]:
    """Whether points (n, 3) m lie in a box, its edges included."""
    return in_box(points, box, CLOSE * float(np.ptp(points, axis=0).max()))


def faces_in(mesh: Mesh, boxes: Sequence[Faces], where: str) -> Whole:
    """Numbers of the outer faces all of whose corners lie in one of some boxes, or sets."""
    faces = np.zeros(len(mesh.side), bool)
    for by in boxes:
        whole = (chosen(mesh, by, where)[mesh.side] | (mesh.side < 0)).all(axis=1)
        if mesh.has_tetrahedra:  # all six nodes of a face
            whole = np.repeat(whole.reshape(-1, len(PIECES)).all(axis=1), len(PIECES))
        faces |= whole
    return np.flatnonzero(faces)


def incident(corner: Whole, nodes: int) -> tuple[Whole, Whole]:
    """Corners at each node, by their places in the flat table: those of node i from begin[i] on."""
    order = np.argsort(corner.ravel(), kind="stable")
    begin = np.searchsorted(corner.ravel()[order], np.arange(nodes + 1))
    return begin, order
