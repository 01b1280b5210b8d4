"""Nodes over a step: velocity Verlet, supports and rigid walls."""

import math

from numba import njit

from quintet.components.fe_plate.state import Array, Model, Parted, State
from quintet.components.shared.numba_options import EXACT


@njit(**EXACT)
def kick_and_drift(model: Model, state: State, dt: float, damping: float, loaded: bool) -> None:
    """Advance velocities by half a step and positions by a whole one; add the works on each node.

    The elements' forces are then none, for the elements to write them again.

    Parameters
    ----------
    model, state
    dt : float, s
    damping : float, 1/s
        α: velocities decay by exp(-α dt/4) here and at the step's end.
    loaded : bool
        Whether any load is not 0; if none is, loads are not read.
    """
    decay = math.exp(-0.25 * damping * dt)
    position, velocity, mean = state.position, state.velocity, state.mean_velocity
    forces, load, free = state.forces, state.load, model.free
    work, impulse, taken = state.load_work, state.wall_impulse, state.wall_work
    inverse, walls = model.inverse_mass, model.walls
    h, gravity = 0.5 * dt, model.gravity
    gx, gy, gz = h * gravity[0], h * gravity[1], h * gravity[2]
    for i in range(model.moving):
        half = 0.5 * dt * inverse[i]
        fx, fy, fz = 0.0, 0.0, 0.0
        if loaded:
            fx, fy, fz = load[i, 0], load[i, 1], load[i, 2]
        x, y, z = position[i, 0], position[i, 1], position[i, 2]
        u = (decay * velocity[i, 0] + half * (forces[i, 0] + fx) + gx) * free[i, 0]
        v = (decay * velocity[i, 1] + half * (forces[i, 1] + fy) + gy) * free[i, 1]
        w = (decay * velocity[i, 2] + half * (forces[i, 2] + fz) + gz) * free[i, 2]
        forces[i, 0], forces[i, 1], forces[i, 2] = 0.0, 0.0, 0.0
        mx, my, mz = decay * velocity[i, 0], decay * velocity[i, 1], decay * velocity[i, 2]
        for k in range(walls.shape[0]):
            a, b, c = walls[k, 0], walls[k, 1], walls[k, 2]
            gap = a * x + b * y + c * z - walls[k, 3]
            speed = a * u + b * v + c * w
            if gap + dt * speed < 0.0:
                more = -gap / dt - speed
                du, dv, dw = more * a * free[i, 0], more * b * free[i, 1], more * c * free[i, 2]
                impulse[i, k] += more / inverse[i]
                # Its impulse acts on the mean of the velocities, but for the kick: what pushed the
                # node into the wall in vain has done no work.
                along = du * (mx + 0.5 * du) + dv * (my + 0.5 * dv) + dw * (mz + 0.5 * dw)
                taken[i] += along / inverse[i]
                mx, my, mz = mx + du, my + dv, mz + dw
                u, v, w = u + du, v + dv, w + dw
        mean[i, 0], mean[i, 1], mean[i, 2] = u, v, w
        position[i, 0], position[i, 1], position[i, 2] = x + dt * u, y + dt * v, z + dt * w
        if fx != 0.0 or fy != 0.0 or fz != 0.0:
            work[i] += dt * (u * fx + v * fy + w * fz)


@njit(**EXACT)
def kick(
    model: Model, state: State, dt: float, damping: float, loaded: bool, ahead: float
) -> tuple[float, float]:
    """Advance velocities by half a step.

    Parameters
    ----------
    model, state
    dt : float, s
    damping : float, 1/s
    loaded : bool
        As of `kick_and_drift`.
    ahead : float, s
        How long before a node meets a rigid wall its speed counts.

    Returns
    -------
    float, m2/s2 : sum of the squares of all velocities, finite if all is well
    float, m/s : greatest speed towards a rigid wall that is about to be met
    """
    closing, decay, squares = 0.0, math.exp(-0.25 * damping * dt), 0.0
    velocity, mean, forces = state.velocity, state.mean_velocity, state.forces
    load, free, inverse = state.load, model.free, model.inverse_mass
    position, walls = state.position, model.walls
    h, gravity = 0.5 * dt, model.gravity
    gx, gy, gz = h * gravity[0], h * gravity[1], h * gravity[2]
    for i in range(model.moving):
        half = 0.5 * dt * inverse[i]
        fx, fy, fz = 0.0, 0.0, 0.0
        if loaded:
            fx, fy, fz = load[i, 0], load[i, 1], load[i, 2]
        u = (mean[i, 0] + half * (forces[i, 0] + fx) + gx) * (decay * free[i, 0])
        v = (mean[i, 1] + half * (forces[i, 1] + fy) + gy) * (decay * free[i, 1])
        w = (mean[i, 2] + half * (forces[i, 2] + fz) + gz) * (decay * free[i, 2])
        velocity[i, 0], velocity[i, 1], velocity[i, 2] = u, v, w
        squares += u * u + v * v + w * w
        for k in range(walls.shape[0]):
            a, b, c = walls[k, 0], walls[k, 1], walls[k, 2]
            gap = a * position[i, 0] + b * position[i, 1] + c * position[i, 2] - walls[k, 3]
            speed = -(a * u + b * v + c * w)
            if gap < speed * ahead:
                closing = max(closing, speed)
    return squares, closing


@njit(**EXACT)
def sum_parted(parted: Parted, forces: Array) -> None:
    """Sum the forces on nodes whose elements several threads have, and clear their rows.

    Parameters
    ----------
    parted : Parted
    forces : (rows, 3), N
    """
    node, begin = parted.node, parted.begin
    for i in range(node.shape[0]):
        fx, fy, fz = 0.0, 0.0, 0.0
        for row in range(begin[i], begin[i + 1]):
            fx += forces[row, 0]
            fy += forces[row, 1]
            fz += forces[row, 2]
            forces[row, 0], forces[row, 1], forces[row, 2] = 0.0, 0.0, 0.0
        forces[node[i], 0], forces[node[i], 1], forces[node[i], 2] = fx, fy, fz


@njit(**EXACT)
def add_damped(model: Model, state: State, share: float) -> None:
    """Add a share of each node's kinetic energy to what mass damping took [J]."""
    inverse, velocity, damped = model.inverse_mass, state.velocity, state.damped
    for i in range(model.moving):
        u, v, w = velocity[i, 0], velocity[i, 1], velocity[i, 2]
        damped[i] += share * (0.5 * (u * u + v * v + w * w) / inverse[i])
