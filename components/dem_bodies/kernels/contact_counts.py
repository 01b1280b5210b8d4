"""Number of contacts of each row."""

from numba import njit

from quintet.components.dem_bodies.state import (
    EDGE_EDGE,
    SPHERE_SPHERE,
    Numbers,
    Short,
    Whole,
)
from quintet.components.shared.numba_options import EXACT


@njit(**EXACT)
def count_contacts(
    history: Numbers, ends: Whole, begin: Whole, row: Whole, edge: Whole, count: Whole
) -> None:
    """Write the number of contacts of each row but those of balls into `count` (n,)."""
    count[:] = 0
    for k in range(begin[EDGE_EDGE + 1]):
        if history[k, 3] > 0.0:
            i, j = ends[k, 0], ends[k, 1]
            if k >= begin[EDGE_EDGE]:
                i, j = edge[i, 0], edge[j, 0]
            count[row[i]] += 1
            if k >= begin[EDGE_EDGE] or begin[SPHERE_SPHERE] <= k < begin[SPHERE_SPHERE + 1]:
                count[row[j]] += 1
            elif k >= begin[SPHERE_SPHERE + 1]:  # a sphere and a box
                count[j] += 1


@njit(**EXACT)
def count_ball_contacts(row: Short, partner: Short, history: Numbers, count: Whole) -> None:
    """Add the contacts of balls to `count` (n,)."""
    for k in range(row.shape[0]):
        if history[3, k] > 0.0:
            count[row[k]] += 1
            if partner[k] < count.shape[0]:
                count[partner[k]] += 1
