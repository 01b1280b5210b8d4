"""Laws of one pair: the seven-root force, a force from a table, and damping along the pair.

F > 0 is attraction. Kernels take F over the distance, as a function of the squared distance.
"""

import math
from typing import Any

from numba import njit
from numba.extending import overload

from quintet.components.particle_dynamics.coefficients import MIDDLE, ForceTable
from quintet.components.shared.numba_options import EXACT


@njit(inline="always")
def falling_step(u):  # type: ignore[no-untyped-def]
    """STEP of MSC Adams from 1 at u = 0 to 0 at u = 1: cubic, flat at both ends."""
    u = min(max(u, 0.0), 1.0)
    return 1.0 - u * u * (3.0 - 2.0 * u)


def force_over_distance(law: Any, square: float) -> float:
    """F/r [N/m] of a pair at a squared distance [m2]."""
    raise NotImplementedError("it is called by compiled functions only")


@overload(force_over_distance, inline="always")
def _force_over_distance(law, square):  # type: ignore[no-untyped-def]
    if law.instance_class is ForceTable:

        def of_table(law, square):  # type: ignore[no-untyped-def]
            if square >= law.cutoff2:
                return 0.0
            r = math.sqrt(square)
            place = max((r - law.first) * law.per_metre, 0.0)
            k = min(int(place), law.force.shape[0] - 2)
            low = law.force[k]
            return (low + (place - k) * (law.force[k + 1] - low)) / r

        return of_table

    return force_of_roots


def force_of_roots(law, square):  # type: ignore[no-untyped-def]
    """Seven-root force over the distance [N/m], from the squared distance [m2]."""
    x = math.sqrt(square) * law.per_metre
    a, b, c, d, e, f, g = law.roots
    product = (x - a) * (x - b) * (x - c) * (x - d) * (x - e) * (x - f) * (x - g)
    for _ in range(len(law.factors)):
        product *= x - law.base
    step = falling_step((x - law.begin) * law.per_width)
    return law.strength * law.per_metre * product * step / x


def pair_energy(law: Any, square: float) -> float:
    """Potential energy [J] of a pair at a squared distance [m2], 0 beyond the cut-off."""
    raise NotImplementedError("it is called by compiled functions only")


@overload(pair_energy)
def _pair_energy(law, square):  # type: ignore[no-untyped-def]
    if law.instance_class is ForceTable:

        def of_table(law, square):  # type: ignore[no-untyped-def]
            if square >= law.cutoff2:
                return 0.0
            place = (math.sqrt(square) - law.first) * law.per_metre
            if place < 0.0:
                return law.energy[0] + place / law.per_metre * law.force[0]
            k = min(int(place), law.force.shape[0] - 2)
            part, low = place - k, law.force[k]
            mean = low + 0.5 * part * (law.force[k + 1] - low)
            return law.energy[k] + part * mean / law.per_metre

        return of_table

    def of_roots(law, square):  # type: ignore[no-untyped-def]
        if square >= law.cutoff2:
            return 0.0
        x = math.sqrt(square) * law.per_metre
        series = law.inner if x <= law.begin else law.outer
        value, t = 0.0, x - MIDDLE
        for k in range(series.shape[0] - 1, -1, -1):
            value = value * t + series[k]
        return law.strength / law.per_metre * value

    return of_roots


def damping_weight(damping: Any, r: float) -> float:
    """Force [N s/m] of a pair at a distance r [m] per speed at which it opens."""
    raise NotImplementedError("it is called by compiled functions only")


@overload(damping_weight, inline="always")
def _damping_weight(damping, r):  # type: ignore[no-untyped-def]
    return weight_of_damping


def weight_of_damping(damping, r):  # type: ignore[no-untyped-def]
    """Coefficient of damping along a pair [kg/s] at a distance [m]."""
    u = (r * damping.per_metre - damping.begin) * damping.per_width
    return damping.coefficient * falling_step(u)


@njit(**EXACT)
def force(law: Any, r: float) -> float:
    """F [N] of a pair at a distance [m]."""
    return r * force_over_distance(law, r * r)


@njit(**EXACT)
def energy(law: Any, r: float) -> float:
    """Potential energy [J] of a pair at a distance [m]."""
    return float(pair_energy(law, r * r))
