"""The step that the springs and dampers of many contacts allow."""

import math

from quintet.components.dem_bodies.laws import DAMPING

SHARE = 0.75  # of the limits: the sums leave out how neighbours move


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
