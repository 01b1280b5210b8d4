"""Whether the elements of a mesh from a file can be computed with."""

from collections.abc import Sequence

import numpy as np

from quintet.components.fe_plate.meshes import tetrahedra
from quintet.components.fe_plate.meshes.arrays import Array, Whole
from quintet.interfaces.errors import SceneError

# Corners at the ends of the three edges of each corner, right-handed in a sound element.
NEIGHBOURS = np.array(
    [(1, 3, 4), (2, 0, 5), (3, 1, 6), (0, 2, 7), (7, 5, 0), (4, 6, 1), (5, 7, 2), (6, 4, 3)]
)
POOR = 0.2  # scaled Jacobian below which an element is badly shaped (Knupp 2000)


def require_one_kind(has_tetrahedra: Sequence[bool]) -> None:
    """Refuse parts of hexahedra beside parts of tetrahedra."""
    if len(set(has_tetrahedra)) > 1:
        raise SceneError(
            "parts: all of a component must have elements of one kind; found hexahedra in parts."
            f"{has_tetrahedra.index(False)} and tetrahedra in parts.{has_tetrahedra.index(True)}. "
            "Make two components of them, which a link contact may join, or mesh them alike."
        )


def least_jacobians(node: Array, corner: Whole) -> tuple[Array, Array]:
    """Least Jacobian of the corners of each element: (e,) m3, and scaled by the edges, (e,) 1."""
    x = node[corner]  # (e, 8, 3)
    least, scaled = np.full(len(corner), np.inf), np.full(len(corner), np.inf)
    for at, ends in enumerate(NEIGHBOURS):
        a, b, c = np.moveaxis(x[:, ends] - x[:, at, None], 1, 0)
        jacobian = (np.cross(a, b) * c).sum(axis=1)
        lengths = np.prod([np.linalg.norm(edge, axis=1) for edge in (a, b, c)], axis=0)
        least = np.minimum(least, jacobian)
        scaled = np.minimum(scaled, jacobian / np.maximum(lengths, np.finfo(float).tiny))
    return least, scaled


def require_sound(where: str, node: Array, corner: Whole) -> list[str]:
    """Refuse elements that are collapsed or inside out; return notes of badly shaped ones."""
    if not np.isfinite(node).all():
        wrong = int((~np.isfinite(node).all(axis=1)).sum())
        raise SceneError(
            f"{where}: coordinates must be finite; those of {wrong} nodes are not. Export it again."
        )
    if corner.shape[1] == tetrahedra.NODES:
        return tetrahedra.require_sound(where, node, corner)
    ordered = np.sort(corner, axis=1)
    collapsed = np.flatnonzero((ordered[:, 1:] == ordered[:, :-1]).any(axis=1))
    if len(collapsed):
        raise SceneError(
            f"{where}: an element must have 8 different nodes; {len(collapsed)} of {len(corner)} "
            f"are collapsed to wedges or the like, first element {collapsed[0]} (from 0) at "
            f"{_middle(node, corner, collapsed[0])} m. Mesh it with 8-node solids alone."
        )
    least, scaled = least_jacobians(node, corner)
    bad = np.flatnonzero(~(least > 0.0))
    if len(bad):
        worst = bad[np.argmin(least[bad])]
        raise SceneError(
            f"{where}: element {worst} (from 0) at {_middle(node, corner, worst)} m must have a "
            f"Jacobian above 0 at each corner; found {least[worst]:.3g} m3: it is inside out, and "
            f"{len(bad)} of {len(corner)} elements are. Reverse the order of their corners, or "
            "mesh it again."
        )
    poor = np.flatnonzero(scaled < POOR)
    if not len(poor):
        return []
    worst = poor[np.argmin(scaled[poor])]
    return [
        f"{where}: {len(poor)} of {len(corner)} elements are badly shaped (scaled Jacobian below "
        f"{POOR:g}), the worst with {scaled[worst]:.2g}, element {worst} (from 0) at "
        f"{_middle(node, corner, worst)} m: strains in them are inaccurate."
    ]


def _middle(node: Array, corner: Whole, element: int) -> str:
    return np.array2string(node[corner[element]].mean(axis=0), precision=4)
