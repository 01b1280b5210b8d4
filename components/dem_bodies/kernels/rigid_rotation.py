"""Rotation of rigid bodies by their angular momenta, in world axes."""

from numba import njit

from quintet.components.dem_bodies.kernels.geometry import quaternion, row_vector, set_quaternion
from quintet.components.dem_bodies.state import Model, Numbers, State
from quintet.components.shared.numba_options import INNER
from quintet.components.shared.rotations import (
    Matrix,
    Quaternion,
    Vector,
    matrix,
    rotated,
    to_body,
    to_world,
)

ROUNDS = 20  # of the implicit midpoint rule, at most


@njit(**INNER)
def symmetric_product(s: Numbers, i: int, x: float, y: float, z: float) -> Vector:
    """Symmetric matrix xx yy zz xy xz yz in row i times a vector."""
    return (
        s[i, 0] * x + s[i, 3] * y + s[i, 4] * z,
        s[i, 3] * x + s[i, 1] * y + s[i, 5] * z,
        s[i, 4] * x + s[i, 5] * y + s[i, 2] * z,
    )


@njit(**INNER)
def world_angular_velocity(inverse_inertia: Numbers, i: int, r: Matrix, momentum: Vector) -> Vector:
    """ω = R I⁻¹ Rᵀ L [rad/s] of a body with axes r and angular momentum L."""
    a, b, c = to_body(r, momentum[0], momentum[1], momentum[2])
    a, b, c = symmetric_product(inverse_inertia, i, a, b, c)
    return to_world(r, a, b, c)


@njit(**INNER)
def midpoint_angular_velocity(
    inverse_inertia: Numbers, i: int, q: Quaternion, momentum: Vector, half: float
) -> Vector:
    """Angular velocity [rad/s] in the middle of a step by the implicit midpoint rule.

    The rule is symmetric in time, so that the energy of a free body stays bounded.
    """
    ω = world_angular_velocity(inverse_inertia, i, matrix(q), momentum)
    for _ in range(ROUNDS):
        r = matrix(rotated(q, half * ω[0], half * ω[1], half * ω[2]))
        new = world_angular_velocity(inverse_inertia, i, r, momentum)
        change = abs(new[0] - ω[0]) + abs(new[1] - ω[1]) + abs(new[2] - ω[2])
        ω = new
        if change <= 1e-15 * (abs(ω[0]) + abs(ω[1]) + abs(ω[2])):
            break
    return ω


@njit(**INNER)
def angular_velocity(state: State, i: int) -> Vector:
    """Angular velocity [rad/s] of a body that is no ball, with its present angular momentum."""
    x, y, z = row_vector(state.angular_momentum, i)
    return symmetric_product(state.world_inverse_inertia, i, x, y, z)


@njit(**INNER)
def rotate_body(model: Model, state: State, i: int, dt: float) -> Vector:
    """Rotate a body that is no ball; return ω [rad/s], keep axes and R I⁻¹ Rᵀ."""
    inverse, orientation = model.inverse_inertia, state.orientation.reshape(-1)
    q = quaternion(orientation, 4 * i)
    momentum = row_vector(state.angular_momentum, i)
    if model.isotropic[i]:
        ω = symmetric_product(inverse, i, momentum[0], momentum[1], momentum[2])
    else:
        ω = midpoint_angular_velocity(inverse, i, q, momentum, 0.5 * dt)
    q = rotated(q, dt * ω[0], dt * ω[1], dt * ω[2])
    r = matrix(q)
    set_quaternion(orientation, 4 * i, q)
    for k in range(9):
        state.axes[i, k] = r[k]
    if not model.isotropic[i]:
        x = world_angular_velocity(inverse, i, r, (1.0, 0.0, 0.0))
        y = world_angular_velocity(inverse, i, r, (0.0, 1.0, 0.0))
        z = world_angular_velocity(inverse, i, r, (0.0, 0.0, 1.0))
        world = (x[0], y[1], z[2], y[0], z[0], z[1])
        for k in range(6):
            state.world_inverse_inertia[i, k] = world[k]
    return ω
