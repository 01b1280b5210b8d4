"""Half a step's change of velocities by loads, of balls and of other bodies, and its work."""

from numba import njit

from quintet.components.dem_bodies.kernels.geometry import row_vector, set_row_vector, vector
from quintet.components.dem_bodies.kernels.locked_motion import locked_angular_velocity, masked
from quintet.components.dem_bodies.kernels.rigid_rotation import angular_velocity
from quintet.components.dem_bodies.state import OMEGA, VELOCITY, Model, State
from quintet.components.shared.numba_options import INNER
from quintet.components.shared.rotations import Vector, axpy, dot, scaled


@njit(**INNER)
def kick(half_gravity: Vector, inverse: float, force: Vector, load: Vector) -> Vector:
    """Half a step's change of velocity [m/s]; `inverse` is half the step over the mass."""
    return axpy(inverse, load, axpy(inverse, force, half_gravity))


@njit(**INNER)
def kick_rotation(ω: Vector, inverse: float, torque: Vector, load: Vector) -> Vector:
    """Angular velocity [rad/s] of a ball after half a step, or a body's angular momentum."""
    return axpy(inverse, load, axpy(inverse, torque, ω))


@njit(**INNER)
def kick_work(
    half: float, force: Vector, torque: Vector, v: Vector, change: Vector, before: Vector, ω: Vector
) -> float:
    """Work [J] of a force and a torque in half a step that ended at v and ω.

    With the mean of both ends' velocities, work is exactly the kinetic energy that it gives.
    """
    mean = axpy(-0.5, change, v)
    return half * (dot(force, mean) + 0.5 * dot(torque, axpy(1.0, ω, before)))


@njit(**INNER)
def kick_body(
    model: Model, state: State, i: int, half: float
) -> tuple[Vector, Vector, float, float]:
    """Half kick of a body that is no ball: change of v, new ω, and works [J]."""
    half_gravity, motion = scaled(half, vector(model.gravity, 0)), state.motion
    force, torque = row_vector(state.contact_load, i), row_vector(state.contact_load, i, 3)
    load_force, load_torque = row_vector(state.load, i), row_vector(state.load, i, 3)
    change = kick(half_gravity, half * model.inverse_mass[i], force, load_force)
    momentum = kick_rotation(row_vector(state.angular_momentum, i), half, torque, load_torque)
    if model.locked[i]:
        change, momentum = masked(model.free, i, 0, change), masked(model.free, i, 3, momentum)
        before = locked_angular_velocity(model, state, i)
    else:
        before = angular_velocity(state, i)
    v = axpy(1.0, change, row_vector(motion, i, VELOCITY))
    set_row_vector(state.angular_momentum, i, 0, momentum)
    if model.locked[i]:
        ω = locked_angular_velocity(model, state, i)
    else:
        ω = angular_velocity(state, i)
    set_row_vector(motion, i, VELOCITY, v)
    set_row_vector(motion, i, OMEGA, ω)
    work = kick_work(half, force, torque, v, change, before, ω)
    return change, ω, work, kick_work(half, load_force, load_torque, v, change, before, ω)
