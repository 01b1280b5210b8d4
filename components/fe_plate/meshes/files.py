"""Meshes from files, in any format that meshio reads: 8-node solids, or quadrilaterals in a plane.

Nothing is imported unless a scene names a file.
"""

from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from quintet.interfaces.component import Array
from quintet.interfaces.errors import SceneError

SOLID, FLAT = "hexahedron", "quad"


class FileMesh(NamedTuple):
    """What is used of a file: nodes of its elements alone."""

    node: Array  # (n, 3), in units of the file
    corner: Array  # (e, 8 or 4) whole numbers
    sets: dict[str, Array]  # nodes (k,) of each named set
    groups: dict[str, Array]  # elements (k,) of each named set


@cache
def read(file: str, kind: str = SOLID) -> FileMesh:
    """Read the elements of a kind, their nodes, and the sets of both that the file names."""
    try:
        # Scenes without mesh files do not need it, nor have it installed.
        import meshio
    except ImportError as error:
        raise SceneError(
            f"file {Path(file).name}: meshes are read by meshio, which is not installed. "
            "pip install quintet[meshes]."
        ) from error
    try:
        found = meshio.read(file)
    except (Exception, SystemExit) as error:  # of any kind: each format has its own
        raise SceneError(
            f"file {Path(file).name} must be a mesh that meshio reads; reading it found "
            f"{type(error).__name__}: {error}. Convert it."
        ) from error
    cells = [np.asarray(block.data, np.int64) for block in found.cells if block.type == kind]
    if not cells:
        kinds = sorted({block.type for block in found.cells})
        raise SceneError(
            f"file {Path(file).name} must have elements of kind {kind}; found "
            f"{', '.join(kinds) or 'none'}. Mesh it with 8-node solids."
        )
    corner = np.concatenate(cells)
    used, number = np.unique(corner, return_inverse=True)
    points = np.zeros((len(used), 3))
    given = np.asarray(found.points, np.float64)[used]
    points[:, : given.shape[1]] = given
    sets = {
        name: np.flatnonzero(np.isin(used, np.asarray(nodes, np.int64)))
        for name, nodes in found.point_sets.items()
    }
    return FileMesh(points, number.reshape(corner.shape), sets, _groups(found, kind))


def _groups(found: Any, kind: str) -> dict[str, Array]:
    """Elements of a kind of each named set, counted through all blocks of that kind."""
    groups = {}
    for name, blocks in found.cell_sets.items():
        rows, first = [np.zeros(0, np.int64)], 0
        for block, chosen in zip(found.cells, blocks, strict=True):
            if block.type == kind:
                rows.append(first + np.asarray([] if chosen is None else chosen, np.int64))
                first += len(block.data)
        groups[name] = np.concatenate(rows)
    return groups


def least_edge(mesh: FileMesh) -> float:
    """Shortest edge of its elements, in units of the file."""
    x = mesh.node[mesh.corner]
    if x.shape[1] == 4:
        return float(np.linalg.norm(x - np.roll(x, 1, axis=1), axis=2).min())
    rings = [x[:, :4], x[:, 4:]]
    along = [np.linalg.norm(ring - np.roll(ring, 1, axis=1), axis=2).min() for ring in rings]
    return float(min(*along, np.linalg.norm(x[:, :4] - x[:, 4:], axis=2).min()))
