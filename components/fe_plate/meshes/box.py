"""Boxes of equal elements."""

import numpy as np

from quintet.components.fe_plate.meshes.params import Part
from quintet.components.fe_plate.state import Array, Whole


def box(part: Part) -> tuple[Array, Whole]:
    """Nodes (n, 3) m and corners (e, 8) of a box of equal elements."""
    assert part.elements is not None and part.lowest is not None and part.highest is not None
    nx, ny, nz = part.elements
    ends = zip(part.lowest, part.highest, part.elements, strict=True)
    lines = [np.linspace(a, b, n + 1) for a, b, n in ends]
    node = np.stack(np.meshgrid(*lines, indexing="ij"), axis=-1).reshape(-1, 3)
    number = np.arange(len(node)).reshape(nx + 1, ny + 1, nz + 1)
    low, high = slice(0, -1), slice(1, None)
    around = ((low, low), (high, low), (high, high), (low, high))
    corner = [number[x, y, z].ravel() for z in (low, high) for x, y in around]
    return node, np.stack(corner, axis=1)
