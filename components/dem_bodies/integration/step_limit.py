"""How many contacts one body has at once, and the step that so many springs and dampers allow."""

import math

from numba import njit

from quintet.components.dem_bodies.laws import DAMPING
from quintet.components.dem_bodies.state import (
    EDGE_EDGE,
    SPHERE_SPHERE,
    Numbers,
    Short,
    Whole,
)
from quintet.components.shared.numba_options import EXACT

SHARE = 0.75  # of the limits: the sums leave out how neighbours move


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


def many_contacts_step(contacts: int, ω: float, ζ: float) -> float:
    """Largest step that is stable where many contacts hold one body.

    n springs side by side hold a body n times as fast, velocity Verlet's limit being 2/ω. Its
    dampers, whose velocity is predicted from the last force, are stable for Σ c/m* dt < 1.

    Parameters
    ----------
    contacts : int
    ω : float, rad/s
        Frequency of the stiffest, √(S_n/m*).
    ζ : float
        Damping ratio of the most damped.

    Returns
    -------
    float, s
    """
    if not contacts or not ω > 0.0:
        return math.inf
    damper, spring = contacts * DAMPING * ζ * ω, math.sqrt(contacts) * ω  # 1/s
    return SHARE * min(2.0 / spring, 1.0 / damper if damper > 0.0 else math.inf)
