"""What happens at one ball, and at one pair of balls: numbers in, numbers out.

Loops on the processor compile these functions; for devices they are printed (`opencl/`).
"""

import math

from numba import njit

from quintet.components.dem_bodies.kernels.kicks import kick, kick_rotation, kick_work
from quintet.components.dem_bodies.laws import LEAST
from quintet.components.shared.numba_options import INNER
from quintet.components.shared.rotations import (
    Quaternion,
    Vector,
    axpy,
    cross,
    dot,
    rotated,
    scaled,
    sub,
)

# Of a radius: least height of a centre over a plane; lower centres count as this high.
LEAST_HEIGHT = 1e-9


@njit(**INNER)
def half_kick(
    v: Vector, ω: Vector, half_gravity: Vector, half: float, inverse_mass: float,
    inverse_moment: float, force: Vector, torque: Vector, load_force: Vector, load_torque: Vector,
) -> tuple[Vector, Vector, Vector, float, float]:  # fmt: skip
    """Half a step of a ball's velocities.

    Parameters
    ----------
    v, ω : (3,) m/s and rad/s
    half_gravity : (3,) m/s
        Change of velocity by gravity.
    half : float, s
        Half of the step.
    inverse_mass, inverse_moment : float, 1/kg and 1/(kg m²)
    force, torque : (3,) N and N m
        Of contacts.
    load_force, load_torque : (3,) N and N m
        Force and torque from outside.

    Returns
    -------
    v, ω : (3,) m/s and rad/s
    change : (3,) m/s
        Of the velocity.
    work, load_work : float, J
        Of contacts, and from outside.
    """
    change = kick(half_gravity, half * inverse_mass, force, load_force)
    v = axpy(1.0, change, v)
    end_ω = kick_rotation(ω, half * inverse_moment, torque, load_torque)
    work = kick_work(half, force, torque, v, change, ω, end_ω)
    load_work = kick_work(half, load_force, load_torque, v, change, ω, end_ω)
    return v, end_ω, change, work, load_work


@njit(**INNER)
def drifted(
    x: Vector, q: Quaternion, v: Vector, change: Vector, before: Vector, ω: Vector, dt: float
) -> tuple[Vector, Quaternion, Vector, Vector]:
    """Place and orientation of a ball after a step, and velocities predicted for its end.

    Parameters
    ----------
    x, q : (3,) m and (4,)
        At the step's beginning.
    v, ω : (3,) m/s and rad/s
        In its middle.
    change, before : (3,) m/s and rad/s
        Change of the velocity since the beginning, and angular velocity then.
    dt : float, s

    Returns
    -------
    x, q, v, ω
    """
    end_v, end_ω = axpy(1.0, change, v), sub(scaled(2.0, ω), before)
    return axpy(dt, v, x), rotated(q, dt * ω[0], dt * ω[1], dt * ω[2]), end_v, end_ω


@njit(**INNER)
def from_plane(x: Vector, radius: float, n: Vector, offset: float) -> Vector:
    """Vector [m] from the nearest point of a plane to a ball's centre."""
    return scaled(max(dot(n, x) - offset, LEAST_HEIGHT * radius), n)


@njit(**INNER)
def velocity_at_contact(
    v: Vector, ω_i: Vector, ω_j: Vector, n: Vector, i: float, j: float
) -> Vector:
    """Velocity [m/s] of a point at the arm -i n over another's at the arm j n."""
    return sub(v, cross(axpy(j, ω_j, scaled(i, ω_i)), n))


@njit(inline="always", **INNER)
def kinematics(
    r_ij: Vector, radii: float, radius: float, v_ij: Vector, end_v_ij: Vector, ω_i: Vector,
    ω_j: Vector, end_ω_i: Vector, end_ω_j: Vector,
) -> tuple[Vector, float, float, Vector, Vector]:  # fmt: skip
    """Normal, overlap and velocities of the point of contact of two balls.

    Parameters
    ----------
    r_ij : (3,) m
    radii, radius : float, m
        Sum of both radii, and that of the first ball.
    v_ij, end_v_ij : (3,) m/s
        Velocity of the first over the second, the mean of the step and at its end.
    ω_i, ω_j, end_ω_i, end_ω_j : (3,) rad/s
        Likewise.

    Returns
    -------
    normal : (3,)
        Unit vector, towards the first ball.
    depth : float, m
        Overlap; below 0 without contact.
    root : float, √m
        Of the overlap; 0 without contact.
    mean, end : (3,) m/s
        Of the point of contact.
    """
    distance = math.sqrt(dot(r_ij, r_ij))
    n, depth = scaled(1.0 / max(distance, LEAST), r_ij), radii - distance
    root = math.sqrt(max(depth, 0.0))
    i, j = radius - 0.5 * depth, radii - radius - 0.5 * depth
    end = velocity_at_contact(end_v_ij, end_ω_i, end_ω_j, n, i, j)
    mean = velocity_at_contact(v_ij, ω_i, ω_j, n, i, j)
    return n, depth, root, mean, end


@njit(inline="always", **INNER)
def relative_depth(depth: float, radius: float, other: float) -> float:
    """Overlap over the smaller of two radii [m]; a plane's is 0, and does not count."""
    low = min(radius, other) if other > 0.0 else radius
    return depth / low
