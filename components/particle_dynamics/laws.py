"""Laws of one pair and of one point: forces, damping, a drive, baths, collisions.

F > 0 is attraction. Kernels take F over the distance, as a function of the squared distance.
"""

import math
from typing import Any

import numpy as np
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


@njit(inline="always")
def weight_of_damping(damping, r):  # type: ignore[no-untyped-def]
    """Coefficient of damping along a pair [kg/s] at a distance [m]."""
    u = (r * damping.per_metre - damping.begin) * damping.per_width
    return damping.coefficient * falling_step(u)


@njit(inline="always")
def damping_over_distance(weight, opening, square):  # type: ignore[no-untyped-def]
    """Force [N/m] of a damping [kg/s] over the distance; ṙ r [m2/s], squared distance [m2]."""
    return weight * opening / square


@njit(inline="always")
def nearest_image(x, side, per_side):  # type: ignore[no-untyped-def]
    """Difference of coordinates [m] to the nearest image; of an open side both numbers are 0."""
    return x - side * np.rint(x * per_side)


@njit(inline="always")
def tether_force(tether, position, rest):  # type: ignore[no-untyped-def]
    """Force [N] along an axis towards the place where a point is held, with the sign of a pull."""
    return tether * (position - rest)


@njit(inline="always")
def prescribed_motion(driven, time):  # type: ignore[no-untyped-def]
    """Change [m] of the distance of a driven pair at a time [s], its velocity, its acceleration."""
    moved = driven.amplitude * math.sin(driven.frequency * time)
    speed = driven.amplitude * driven.frequency * math.cos(driven.frequency * time)
    turning = driven.frequency * driven.frequency
    push = -driven.amplitude * turning * math.sin(driven.frequency * time)
    return moved, speed, push


@njit(inline="always")
def driven_places(driven, moved, first, second):  # type: ignore[no-untyped-def]
    """Prescribed coordinates [m] of a driven pair along its axis, from those after the drift."""
    if driven.is_free:
        middle = 0.5 * (first + second)
        apart = 0.5 * (driven.distance + moved)
        return middle + apart, middle - apart
    first = driven.rest_first + driven.share_first * moved
    return first, driven.rest_second - driven.share_second * moved


@njit(inline="always")
def driven_rates(driven, rate, first, second):  # type: ignore[no-untyped-def]
    """Velocities of a driven pair along its axis, or accelerations; `rate` is of the distance."""
    if driven.is_free:
        middle = 0.5 * (first + second)
        return middle + 0.5 * rate, middle - 0.5 * rate
    return driven.share_first * rate, -driven.share_second * rate


@njit(inline="always")
def bath_factors(rate, temperature, mass, boltzmann, dt):  # type: ignore[no-untyped-def]
    """Share of a velocity that a bath leaves in a time [s], and width [m/s] of what it adds."""
    decay = math.exp(-rate * dt)
    return decay, math.sqrt(boltzmann * temperature / mass * (1.0 - decay * decay))


@njit(inline="always")
def heat_gained(mass, velocity, before):  # type: ignore[no-untyped-def]
    """Kinetic energy [J] that a point gained along an axis."""
    return 0.5 * mass * (velocity * velocity - before * before)


@njit(inline="always")
def half_turn(relative, direction):  # type: ignore[no-untyped-def]
    """Half the change (3,) m/s of a relative velocity that turns into a direction (3,)."""
    x, y, z = relative
    u, v, w = direction
    speed = math.sqrt(x * x + y * y + z * z)
    return 0.5 * (speed * u - x), 0.5 * (speed * v - y), 0.5 * (speed * w - z)


@njit(**EXACT)
def force(law: Any, r: float) -> float:
    """F [N] of a pair at a distance [m]."""
    return r * force_over_distance(law, r * r)


@njit(**EXACT)
def energy(law: Any, r: float) -> float:
    """Potential energy [J] of a pair at a distance [m]."""
    return float(pair_energy(law, r * r))
