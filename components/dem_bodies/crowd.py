"""How many contacts hold one body at once, and the step that so many springs and dampers allow."""

import math

from numba import njit

from quintet.components.dem_bodies.state import EDGE, SPHERE, Numbers, Short, Whole
from quintet.components.shared.rotations import PURE

DAMPING = 2.0 * math.sqrt(5.0 / 6.0)  # as in laws: damper over ζ √(S m*)
SHARE = 0.75  # of the limits: the sums leave out how neighbours move


@njit(**PURE)
def crowding(
    history: Numbers, ends: Whole, begin: Whole, body: Whole, edge: Whole, count: Whole
) -> None:
    """Write the number of contacts of each body but those of balls into `count` (n,)."""
    count[:] = 0
    for k in range(begin[EDGE + 1]):
        if history[k, 3] > 0.0:
            i, j = ends[k, 0], ends[k, 1]
            if k >= begin[EDGE]:
                i, j = edge[i, 0], edge[j, 0]
            count[body[i]] += 1
            if k >= begin[EDGE] or begin[SPHERE] <= k < begin[SPHERE + 1]:
                count[body[j]] += 1
            elif k >= begin[SPHERE + 1]:  # a sphere and a box
                count[j] += 1


@njit(**PURE)
def crowding_of_balls(row: Short, partner: Short, held: Numbers, count: Whole) -> int:
    """Add the contacts of balls to `count` (n,); return the largest of any body."""
    for k in range(row.shape[0]):
        if held[k, 3] > 0.0:
            count[row[k]] += 1
            if partner[k] < count.shape[0]:
                count[partner[k]] += 1
    return int(count.max())


def crowd_step(crowd: int, ω: float, ζ: float) -> float:
    """Step [s] at which `crowd` contacts of a frequency ω [rad/s] and a damping ratio ζ are stable.

    n springs side by side hold a body n times as fast, velocity Verlet's limit being 2/ω. Its
    dampers, whose velocity is foreseen from the last force, are stable for Σ c/m* dt < 1.
    """
    if not crowd or not ω > 0.0:
        return math.inf
    damper, spring = crowd * DAMPING * ζ * ω, math.sqrt(crowd) * ω  # 1/s
    return SHARE * min(2.0 / spring, 1.0 / damper if damper > 0.0 else math.inf)
