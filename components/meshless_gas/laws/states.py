"""States of one node: from conserved to primitive ones, sound, stages and stable steps."""

import math

from numba import njit

from quintet.components.shared.numba_options import FAST_INNER, INNER


@njit(**INNER)
def sound_speed(density, pressure, gamma):  # type: ignore[no-untyped-def]
    """Speed of sound [m/s] of a gas of a density [kg/m3] and a pressure [Pa]."""
    return math.sqrt(gamma * pressure / density)


@njit(**INNER)
def staged(start, now, rate, dt, old, new):  # type: ignore[no-untyped-def]
    """A conserved density after a stage: old U₀ + new (U + Δt R).

    References
    ----------
    Shu & Osher, J. Comput. Phys. 77 (1988) 439.
    """
    return old * start + new * (now + dt * rate)


@njit(**INNER)
def primitive_state(r0, r1, r2, r3, r4, gamma):  # type: ignore[no-untyped-def]
    """Density, velocity and pressure (5,) of densities of mass, momentum and energy."""
    u, v, w = r1 / r0, r2 / r0, r3 / r0
    p = (gamma - 1.0) * (r4 - 0.5 * (r1 * u + r2 * v + r3 * w))
    return r0, u, v, w, p


@njit(**INNER)
def is_state(density, pressure):  # type: ignore[no-untyped-def]
    """Whether density and pressure are those of a gas: above 0, and finite."""
    return density > 0.0 and pressure > 0.0 and pressure < math.inf and density < math.inf


@njit(**INNER)
def change_square(rate, bound, density):  # type: ignore[no-untyped-def]
    """Square of the relative change of a density in a stable step [s]."""
    change = rate * bound / density
    return change * change


@njit(**FAST_INNER)
def crossing_rate(velocity_i, velocity_j, coefficient, sound_i, sound_j):  # type: ignore[no-untyped-def]
    """What a neighbour adds to one over the stable step [1/s] of a node.

    max(|v_i·c_ij|, |v_j·c_ij|) + max(a_i, a_j) |c_ij|, velocities (3,) in the node's frame.
    """
    x, y, z = coefficient
    carried = abs(velocity_i[0] * x + velocity_i[1] * y + velocity_i[2] * z)
    reached = abs(velocity_j[0] * x + velocity_j[1] * y + velocity_j[2] * z)
    size = math.sqrt(x * x + y * y + z * z)
    return max(carried, reached) + max(sound_i, sound_j) * size
