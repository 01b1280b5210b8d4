"""Loops over bodies and their spheres: the two halves of a velocity-Verlet step."""

import math

from numba import njit

from quintet.components.dem_bodies.state import FASTEST, HARDEST, WORK, Model, Numbers, State
from quintet.components.shared.rotations import (
    PURE,
    Matrix,
    Vector,
    backward,
    forward,
    matrix,
    turned,
)

ROUNDS = 20  # of the implicit midpoint rule, at most


@njit(**PURE)
def times(s: Numbers, x: float, y: float, z: float) -> Vector:
    """Symmetric matrix xx yy zz xy xz yz times a vector."""
    return (
        s[0] * x + s[3] * y + s[4] * z,
        s[3] * x + s[1] * y + s[5] * z,
        s[4] * x + s[5] * y + s[2] * z,
    )


@njit(**PURE)
def turning(inverse: Numbers, r: Matrix, x: float, y: float, z: float) -> Vector:
    """Angular velocity [rad/s] of a body with axes r and angular momentum (x, y, z)."""
    a, b, c = backward(r, x, y, z)
    a, b, c = times(inverse, a, b, c)
    return forward(r, a, b, c)


@njit(**PURE)
def turn(model: Model, state: State, i: int, dt: float) -> Vector:
    """Turn body i by the midpoint rule with its angular momentum; return the ω of the step.

    The rule is symmetric in time, so that the energy of a free body stays bounded.
    """
    q0, q1, q2, q3 = state.orientation[i]
    q = (q0, q1, q2, q3)
    x, y, z = state.spin[i]
    if model.isotropic[i]:
        inverse = model.inverse_inertia[i, 0]
        w = (inverse * x, inverse * y, inverse * z)
    else:
        inertia = model.inverse_inertia[i]
        w = turning(inertia, matrix(q), x, y, z)
        for _ in range(ROUNDS):
            h = 0.5 * dt
            new = turning(inertia, matrix(turned(q, h * w[0], h * w[1], h * w[2])), x, y, z)
            change = abs(new[0] - w[0]) + abs(new[1] - w[1]) + abs(new[2] - w[2])
            w = new
            if change <= 1e-15 * (abs(w[0]) + abs(w[1]) + abs(w[2])):
                break
    q = turned(q, dt * w[0], dt * w[1], dt * w[2])
    for k in range(4):
        state.orientation[i, k] = q[k]
    return w


@njit(**PURE)
def orient(model: Model, state: State, i: int) -> None:
    """Write the axes of body i and its inverse inertia in the world, R I⁻¹ Rᵀ."""
    q0, q1, q2, q3 = state.orientation[i]
    r = matrix((q0, q1, q2, q3))
    for k in range(9):
        state.axes[i, k] = r[k]
    if model.isotropic[i]:
        state.mobility[i] = model.inverse_inertia[i]
        return
    inertia = model.inverse_inertia[i]
    x = turning(inertia, r, 1.0, 0.0, 0.0)
    y = turning(inertia, r, 0.0, 1.0, 0.0)
    z = turning(inertia, r, 0.0, 0.0, 1.0)
    world = (x[0], y[1], z[2], y[0], z[0], z[1])
    for k in range(6):
        state.mobility[i, k] = world[k]


@njit(**PURE)
def drift(model: Model, state: State, dt: float) -> float:
    """Half kick, then move all bodies and spheres; return the largest (m²) way since the listing.

    Velocity and angular momentum are left at the middle of the step. Dampers need a velocity at
    its end: `rates` foresees it with the forces of its beginning, which keeps second order.
    """
    half = 0.5 * dt
    for i in range(model.reach.shape[0]):
        inverse = model.inverse_mass[i]
        for k in range(3):
            push = state.contact[i, k] + state.load[i, k]
            kick = half * (push * inverse + model.gravity[k])
            state.velocity[i, k] += kick
            state.spin[i, k] += half * (state.contact[i, 3 + k] + state.load[i, 3 + k])
            state.position[i, k] += dt * state.velocity[i, k]
            state.rates[i, k] = state.velocity[i, k]
            state.rates[i, 6 + k] = state.velocity[i, k] + kick
        mean = turn(model, state, i, dt)
        orient(model, state, i)
        x = state.spin[i, 0] + half * (state.contact[i, 3] + state.load[i, 3])
        y = state.spin[i, 1] + half * (state.contact[i, 4] + state.load[i, 4])
        z = state.spin[i, 2] + half * (state.contact[i, 5] + state.load[i, 5])
        ahead = times(state.mobility[i], x, y, z)
        for k in range(3):
            state.rates[i, 3 + k] = mean[k]
            state.rates[i, 9 + k] = ahead[k]
    return place(model, state)


