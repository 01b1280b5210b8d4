"""Cells numbered along x, then y, then z, so that those next to one another along x are a range.

Numbers are the same wherever in space the bodies are, and leave room for far ones.
"""

import math

import numpy as np
from numba import njit

from quintet.components.dem_bodies.contact.geometry import row_vector
from quintet.components.dem_bodies.state import Numbers, Whole
from quintet.components.shared.numba_options import EXACT, INNER

BITS = 21  # of a cell's number along each axis
MIDDLE = 1 << (BITS - 1)


@njit(**INNER)
def cell_of(x: float, width: float) -> int:
    """Return the number of the cell along one axis; what is very far shares the last one."""
    return int(min(max(math.floor(x / width), 2.0 - MIDDLE), MIDDLE - 2.0)) + MIDDLE


@njit(**EXACT)
def number_cells(position: Numbers, bodies: Whole, width: float) -> Whole:
    """Return the cells of some bodies, each as one number."""
    cells = np.empty(bodies.shape[0], np.int64)
    for k in range(bodies.shape[0]):
        x, y, z = row_vector(position, bodies[k])
        cells[k] = (cell_of(z, width) << 2 * BITS) + (cell_of(y, width) << BITS)
        cells[k] += cell_of(x, width)
    return cells
