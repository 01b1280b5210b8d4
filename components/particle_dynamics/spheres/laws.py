"""Impacts of bodies that overlap at the end of a step, with constant accelerations since contact.

An impulse Δp at a time t before the end of the step changes a velocity by Δp/m and a position by
t Δp/m. A body that rests on another (its velocity at contact is zero) is stopped, and put where it
touches.
"""

import math

from numba import njit

from quintet.components.shared.numba_options import EXACT
from quintet.components.shared.rotations import Vector, axpy, dot

STEPS = 4  # of Newton's method


@njit(**EXACT)
def unit(r: Vector, length: float) -> Vector:
    """Vector over its length."""
    return r[0] / length, r[1] / length, r[2] / length


@njit(**EXACT)
def past(r: Vector, v: Vector, a: Vector, t: float) -> tuple[Vector, Vector]:
    """Relative position [m] and velocity [m/s] a time t [s] ago."""
    return axpy(-t, axpy(-0.5 * t, a, v), r), axpy(-t, a, v)


@njit(**EXACT)
def time_since_contact(r: Vector, v: Vector, a: Vector, reach: float) -> float:
    """Time [s] since two spheres came into contact, their relative acceleration constant.

    The root t of |r - v t + a t²/2| = R: that of straight flight, improved by Newton's method.

    Parameters
    ----------
    r, v : Vector, m and m/s
        Relative position and velocity now: they overlap, and approach.
    a : Vector, m/s2
        Relative acceleration.
    reach : float, m
        R, sum of the radii.
    """
    along, inside = dot(r, v), reach * reach - dot(r, r)  # along is negative
    t = inside / (math.sqrt(along * along + dot(v, v) * inside) - along)
    for _ in range(STEPS):
        p, w = past(r, v, a, t)
        slope = -2.0 * dot(p, w)
        if slope <= 0.0:
            return t
        t -= (dot(p, p) - reach * reach) / slope
    return t


@njit(**EXACT)
def impact_of_spheres(
    r: Vector, v: Vector, a: Vector, reach: float, dt: float, restitution: float
) -> tuple[Vector, float, float, float]:
    """Frictionless impact of two spheres.

    Parameters
    ----------
    r, v, a, reach
        As in `time_since_contact`.
    dt : float, s
        Length of the step: contacts are no older.
    restitution : float

    Returns
    -------
    Vector, float, float, float
        Normal; change of the relative velocity [m/s] and position [m] along it; energy that is
        lost over the reduced mass [m2/s2].
    """
    t = time_since_contact(r, v, a, reach)
    if not 0.0 < t <= dt:  # they have overlapped since before the step
        t = 0.0
    p, w = past(r, v, a, t)
    normal = unit(p, math.sqrt(dot(p, p)))
    speed = -dot(normal, w)
    if speed > 0.0:
        change = (1.0 + restitution) * speed
        return normal, change, change * t, 0.5 * speed * speed * (1.0 - restitution * restitution)
    distance = math.sqrt(dot(r, r))  # they rest on each other
    normal = unit(r, distance)
    pull, change = -dot(normal, a), -dot(r, v) / distance
    shift = min(reach - distance, 0.5 * abs(pull) * dt * dt)
    return normal, change, shift, max(0.5 * change * change - pull * shift, 0.0)


@njit(**EXACT)
def impact_on_wall(
    depth: float, speed: float, pull: float, mass: float, dt: float, restitution: float
) -> tuple[float, float, float]:
    """Frictionless impact of a sphere on a wall.

    Parameters
    ----------
    depth, speed, pull : float, m, m/s, m/s2
        How deep the sphere is in the wall; velocity and acceleration towards it.
    mass : float, kg
    dt : float, s
        Length of the step: contacts are no older.
    restitution : float

    Returns
    -------
    float, float, float
        Change of velocity [m/s] and of position [m] away from the wall; lost energy [J].
    """
    square = speed * speed - 2.0 * pull * depth  # (m/s)², at contact
    if square <= 0.0:
        shift = min(depth, 0.5 * abs(pull) * dt * dt)
        return speed, shift, 0.5 * mass * max(speed * speed - 2.0 * pull * shift, 0.0)
    at_contact = math.sqrt(square)
    since = 2.0 * depth / (speed + at_contact)
    if since > dt:  # it has been in the wall since before the step
        at_contact, since = speed, 0.0
    change = (1.0 + restitution) * at_contact
    return change, change * since, 0.5 * mass * at_contact**2 * (1.0 - restitution * restitution)
