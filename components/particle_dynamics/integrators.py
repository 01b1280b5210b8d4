"""Symplectic schemes of second and fourth order: their stages, and their greatest stable steps."""

import math

from quintet.components.particle_dynamics.force_params import Damping

YOSHIDA = 1.0 / (2.0 - 2.0 ** (1.0 / 3.0))
# Shares of a step; Yoshida, Phys. Lett. A 150 (1990) 262.
STAGES = {"velocity_verlet": (1.0,), "yoshida": (YOSHIDA, 1.0 - 2.0 * YOSHIDA, YOSHIDA)}
# Greatest stable step times the highest frequency; of Yoshida's where an oscillator's step matrix
# has a trace of 2 again.
LIMIT = {"velocity_verlet": 2.0, "yoshida": 1.5734}
# Greatest step over the time 1/rate in which damping slows pairs down. Its velocity is predicted by
# the last force, which is stable up to 1 (Adams and Bashforth's scheme); half, for what vibrates.
DAMPED = 0.5
NEAR = 32  # neighbours of a point of the lattice within two spacings


def damped_step(damping: Damping | None, mass: float, points: int, by: str) -> float:
    """Greatest step [s] that the damping of pairs allows; inf without.

    Of all pairs, at any distance, n δ/m is the greatest rate, if all points are in line. The
    neighbours of a point within two spacings lie in all directions alike: 2 n/3 δ/m.

    Parameters
    ----------
    damping : Damping or None
    mass : float, kg
        Of each point.
    points : int
        Of the lattice.
    by : str
        Name of the integrator.
    """
    if damping is None or damping.coefficient == 0.0:
        return math.inf
    partners = points if damping.range == "all" else 2.0 / 3.0 * NEAR
    longest = max(abs(share) for share in STAGES[by])
    return DAMPED * mass / (damping.coefficient * partners * longest)
