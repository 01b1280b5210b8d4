"""Bodies with locked degrees of freedom: what of their inertia is left, and how they turn.

A constraint force keeps a velocity at what it is; it does no work where that is 0. So the free
components f of the angular momentum change by the torque alone, and with ω = 0 about the locked
axes

    dL_f/dt = T_f,   L_f = (R I Rᵀ)_ff ω_f,

which is solved as the free body's is. Where all three rotations are locked ω is what it was at
the start.
"""

from numba import njit

from quintet.components.dem_bodies.kernels.geometry import (
    quaternion,
    row_vector,
    set_quaternion,
    set_row_vector,
)
from quintet.components.dem_bodies.state import OMEGA, Model, Numbers, State
from quintet.components.shared.numba_options import EXACT, INNER
from quintet.components.shared.rotations import (
    Matrix,
    Quaternion,
    Vector,
    matrix,
    rotated,
    to_world,
)

ROUNDS = 20  # of the implicit midpoint rule, at most
Symmetric = tuple[float, float, float, float, float, float]  # xx yy zz xy xz yz


@njit(**INNER)
def times(s: Symmetric, v: Vector) -> Vector:
    """Symmetric matrix times a vector."""
    return (
        s[0] * v[0] + s[3] * v[1] + s[4] * v[2],
        s[3] * v[0] + s[1] * v[1] + s[5] * v[2],
        s[4] * v[0] + s[5] * v[1] + s[2] * v[2],
    )


@njit(**INNER)
def symmetric(rows: Numbers, i: int) -> Symmetric:
    """Symmetric matrix in a row."""
    return rows[i, 0], rows[i, 1], rows[i, 2], rows[i, 3], rows[i, 4], rows[i, 5]


@njit(**INNER)
def masked(free: Numbers, i: int, first: int, v: Vector) -> Vector:
    """Free components of a vector: translation from 0 on, rotation from 3 on."""
    return free[i, first] * v[0], free[i, first + 1] * v[1], free[i, first + 2] * v[2]


@njit(**INNER)
def world_inertia(inertia: Numbers, i: int, r: Matrix) -> Symmetric:
    """Inertia R I Rᵀ [kg m²] in world axes."""
    s = symmetric(inertia, i)
    x = to_world(r, *times(s, (r[0], r[1], r[2])))
    y = to_world(r, *times(s, (r[3], r[4], r[5])))
    z = to_world(r, *times(s, (r[6], r[7], r[8])))
    return x[0], y[1], z[2], y[0], z[0], z[1]


@njit(**INNER)
def free_inverse_inertia(model: Model, i: int, r: Matrix) -> Symmetric:
    """Inverse [1/(kg m²)] of the free part of the inertia in world axes, 0 about locked axes."""
    xx, yy, zz, xy, xz, yz = world_inertia(model.inertia, i, r)
    a, b, c = model.free[i, 3], model.free[i, 4], model.free[i, 5]
    # About a locked axis stands a 1, so that the matrix has an inverse.
    xx, yy, zz = a * xx + (1.0 - a), b * yy + (1.0 - b), c * zz + (1.0 - c)
    xy, xz, yz = a * b * xy, a * c * xz, b * c * yz
    u, v, w = yy * zz - yz * yz, xz * yz - xy * zz, xy * yz - xz * yy
    inverse = 1.0 / (xx * u + xy * v + xz * w)
    return (
        a * inverse * u,
        b * inverse * (xx * zz - xz * xz),
        c * inverse * (xx * yy - xy * xy),
        a * b * inverse * v,
        a * c * inverse * w,
        b * c * inverse * (xy * xz - xx * yz),
    )


@njit(**INNER)
def turns_evenly(model: Model, i: int) -> bool:
    """Whether all rotations are locked, so that ω is what it was at the start."""
    return bool(model.free[i, 3] + model.free[i, 4] + model.free[i, 5] == 0.0)


@njit(**INNER)
def locked_angular_velocity(model: Model, state: State, i: int) -> Vector:
    """Angular velocity [rad/s] of a locked body with its present angular momentum."""
    if turns_evenly(model, i):
        return row_vector(state.motion, i, OMEGA)
    momentum = row_vector(state.angular_momentum, i)
    return times(symmetric(state.world_inverse_inertia, i), momentum)


@njit(**INNER)
def midpoint_of_locked(model: Model, state: State, i: int, q: Quaternion, dt: float) -> Vector:
    """Angular velocity [rad/s] of a locked body in the middle of a step (implicit midpoint)."""
    ω = locked_angular_velocity(model, state, i)
    if turns_evenly(model, i):
        return ω
    momentum, half = row_vector(state.angular_momentum, i), 0.5 * dt
    for _ in range(ROUNDS):
        r = matrix(rotated(q, half * ω[0], half * ω[1], half * ω[2]))
        new = times(free_inverse_inertia(model, i, r), momentum)
        change = abs(new[0] - ω[0]) + abs(new[1] - ω[1]) + abs(new[2] - ω[2])
        ω = new
        if change <= 1e-15 * (abs(ω[0]) + abs(ω[1]) + abs(ω[2])):
            break
    return ω


@njit(**INNER)
def rotate_locked(model: Model, state: State, i: int, dt: float) -> Vector:
    """Rotate a locked body; return ω [rad/s], keep axes and the inverse of its free inertia."""
    orientation = state.orientation.reshape(-1)
    q = quaternion(orientation, 4 * i)
    ω = midpoint_of_locked(model, state, i, q, dt)
    q = rotated(q, dt * ω[0], dt * ω[1], dt * ω[2])
    set_quaternion(orientation, 4 * i, q)
    r = matrix(q)
    inverse = free_inverse_inertia(model, i, r)
    for k in range(9):
        state.axes[i, k] = r[k]
    for k in range(6):
        state.world_inverse_inertia[i, k] = inverse[k]
    return ω


@njit(**INNER)
def free_inverse_mass(model: Model, i: int, n: Vector) -> float:
    """1/m [1/kg] with which a body yields along n: 0 along locked axes."""
    if not model.locked[i]:
        return float(model.inverse_mass[i])
    x, y, z = masked(model.free, i, 0, n)
    return float(model.inverse_mass[i] * (x * x + y * y + z * z))


@njit(**EXACT)
def write_free_rotation(model: Model, state: State, i: int) -> None:
    """Write the angular momentum and the inverse inertia of a body whose locks have changed."""
    r = matrix(quaternion(state.orientation.reshape(-1), 4 * i))
    momentum = times(world_inertia(model.inertia, i, r), row_vector(state.motion, i, OMEGA))
    set_row_vector(state.angular_momentum, i, 0, masked(model.free, i, 3, momentum))
    inverse = free_inverse_inertia(model, i, r)
    for k in range(6):
        state.world_inverse_inertia[i, k] = inverse[k]


@njit(**EXACT)
def write_momenta_of_locked(model: Model, state: State, momenta: Numbers) -> None:
    """Write R I Rᵀ ω [kg m²/s], of which the state keeps the free components only, into rows."""
    for i in range(momenta.shape[0]):
        if model.locked[i]:
            r = matrix(quaternion(state.orientation.reshape(-1), 4 * i))
            momentum = times(world_inertia(model.inertia, i, r), row_vector(state.motion, i, OMEGA))
            set_row_vector(momenta, i, 0, momentum)
