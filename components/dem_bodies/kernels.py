"""Loops over bodies and their spheres: the two halves of a velocity-Verlet step."""

import math

from numba import njit

from quintet.components.dem_bodies.contact_kernels import find, press
from quintet.components.dem_bodies.geometry import axes_of, vector
from quintet.components.dem_bodies.state import (
    FASTEST,
    GIVEN,
    HARDEST,
    WAY,
    WORK,
    Contacts,
    Model,
    Numbers,
    State,
)
from quintet.components.shared.rotations import (
    INNER,
    PURE,
    Matrix,
    Quaternion,
    Vector,
    backward,
    beside,
    dot,
    forward,
    less,
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
def turn(model: Model, state: State, dt: float) -> None:
    """Turn all bodies with their angular momenta; write ω, axes and R I⁻¹ Rᵀ."""
    inverse, orientation = model.inverse_inertia, state.orientation
    for i in range(model.reach.shape[0]):
        q = (orientation[i, 0], orientation[i, 1], orientation[i, 2], orientation[i, 3])
        spin = (state.spin[i, 0], state.spin[i, 1], state.spin[i, 2])
        even = model.isotropic[i]
        if even:
            w = times(inverse, i, spin[0], spin[1], spin[2])
        else:
            w = midpoint(inverse, i, q, spin, 0.5 * dt)
        q = turned(q, dt * w[0], dt * w[1], dt * w[2])
        r = matrix(q)
        for k in range(3):
            state.rates[i, 3 + k] = w[k]
        for k in range(4):
            orientation[i, k] = q[k]
        for k in range(9):
            state.axes[i, k] = r[k]
        if even:
            world = (inverse[i, 0], inverse[i, 1], inverse[i, 2], 0.0, 0.0, 0.0)
        else:
            x = turning(inverse, i, r, 1.0, 0.0, 0.0)
            y = turning(inverse, i, r, 0.0, 1.0, 0.0)
            z = turning(inverse, i, r, 0.0, 0.0, 1.0)
            world = (x[0], y[1], z[2], y[0], z[0], z[1])
        for k in range(6):
            state.mobility[i, k] = world[k]


@njit(**INNER)
def drift(model: Model, state: State, dt: float) -> None:
    """Half kick, then move all bodies and their spheres.

    Velocity and angular momentum are left at the middle of the step. Dampers need a velocity at
    its end: `rates` foresees it with the forces of its beginning, which keeps second order.
    """
    half = 0.5 * dt
    contact, load, rates, spin = state.contact, state.load, state.rates, state.spin
    velocity, position = state.velocity, state.position
    state.before[:] = contact
    for i in range(model.reach.shape[0]):
        for k in range(3):
            push = contact[i, k] + load[i, k]
            kick = half * (push * model.inverse_mass[i] + model.gravity[k])
            velocity[i, k] += kick
            spin[i, k] += half * (contact[i, 3 + k] + load[i, 3 + k])
            position[i, k] += dt * velocity[i, k]
            rates[i, k] = velocity[i, k]
            rates[i, 6 + k] = velocity[i, k] + kick
    turn(model, state, dt)
    for i in range(model.reach.shape[0]):
        x = spin[i, 0] + half * (contact[i, 3] + load[i, 3])
        y = spin[i, 1] + half * (contact[i, 4] + load[i, 4])
        z = spin[i, 2] + half * (contact[i, 5] + load[i, 5])
        ahead = times(state.mobility, i, x, y, z)
        for k in range(3):
            rates[i, 9 + k] = ahead[k]
    place(model, state)


@njit(**INNER)
def place(model: Model, state: State) -> None:
    """Put the spheres where their bodies are."""
    furthest = 0.0
    centre, listed, axes, position = state.centre, state.listed, state.axes, state.position
    for s in range(model.sphere_body.shape[0]):
        i = model.sphere_body[s]
        x, y, z = vector(model.sphere_centre, s)
        c = beside(vector(position, i), 1.0, forward(axes_of(axes, i), x, y, z))
        for k in range(3):
            centre[s, k] = c[k]
        d = less(c, vector(listed, s))
        way = dot(d, d)
        if not way <= furthest:  # also of what is not finite
            furthest = way
    state.report[WAY] = furthest


@njit(**INNER)
def finish(model: Model, state: State, dt: float) -> None:
    """Half kick with the new forces; report work done, and how fast points may move.

    With the velocity's mean of both ends, work is exactly the kinetic energy that it gives.
    """
    half = 0.5 * dt
    before, contact, load, spin = state.before, state.contact, state.load, state.spin
    work, given, fastest, hardest = 0.0, 0.0, 0.0, 0.0
    for i in range(model.reach.shape[0]):
        inverse = model.inverse_mass[i]
        v2, a2, w2, turn2 = 0.0, 0.0, 0.0, 0.0
        for k in range(3):
            free = model.gravity[k] + load[i, k] * inverse
            start = state.velocity[i, k] - half * (before[i, k] * inverse + free)
            end = state.velocity[i, k] + half * (contact[i, k] * inverse + free)
            way = half * (start + end)
            work += 0.5 * (before[i, k] + contact[i, k]) * way
            given += load[i, k] * way
            state.velocity[i, k] = end
            spin[i, k] += half * (contact[i, 3 + k] + load[i, 3 + k])
            v2 += end * end
            a2 += free * free
        rate = times(state.mobility, i, spin[i, 0], spin[i, 1], spin[i, 2])
        spun = times(state.mobility, i, load[i, 3], load[i, 4], load[i, 5])
        for k in range(3):
            angle = half * (state.angular_velocity[i, k] + rate[k])
            work += 0.5 * (before[i, 3 + k] + contact[i, 3 + k]) * angle
            given += load[i, 3 + k] * angle
            state.angular_velocity[i, k] = rate[k]
            w2 += rate[k] * rate[k]
            turn2 += spun[k] * spun[k]
        reach = model.reach[i]
        speed = math.sqrt(v2) + reach * math.sqrt(w2)
        if not speed <= fastest:  # also of what is not finite
            fastest = speed
        hardest = max(hardest, math.sqrt(a2) + reach * (math.sqrt(turn2) + w2))
    state.report[WORK], state.report[GIVEN] = work, given
    state.report[FASTEST], state.report[HARDEST] = fastest, hardest


@njit(**PURE)
def kinetic(model: Model, state: State) -> float:
    """Kinetic energy [J] of all bodies."""
    energy = 0.0
    for i in range(model.reach.shape[0]):
        for k in range(3):
            energy += 0.5 * state.velocity[i, k] ** 2 / model.inverse_mass[i]
            energy += 0.5 * state.spin[i, k] * state.angular_velocity[i, k]
    return energy


@njit(**PURE)
def resolve(model: Model, state: State, contacts: Contacts, dt: float) -> None:
    """Let contacts press on the bodies where they now are, and end the step."""
    press(model, state, contacts, find(model, state, contacts), dt)
    finish(model, state, dt)


@njit(**PURE)
def advance(model: Model, state: State, contacts: Contacts, dt: float, limit: float) -> bool:
    """Step, unless a sphere has gone further (m²) than `limit`: then stop before the contacts."""
    drift(model, state, dt)
    if not state.report[WAY] <= limit:
        return False
    resolve(model, state, contacts, dt)
    return True
