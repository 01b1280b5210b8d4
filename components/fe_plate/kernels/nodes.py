"""Nodes over a step: velocity Verlet, supports and rigid walls."""

import math

from numba import njit

from quintet.components.fe_plate.state import Model, State
from quintet.components.shared.numba_options import EXACT


@njit(**EXACT)
def kick_and_drift(model: Model, state: State, dt: float, damping: float, loading: float) -> float:
    """Advance velocities by half a step and positions by a whole one; return the loads' work [J].

    Parameters
    ----------
    model, state
    dt : float, s
    damping : float, 1/s
        α: velocities decay by exp(-α dt/4) here and at the step's end.
    loading : float, 1
        How many halves of the step the loads act in here: 1, or 2 for loads that were found at the
        step's beginning, as those of glued particles are.
    """
    decay, work = math.exp(-0.25 * damping * dt), 0.0
    for i in range(state.position.shape[0]):
        half = 0.5 * dt * model.inverse_mass[i]
        for d in range(3):
            v = decay * state.velocity[i, d]
            force = state.internal[i, d] + loading * state.load[i, d]
            v += half * force + 0.5 * dt * model.gravity[d]
            state.mean_velocity[i, d] = v * model.free[i, d]
        for w in range(model.walls.shape[0]):
            hold(i, w, model, state, dt)
        for d in range(3):
            v = state.mean_velocity[i, d]
            state.position[i, d] += dt * v
            work += dt * v * state.load[i, d]
    return work


@njit(**EXACT)
def hold(i, w, model, state, dt):  # type: ignore[no-untyped-def]
    """Keep a node from passing a rigid wall in this step, and book the impulse on the wall."""
    x, v, wall = state.position[i], state.mean_velocity[i], model.walls[w]
    gap = wall[0] * x[0] + wall[1] * x[1] + wall[2] * x[2] - wall[3]
    speed = wall[0] * v[0] + wall[1] * v[1] + wall[2] * v[2]
    if gap + dt * speed >= 0.0:
        return
    more = -gap / dt - speed
    for d in range(3):
        v[d] += more * wall[d] * model.free[i, d]
    state.wall_impulse[w] += more / model.inverse_mass[i]


@njit(**EXACT)
def kick(model: Model, state: State, dt: float, damping: float, loading: float) -> float:
    """Sum the elements' forces on nodes, advance velocities by half a step; return their sum.

    The sum of the squares of all velocities [m2/s2] is finite if all is well. `loading` is 1, or 0
    for loads that have acted already.
    """
    decay, squares = math.exp(-0.25 * damping * dt), 0.0
    flat = state.corner_force.reshape(-1, 3)
    for i in range(state.position.shape[0]):
        fx, fy, fz = 0.0, 0.0, 0.0
        for k in range(model.begin[i], model.begin[i + 1]):
            row = model.at[k]
            fx -= flat[row, 0]
            fy -= flat[row, 1]
            fz -= flat[row, 2]
        state.internal[i, 0], state.internal[i, 1], state.internal[i, 2] = fx, fy, fz
        half = 0.5 * dt * model.inverse_mass[i]
        for d in range(3):
            v = state.mean_velocity[i, d]
            force = state.internal[i, d] + loading * state.load[i, d]
            v += half * force + 0.5 * dt * model.gravity[d]
            v *= decay * model.free[i, d]
            state.velocity[i, d] = v
            squares += v * v
    return squares
