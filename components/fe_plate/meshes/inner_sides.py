"""Sides between two elements, which erosion of one of them opens."""

from typing import NamedTuple

import numpy as np

from quintet.components.fe_plate.meshes.arrays import Whole
from quintet.components.fe_plate.meshes.mesh import EDGES, SIDES, Mesh
from quintet.components.fe_plate.meshes.tetrahedra import FACES, PIECES


class InnerSides(NamedTuple):
    """Sides of elements that another element covers; each stands twice, once for both elements."""

    side: Whole  # (f, 4) nodes, seen from outside of the element behind; as of `Mesh.side`
    behind: Whole  # (f,) element that the side belongs to
    front: Whole  # (f,) element that covers it


def inner_sides(mesh: Mesh, elements: Whole, dimensions: int) -> InnerSides:
    """Sides that two of some elements (k,) share, in the order of the elements behind them."""
    corner = mesh.corner[elements]
    if dimensions == 2:
        nodes = corner[:, EDGES].reshape(-1, 2)
        key, of_element, pieces = nodes, len(EDGES), np.pad(nodes, ((0, 0), (0, 2)))[:, None]
        pieces[:, :, 2:] = -1
    elif mesh.has_tetrahedra:
        nodes = corner[:, FACES].reshape(-1, 6)
        key, of_element = nodes[:, :3], len(FACES)
        pieces = np.pad(nodes[:, PIECES], ((0, 0), (0, 0), (0, 1)), constant_values=-1)
    else:
        key = corner[:, SIDES].reshape(-1, 4)
        of_element, pieces = len(SIDES), key[:, None]
    first, second = _pairs(np.sort(key, axis=1))
    behind, front = np.concatenate([first, second]), np.concatenate([second, first])
    order = np.argsort(behind)
    behind, front = behind[order], front[order]
    count = pieces.shape[1]  # faces of a side
    return InnerSides(
        pieces[behind].reshape(-1, 4),
        np.repeat(elements[behind // of_element], count),
        np.repeat(elements[front // of_element], count),
    )


def _pairs(key: Whole) -> tuple[Whole, Whole]:
    """Rows of a table (n, k) that are equal to each other: the first and the second of each two."""
    order = np.lexsort(key.T)
    alike = (key[order[1:]] == key[order[:-1]]).all(axis=1)
    return order[:-1][alike], order[1:][alike]