@njit(**PURE)
def place(model: Model, state: State) -> float:
    """Put the spheres where their bodies are; return the largest (m²) way since the listing."""
    furthest = 0.0
    for s in range(model.sphere_body.shape[0]):
        i = model.sphere_body[s]
        x, y, z = model.sphere_centre[s]
        r = state.axes[i]
        p = state.position[i]
        a = p[0] + r[0] * x + r[1] * y + r[2] * z
        b = p[1] + r[3] * x + r[4] * y + r[5] * z
        c = p[2] + r[6] * x + r[7] * y + r[8] * z
        state.centre[s, 0], state.centre[s, 1], state.centre[s, 2] = a, b, c
        a -= state.listed[s, 0]
        b -= state.listed[s, 1]
        c -= state.listed[s, 2]
        way = a * a + b * b + c * c
        if not way <= furthest:  # also of what is not finite
            furthest = way
    return furthest


@njit(**PURE)
def finish(model: Model, state: State, before: Numbers, dt: float) -> None:
    """Half kick with the new forces; report the work of contacts and how fast points may move.

    `before` (n, 6) holds the contact forces at the step's beginning. With the velocity's mean of
    both ends, their work is exactly the kinetic energy that they give.
    """
    half = 0.5 * dt
    work, fastest, hardest = 0.0, 0.0, 0.0
    for i in range(model.reach.shape[0]):
        inverse = model.inverse_mass[i]
        v2, a2, w2, turn2 = 0.0, 0.0, 0.0, 0.0
        for k in range(3):
            old = before[i, k] + state.load[i, k]
            new = state.contact[i, k] + state.load[i, k]
            start = state.velocity[i, k] - half * (old * inverse + model.gravity[k])
            end = state.velocity[i, k] + half * (new * inverse + model.gravity[k])
            work += 0.5 * half * (before[i, k] + state.contact[i, k]) * (start + end)
            state.velocity[i, k] = end
            state.spin[i, k] += half * (state.contact[i, 3 + k] + state.load[i, 3 + k])
            v2 += end * end
            a2 += (state.load[i, k] * inverse + model.gravity[k]) ** 2
        x, y, z = state.spin[i]
        rate = times(state.mobility[i], x, y, z)
        x, y, z = state.load[i, 3:]
        spun = times(state.mobility[i], x, y, z)
        for k in range(3):
            mean = 0.5 * (state.angular_velocity[i, k] + rate[k])
            work += half * (before[i, 3 + k] + state.contact[i, 3 + k]) * mean
            state.angular_velocity[i, k] = rate[k]
            w2 += rate[k] * rate[k]
            turn2 += spun[k] * spun[k]
        reach = model.reach[i]
        speed = math.sqrt(v2) + reach * math.sqrt(w2)
        if not speed <= fastest:  # also of what is not finite
            fastest = speed
        hardest = max(hardest, math.sqrt(a2) + reach * (math.sqrt(turn2) + w2))
    state.report[WORK] = work
    state.report[FASTEST] = fastest
    state.report[HARDEST] = hardest


@njit(**PURE)
def kinetic(model: Model, state: State) -> float:
    """Kinetic energy [J] of all bodies."""
    energy = 0.0
    for i in range(model.reach.shape[0]):
        for k in range(3):
            energy += 0.5 * state.velocity[i, k] ** 2 / model.inverse_mass[i]
            energy += 0.5 * state.spin[i, k] * state.angular_velocity[i, k]
    return energy
