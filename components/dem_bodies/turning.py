"""Turning of bodies with their angular momenta, in world axes."""

from numba import njit

from quintet.components.dem_bodies.geometry import vector
from quintet.components.dem_bodies.state import Model, Numbers, State
from quintet.components.shared.rotations import (
    INNER,
    Matrix,
    Quaternion,
    Vector,
    backward,
    forward,
    matrix,
    turned,
)

ROUNDS = 20  # of the implicit midpoint rule, at most


@njit(**INNER)
def times(s: Numbers, i: int, x: float, y: float, z: float) -> Vector:
    """Symmetric matrix xx yy zz xy xz yz in row i times a vector."""
    return (
        s[i, 0] * x + s[i, 3] * y + s[i, 4] * z,
        s[i, 3] * x + s[i, 1] * y + s[i, 5] * z,
        s[i, 4] * x + s[i, 5] * y + s[i, 2] * z,
    )


@njit(**INNER)
def turning(inverse: Numbers, i: int, r: Matrix, x: float, y: float, z: float) -> Vector:
    """Angular velocity [rad/s] of a body with axes r and angular momentum (x, y, z)."""
    a, b, c = backward(r, x, y, z)
    a, b, c = times(inverse, i, a, b, c)
    return forward(r, a, b, c)


@njit(**INNER)
def midpoint(inverse: Numbers, i: int, q: Quaternion, spin: Vector, half: float) -> Vector:
    """Angular velocity in the middle of a step by the implicit midpoint rule.

    The rule is symmetric in time, so that the energy of a free body stays bounded.
    """
    x, y, z = spin
    w = turning(inverse, i, matrix(q), x, y, z)
    for _ in range(ROUNDS):
        r = matrix(turned(q, half * w[0], half * w[1], half * w[2]))
        new = turning(inverse, i, r, x, y, z)
        change = abs(new[0] - w[0]) + abs(new[1] - w[1]) + abs(new[2] - w[2])
        w = new
        if change <= 1e-15 * (abs(w[0]) + abs(w[1]) + abs(w[2])):
            break
    return w


@njit(**INNER)
def spun(state: State, i: int) -> Vector:
    """Angular velocity [rad/s] of a body that is no ball, with its present angular momentum."""
    x, y, z = vector(state.spin, i)
    return times(state.mobility, i, x, y, z)


@njit(**INNER)
def turn(model: Model, state: State, i: int, dt: float) -> Vector:
    """Turn a body that is no ball with its angular momentum; return ω, keep axes and R I⁻¹ Rᵀ."""
    inverse, orientation = model.inverse_inertia, state.orientation
    q = (orientation[i, 0], orientation[i, 1], orientation[i, 2], orientation[i, 3])
    spin = (state.spin[i, 0], state.spin[i, 1], state.spin[i, 2])
    if model.isotropic[i]:
        w = times(inverse, i, spin[0], spin[1], spin[2])
    else:
        w = midpoint(inverse, i, q, spin, 0.5 * dt)
    q = turned(q, dt * w[0], dt * w[1], dt * w[2])
    r = matrix(q)
    for k in range(4):
        orientation[i, k] = q[k]
    for k in range(9):
        state.axes[i, k] = r[k]
    if not model.isotropic[i]:
        x = turning(inverse, i, r, 1.0, 0.0, 0.0)
        y = turning(inverse, i, r, 0.0, 1.0, 0.0)
        z = turning(inverse, i, r, 0.0, 0.0, 1.0)
        world = (x[0], y[1], z[2], y[0], z[0], z[1])
        for k in range(6):
            state.mobility[i, k] = world[k]
    return w


@njit(**INNER)
def roll(state: State, i: int, w: Vector, dt: float) -> None:
    """Turn a ball."""
    orientation = state.orientation
    q = (orientation[i, 0], orientation[i, 1], orientation[i, 2], orientation[i, 3])
    q = turned(q, dt * w[0], dt * w[1], dt * w[2])
    for k in range(4):
        orientation[i, k] = q[k]
