"""Outflow nodes continued from the gas within, to second order.

States and changes of them are (5,) kg/m3, m/s, Pa; normals (3,) point into the gas.
"""

import math

from numba import njit

from quintet.components.shared.numba_options import INNER

LEAST = 0.5  # of the least density and pressure near: what a continued state must keep
NOISE = 1e-6  # of the pressure, below which differences are none
ROUGH = 0.25  # share of what pressures near differ by that a plane misses: none is smooth
CROSSING = 0.2  # Mach numbers about that of sound over which the incoming wave is let go


@njit(**INNER)
def outward_speed(state, normal):  # type: ignore[no-untyped-def]
    """Speed [m/s] against a normal into the gas of a state, or of a change of it."""
    return -(state[1] * normal[0]) - state[2] * normal[1] - state[3] * normal[2]


@njit(**INNER)
def let_waves_out(out, sound, density, normal, more):  # type: ignore[no-untyped-def]
    """Part of a change (5,) that leaves: with the flow, if gas leaves, and as waves of sound."""
    outward = outward_speed(more, normal)
    carried = min(max(out / (CROSSING * sound), 0.0), 1.0)
    against = min(max((out / sound - 1.0) / CROSSING, 0.0), 1.0)  # if the gas is faster
    ahead = 0.5 * (more[4] + density * sound * outward)
    behind = 0.5 * against * (more[4] - density * sound * outward)
    push, speed = ahead + behind, (ahead - behind) / (density * sound)
    return (
        carried * (more[0] - more[4] / (sound * sound)) + push / (sound * sound),
        carried * (more[1] + outward * normal[0]) - speed * normal[0],
        carried * (more[2] + outward * normal[1]) - speed * normal[1],
        carried * (more[3] + outward * normal[2]) - speed * normal[2],
        push,
    )


@njit(**INNER)
def roughness(missed, count, low, high):  # type: ignore[no-untyped-def]
    """Root mean square of what a plane misses pressures by, over the most that they differ by.

    Parameters
    ----------
    missed : float, Pa2
        Sum of the squares.
    count : int
        How many there are.
    low, high : float, Pa
    """
    return math.sqrt(missed / max(count, 1)) / (high - low + NOISE * high)


@njit(**INNER)
def held_near(value, low, high, smooth, floor):  # type: ignore[no-untyped-def]
    """A value that may be beyond those near by a share of their range, but not below a floor."""
    beyond = max(smooth, 0.0) * (high - low)
    return min(max(value, max(low - beyond, floor)), high + beyond)


@njit(**INNER)
def continued(state, out, sound, normal, more, low, high, rough):  # type: ignore[no-untyped-def]
    """State of an outflow node.

    Parameters
    ----------
    state : (5,)
        Of the gas within, of no slope along the normal.
    out, sound : float, m/s
        Its speed outwards, and of sound there.
    more : (5,)
        What the plane through nodes within has more at the node.
    low, high : (5,)
        Least and most of nodes near.
    rough : float, 1

    References
    ----------
    Hirsch, Numerical Computation of Internal and External Flows 2 (1990), section 19.1.
    """
    a, b, c, d, e = let_waves_out(out, sound, state[0], normal, more)
    # Smooth flow may be extrapolated beyond the values nearby; at a shock it is bounded by them.
    smooth = 1.0 - rough / ROUGH
    density = held_near(state[0] + a, low[0], high[0], smooth, LEAST * low[0])
    u = held_near(state[1] + b, low[1], high[1], smooth, -math.inf)
    v = held_near(state[2] + c, low[2], high[2], smooth, -math.inf)
    w = held_near(state[3] + d, low[3], high[3], smooth, -math.inf)
    pressure = held_near(state[4] + e, low[4], high[4], smooth, LEAST * low[4])
    new = (density, u, v, w, pressure)
    back = -outward_speed(new, normal)
    if back > 0.0 and out > 0.0:  # what leaves nearby does not come back here
        return (
            density, u - back * normal[0], v - back * normal[1], w - back * normal[2], pressure
        )  # fmt: skip
    return new
