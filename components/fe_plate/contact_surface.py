"""The faces that partners may touch, and what the stiffness of their contact follows from."""

import numpy as np

from quintet.components.fe_plate.build import Structure
from quintet.components.fe_plate.erosion import eroding_parts
from quintet.components.fe_plate.meshes.inner_sides import inner_sides
from quintet.components.fe_plate.meshes.tetrahedra import PIECES
from quintet.components.fe_plate.params import FePlateParams
from quintet.components.fe_plate.ranks.method import Ranks
from quintet.components.fe_plate.state import Array, Places, State, Whole
from quintet.components.shared.geometry.face_projection import corners

DEPTH = 1.0  # m along y, of edges in a plane


def areas(position: Array, face: Whole) -> Array:
    """Areas (m,) m2 of faces, of their nodes at (nodes, 3) m; of edges, 1 m deep."""
    a, b, c, d = (position[corner] for corner in corners(face).T)
    whole = 0.5 * np.linalg.norm(np.cross(c - a, d - b), axis=1)
    edge = DEPTH * np.linalg.norm(b - a, axis=1)
    return np.where(np.asarray(face)[:, 2] < 0, edge, whole)


def described_layer(
    built: Structure, surface: Whole, owner: Whole, area: Array
) -> dict[str, Array]:
    """Masses (k,) kg of nodes of the surface; moduli and thickness (m,) behind its faces.

    Parameters
    ----------
    built : Structure
        Whole.
    surface : (k,) int array
        Nodes.
    owner : (m,) int array
        Element behind each face.
    area : (m,) float array, m2
    """
    part = built.mesh.part[owner]
    return {
        "mass": built.mass[surface],
        "bulk": np.array([law.bulk for law in built.laws])[part],
        "shear": np.array([law.shear for law in built.laws])[part],
        "thickness": _thickness(built, owner, area),
    }


def _thickness(built: Structure, owner: Whole, area: Array) -> Array:
    """Thickness (m,) m of the layer of nodes behind faces: half a tetrahedron's height."""
    if not built.mesh.has_tetrahedra:
        return np.asarray(built.volume[owner] / area)
    whole = area.reshape(-1, len(PIECES)).sum(axis=1)  # m2, of faces with six nodes
    return np.asarray(1.5 * built.volume[owner] / np.repeat(whole, len(PIECES)))


class OpeningSurface:
    """The coupled faces, and behind them the inner ones of all parts that may erode.

    A face is open while the element behind it is left and none covers it.

    Parameters
    ----------
    whole : Structure
        On every rank.
    places : Places
        Of the elements of this rank.
    params : FePlateParams
    surface : (k,) int array
        Nodes of the coupled faces; they stand before all others.
    ranks : Ranks
    """

    def __init__(
        self, whole: Structure, places: Places, params: FePlateParams, surface: Whole, ranks: Ranks
    ) -> None:
        mesh = whole.mesh
        seen = np.unique(mesh.part[mesh.owner[whole.coupled]])
        parts = np.intersect1d(seen, eroding_parts(params))
        inner = inner_sides(mesh, np.flatnonzero(np.isin(mesh.part, parts)), params.dimensions)
        side = np.concatenate([mesh.side[whole.coupled], inner.side])
        behind = np.concatenate([mesh.owner[whole.coupled], inner.behind])
        numbers = np.unique(side[side >= 0])
        node = np.concatenate([surface, np.setdiff1d(numbers, surface)])
        row: Whole = np.full(len(mesh.node), -1)
        row[node] = np.arange(len(node))
        self.nodes = ranks.nodes_of(node)
        layer = described_layer(whole, node, behind, areas(mesh.node, side))
        self.described = {
            "start": mesh.node[node],
            "corner": np.where(side < 0, -1, row[side]).astype(np.float64),
            **layer,
        }
        element = np.unique(behind)
        self._rank, self._elements = ranks.rank, ranks.elements_of(element)
        self._places = places.subset(self._elements.rows)
        self._behind = np.searchsorted(element, behind)
        # Nothing covers outer faces: a 0 stands behind all elements.
        outer = np.full(len(whole.coupled), len(element))
        self._front = np.concatenate([outer, np.searchsorted(element, inner.front)])
        # (e,) whether each element was left when faces were last looked at.
        self._left = np.zeros(0)
        self._open = np.zeros(0)  # (m,) which faces were open then

    def open_faces(self, state: State) -> Array:
        """1 of each face (m,) that is part of the surface now, else 0; on rank 0."""
        left = self._elements.gather(self._places.active(state))
        if self._rank:
            return left
        if not np.array_equal(left, self._left):
            covers = np.append(left, 0.0)
            self._left, self._open = left, left[self._behind] * (1.0 - covers[self._front])
        return self._open.copy()
