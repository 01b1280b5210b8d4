"""Corners and faces of boxes."""

from collections.abc import Iterable, Sequence
from itertools import product

import numpy as np

from quintet.interfaces.component import Array

CORNERS = np.array(list(product((-1.0, 1.0), repeat=3)))  # of a box about the origin, z fastest
# Corners around each face of a box, seen from outside.
BOX_FACES = {
    "x-": (0, 1, 3, 2),
    "x+": (4, 6, 7, 5),
    "y-": (0, 4, 5, 1),
    "y+": (2, 3, 7, 6),
    "z-": (0, 2, 6, 4),
    "z+": (1, 5, 7, 3),
}
FACES = np.array(list(BOX_FACES.values()))


def box(low: Sequence[float], high: Sequence[float], faces: Iterable[str]) -> list[Array]:
    """Corners (4, 3) m of some faces of a box between two of its corners."""
    middle, half = np.add(low, high) / 2.0, np.subtract(high, low) / 2.0
    corners = middle + half * CORNERS
    return [corners[list(BOX_FACES[face])] for face in faces]
