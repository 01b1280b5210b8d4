"""When a Verlet list must be made anew: cutoff, skin, and how far particles have moved.

A list that holds what was nearer than cutoff + skin lacks no pair that is nearer than the cutoff
until two particles have moved by more than the skin together (Verlet, Phys. Rev. 159 (1967) 98).
"""

import math
from dataclasses import dataclass

from numba import njit

from quintet.components.shared.numba_options import EXACT
from quintet.interfaces.component import Array


@dataclass(frozen=True, slots=True)
class VerletSkin:
    """How far pairs act, and how much further the list reaches."""

    cutoff: float  # m, beyond which pairs do not act
    share: float  # 1, skin over cutoff

    @property
    def reach(self) -> float:
        """Distance [m] within which the list holds all pairs."""
        return (1.0 + self.share) * self.cutoff

    def is_outworn(self, moved: float, others: float = 0.0, coming: float = 0.0) -> bool:
        """Whether pairs may act that the list lacks.

        Parameters
        ----------
        moved : float, m
            Furthest that a particle is from where it was listed.
        others : float, m
            The same of those that pair with these only, as walls and surfaces.
        coming : float, m
            How much nearer two particles may come to each other before pairs are next computed.
        """
        return moved + max(moved, others) > self.reach - self.cutoff - coming


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
