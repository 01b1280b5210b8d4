"""How many elements a part has through its thinnest extents.

With one quadrature point an element, n layers lack 1/n² of their stiffness in bending: the strain
is linear through the thickness, and each layer has that of its middle alone.
"""

import numpy as np

from quintet.components.fe_plate.meshes.arrays import Array, Whole
from quintet.components.fe_plate.meshes.mesh import SIDES
from quintet.components.fe_plate.meshes.params import MeshedPart
from quintet.components.shared.geometry.shapes import Cylinder

ENOUGH = 8  # layers: 1.6 % too soft
SLENDER = 0.5  # of a part's longest extent: what is thinner than this bends
MANY = 10**9
OPPOSITE = np.array([1, 0, 4, 5, 2, 3])  # the side opposite to each


def fewest_layers(part: MeshedPart, dimensions: int = 3) -> int:
    """Fewest elements through an extent in which a part is slender; `MANY` if it is in none."""
    if part.has_tetrahedra:
        return MANY  # quadratic in any direction
    if part.shape == "mesh":
        return _of_mesh(part)
    shape = part.geometry
    if isinstance(shape, Cylinder):
        core, rings, layers = part.counts
        across = (2 * (core + rings), 2.0 * shape.radius)
        return _fewest([across, (layers, shape.length)])
    low, high = shape.bounds
    extents = []
    for along, cut in enumerate(part.cut_out()):
        if dimensions == 2 and along == 1:
            continue
        extent, count = high[along] - low[along], part.counts[along]
        extents.append((count, extent))
        # Beside a cutout the part is as thin as what is left there.
        for left in (int(np.argmax(cut)), int(np.argmax(cut[::-1]))) if cut.any() else ():
            if left:
                extents.append((left, extent * left / count))
    return _fewest(extents)


def _fewest(extents: list[tuple[int, float]]) -> int:
    longest = max(length for _, length in extents)
    return min((n for n, length in extents if length < SLENDER * longest), default=MANY)


def _of_mesh(part: MeshedPart) -> int:
    """Fewest elements from an outer side through to the one opposite."""
    mesh = part.placed()
    longest = float(np.ptp(mesh.node, axis=0).max())
    twin = twins(mesh.corner)
    outer = np.flatnonzero(twin < 0)
    start, at = _middles(mesh.node, mesh.corner, outer), outer
    for count in range(1, ENOUGH):
        through = at - at % 6 + OPPOSITE[at % 6]
        ends = twin[through] < 0
        middle = _middles(mesh.node, mesh.corner, through[ends])
        if (np.linalg.norm(middle - start[ends], axis=1) < SLENDER * longest).any():
            return count
        at, start = twin[through[~ends]], start[~ends]
    return MANY


def twins(corner: Whole) -> Whole:
    """Side 6e + s (6e,) that each side of an element shares with another one; -1 of outer ones."""
    side = np.sort(corner[:, SIDES].reshape(-1, 4), axis=1)
    order = np.lexsort(side.T)
    same = np.flatnonzero((side[order[1:]] == side[order[:-1]]).all(axis=1))
    twin = np.full(len(side), -1)
    twin[order[same]], twin[order[same + 1]] = order[same + 1], order[same]
    return twin


def _middles(node: Array, corner: Whole, side: Whole) -> Array:
    """Middles (k, 3) m of some sides."""
    corners = np.take_along_axis(corner[side // 6], SIDES[side % 6], axis=1)
    return np.asarray(node[corners].mean(axis=1))
