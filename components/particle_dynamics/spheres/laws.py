"""When two bodies that overlap at the end of a step have come into contact."""

import math

from numba import njit

from quintet.components.shared.numba_options import EXACT

STEPS = 4  # of Newton's method


@njit(**EXACT)
def time_since_contact(
    x: float, y: float, z: float, u: float, v: float, w: float, ax: float, ay: float, az: float,
    reach: float,
) -> float:  # fmt: skip
    """Time [s] since two spheres came into contact, their relative acceleration constant.

    The root t of |r - u t + a t²/2| = R: that of straight flight, improved by Newton's method.

    Parameters
    ----------
    x, y, z : float, m
        Relative position r now: they overlap, and approach.
    u, v, w : float, m/s
        Relative velocity now.
    ax, ay, az : float, m/s2
        Relative acceleration.
    reach : float, m
        R, sum of the radii.
    """
    speed2 = u * u + v * v + w * w
    along = x * u + y * v + z * w  # negative
    inside = reach * reach - (x * x + y * y + z * z)
    t = inside / (math.sqrt(along * along + speed2 * inside) - along)
    for _ in range(STEPS):
        px, py, pz = (x - t * (u - 0.5 * t * ax), y - t * (v - 0.5 * t * ay),
                      z - t * (w - 0.5 * t * az))  # fmt: skip
        slope = -2.0 * (px * (u - t * ax) + py * (v - t * ay) + pz * (w - t * az))
        if slope <= 0.0:
            return t
        t -= (px * px + py * py + pz * pz - reach * reach) / slope
    return t
