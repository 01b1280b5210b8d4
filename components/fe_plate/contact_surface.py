"""The faces that partners may touch, and what the stiffness of their contact follows from."""

import numpy as np

from quintet.components.fe_plate.build import Structure
from quintet.components.fe_plate.meshes.tetrahedra import PIECES
from quintet.components.fe_plate.state import Array, Whole
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
