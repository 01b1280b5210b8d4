"""Physics of a point in a frame that moves."""

from typing import NamedTuple

from numba import njit

Three = tuple[float, float, float]


class FrameForces(NamedTuple):
    """What the accelerations of a moving frame are made of: a = c + G r - 2ω × u."""

    lead: float  # s, from the time of places and velocities to the middle of the step
    uniform: Three  # m/s2, c
    gradient: tuple[Three, Three, Three]  # 1/s2, G
    turning: Three  # 1/s, 2ω


@njit(inline="always")
def cross(first, other):  # type: ignore[no-untyped-def]
    """Cross product of two vectors."""
    x, y, z = first
    u, v, w = other
    return y * w - z * v, z * u - x * w, x * v - y * u


@njit(inline="always")
def later(r, u, a, time):  # type: ignore[no-untyped-def]
    """Place [m] after a time [s], from a place, a velocity and an acceleration."""
    x = r[0] + time * (u[0] + 0.5 * time * a[0])
    y = r[1] + time * (u[1] + 0.5 * time * a[1])
    z = r[2] + time * (u[2] + 0.5 * time * a[2])
    return x, y, z


@njit(inline="always")
def frame_acceleration(r, u, a, forces):  # type: ignore[no-untyped-def]
    """Acceleration in a moving frame, and the power of its motion.

    Parameters
    ----------
    r, u, a : three floats, m, m/s, m/s2
        Place and velocity, and what other forces accelerate.
    forces : FrameForces

    Returns
    -------
    three floats, m/s2, and a float, m2/s3
        a + c + G r - 2ω × u, and the power per mass of c + G r; r and u are those in the middle of
        the step.

    References
    ----------
    Landau & Lifshitz, Mechanics (1976), article 39.
    """
    x, y, z = later(r, u, a, forces.lead)
    c, (gx, gy, gz), lead = forces.uniform, forces.gradient, forces.lead
    px = c[0] + gx[0] * x + gx[1] * y + gx[2] * z
    py = c[1] + gy[0] * x + gy[1] * y + gy[2] * z
    pz = c[2] + gz[0] * x + gz[1] * y + gz[2] * z
    ax, ay, az = a[0] + px, a[1] + py, a[2] + pz
    kx, ky, kz = cross(forces.turning, u)
    middle = u[0] + lead * (ax - kx), u[1] + lead * (ay - ky), u[2] + lead * (az - kz)
    power = px * middle[0] + py * middle[1] + pz * middle[2]
    kx, ky, kz = cross(forces.turning, middle)
    return (ax - kx, ay - ky, az - kz), power
