"""When a Verlet list must be made again: how far points have moved, and what that leaves.

A list that holds what was nearer than cutoff + skin lacks no pair that is nearer than the cutoff
until two points have moved by more than the skin together (Verlet, Phys. Rev. 159 (1967) 98).
"""

import math

from numba import njit

from quintet.components.shared.numba_options import EXACT
from quintet.interfaces.component import Array


@njit(**EXACT)
def slack(skin: float, moved: float, others: float = 0.0) -> float:
    """How much nearer [m] two points may still come; a list holds while this is above 0.

    Parameters
    ----------
    skin : float, m
        By which the list reaches beyond the cutoff.
    moved : float, m
        Furthest that a point is from where it was listed.
    others : float, m
        The same of those that pair with these only, as walls and surfaces.
    """
    return skin - (moved + max(moved, others))


def longest(vectors: Array) -> float:
    """Length of the longest of vectors (n, 3 or more)."""
    x, y, z = vectors[:, 0], vectors[:, 1], vectors[:, 2]
    return math.sqrt((x * x + y * y + z * z).max())


@njit(**EXACT)
def furthest(position: Array, listed: Array) -> float:
    """Furthest [m] that a point (n, 3) is from where it was listed."""
    square = 0.0
    for i in range(position.shape[0]):
        x, y = position[i, 0] - listed[i, 0], position[i, 1] - listed[i, 1]
        z = position[i, 2] - listed[i, 2]
        square = max(square, x * x + y * y + z * z)
    return math.sqrt(square)
