"""Loops over bodies and their spheres: the two halves of a velocity-Verlet step."""

import math

import numpy as np
from numba import njit

from quintet.components.dem_bodies.ball_kernels import END_V, V, press_balls
from quintet.components.dem_bodies.contact_kernels import find, press
from quintet.components.dem_bodies.geometry import FAR, add, axes_of, scaled, three, vector, write
from quintet.components.dem_bodies.state import (
    BLOCK,
    CURVED,
    DEEPEST,
    ELASTIC,
    FASTEST,
    GAP,
    GIVEN,
    HARDEST,
    MOVING,
    PULLED,
    SPINNING,
    SPUN,
    STIFFEST,
    TOUCHING,
    WAY,
    WHICH,
    WORK,
    Balls,
    Contacts,
    Model,
    Numbers,
    Scratch,
    State,
)
from quintet.components.dem_bodies.turning import roll, spun, times, turn
from quintet.components.shared.rotations import (
    INNER,
    PURE,
    Vector,
    beside,
    dot,
    forward,
    less,
)


@njit(**INNER)
def place(model: Model, state: State, i: int, keep: bool) -> float:
    """Return the square of the longest way [m²] of a body's spheres; `keep` their places."""
    furthest = 0.0
    centre, listed, x = state.centre, state.listed, vector(state.position, i)
    for s in range(model.sphere_from[i], model.sphere_from[i + 1]):
        c = x
        if not model.ball[i]:
            a, b, d = vector(model.sphere_centre, s)
            c = beside(x, 1.0, forward(axes_of(state.axes, i), a, b, d))
        if keep:
            centre[s, 0], centre[s, 1], centre[s, 2] = c
        way = less(c, vector(listed, s))
        furthest = max(furthest, dot(way, way))
    return furthest


@njit(**INNER)
def kick(
    model: Model, state: State, i: int, half: float, loaded: bool
) -> tuple[Vector, Vector, Vector, float, float]:
    """Half a step's kick of body i: change of velocity, ω before and after, works [J].

    With the mean of both ends' velocities, work is exactly the kinetic energy that it gives.
    """
    contact, load, inverse = state.contact, state.load, half * model.inverse_mass[i]
    force, torque = vector(contact, i), three(contact, i, 3)
    change = beside(scaled(half, vector(model.fall, 0)), inverse, force)
    v, before, given = vector(state.velocity, i), spun(model, state, i), 0.0
    add(state.spin, i, scaled(half, torque))
    if loaded:
        change = beside(change, inverse, vector(load, i))
        add(state.spin, i, scaled(half, three(load, i, 3)))
    add(state.velocity, i, change)
    after = spun(model, state, i)
    v, w = beside(v, 0.5, change), beside(before, 1.0, after)
    if loaded:
        given = half * (dot(vector(load, i), v) + 0.5 * dot(three(load, i, 3), w))
    return change, before, after, half * (dot(force, v) + 0.5 * dot(torque, w)), given


@njit(**INNER)
def drift(
    first: int, last: int, model: Model, state: State, scratch: Scratch, dt: float, loaded: bool
) -> None:
    """Half kick, then move the bodies of the blocks [first, last) and their spheres.

    Velocity and angular momentum are left at the middle of the step. Dampers need a velocity at
    its end: `motion` foresees it with the forces of its beginning, which keeps second order.
    """
    half, bodies, keep = 0.5 * dt, model.reach.shape[0], model.others.shape[0] > 0
    motion, contact, load = scratch.motion, state.contact, state.load
    for block in range(first, last):
        furthest, work, given = 0.0, 0.0, 0.0
        for i in range(block * BLOCK, min((block + 1) * BLOCK, bodies)):
            change, before, w, done, gave = kick(model, state, i, half, loaded)
            work, given = work + done, given + gave
            v = vector(state.velocity, i)
            add(state.position, i, scaled(dt, v))
            if model.ball[i]:
                roll(state, i, w, dt)
                ahead = less(scaled(2.0, w), before)
            else:
                w = turn(model, state, i, dt)
                x, y, z = beside(vector(state.spin, i), half, three(contact, i, 3))
                x, y, z = beside((x, y, z), half, three(load, i, 3))
                ahead = times(state.mobility, i, x, y, z)
            a = scratch.row[i]
            motion[a, 3] = model.reach[i]
            write(motion, a, 0, vector(state.position, i))
            write(motion, a, V, v)
            write(motion, a, V + 3, w)
            write(motion, a, END_V, beside(v, 1.0, change))
            write(motion, a, END_V + 3, ahead)
            furthest = max(furthest, place(model, state, i, keep))
        scratch.tally[block, WAY] = furthest
        scratch.tally[block, WORK], scratch.tally[block, GIVEN] = work, given


@njit(**INNER)
def gather(balls: Balls, scratch: Scratch, a: int, total: Numbers, i: int) -> None:
    """Write to row i of `total` what row a's own pairs brought it, and those of earlier rows."""
    sums, push = scratch.sums, balls.push
    fx, fy, fz, tx, ty, tz = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for c in range(balls.come[a], balls.come[a + 1]):
        k = balls.coming[c]
        fx, fy, fz = fx + push[k, 0], fy + push[k, 1], fz + push[k, 2]
        tx, ty, tz = tx + push[k, 3], ty + push[k, 4], tz + push[k, 5]
    total[i, 0], total[i, 1], total[i, 2] = sums[a, 0] + fx, sums[a, 1] + fy, sums[a, 2] + fz
    total[i, 3], total[i, 4], total[i, 5] = sums[a, 3] + tx, sums[a, 4] + ty, sums[a, 5] + tz


@njit(**INNER)
def finish(
    first: int, last: int, model: Model, state: State, balls: Balls, scratch: Scratch, dt: float,
    loaded: bool,
) -> None:  # fmt: skip
    """Half kick with the new forces, of the rows of blocks [first, last); tally how fast all move.

    Rows get forces from rows before them only, so that blocks may be finished one by one.
    """
    half, bodies = 0.5 * dt, model.reach.shape[0]
    load, fall, tally = state.load, vector(model.fall, 0), scratch.tally
    for block in range(first, last):
        work, given = 0.0, 0.0
        moving, spinning, pulled, spinup, curved = 0.0, 0.0, dot(fall, fall), 0.0, 0.0
        for a in range(block * BLOCK, min((block + 1) * BLOCK, bodies)):
            i = scratch.body[a]
            gather(balls, scratch, a, state.contact, i)
            _, _, w, done, gave = kick(model, state, i, half, loaded)
            work, given = work + done, given + gave
            write(state.angular_velocity, i, 0, w)
            v, reach, turns = vector(state.velocity, i), model.reach[i], dot(w, w)
            moving, spinning = max(moving, dot(v, v)), max(spinning, reach * reach * turns)
            curved = max(curved, reach * turns)
            if loaded:
                pull = beside(fall, model.inverse_mass[i], vector(load, i))
                up = times(state.mobility, i, load[i, 3], load[i, 4], load[i, 5])
                pulled, spinup = max(pulled, dot(pull, pull)), max(spinup, reach**2 * dot(up, up))
        tally[block, WORK] += work
        tally[block, GIVEN] += given
        tally[block, MOVING], tally[block, SPINNING] = moving, spinning
        tally[block, PULLED], tally[block, SPUN], tally[block, CURVED] = pulled, spinup, curved


@njit(**INNER)
def furthest(state: State, scratch: Scratch) -> float:
    """Report and return the square of the longest way [m²] since pairs were listed."""
    state.report[WAY] = scratch.tally[:, WAY].max()
    return float(state.report[WAY])


@njit(**INNER)
def found(state: State, scratch: Scratch) -> None:
    """Report what the pairs of balls tallied."""
    report, tally = state.report, scratch.tally
    report[GAP], report[DEEPEST], report[WHICH] = FAR, 0.0, -1.0
    report[ELASTIC], report[STIFFEST] = 0.0, 0.0
    for b in range(tally.shape[0]):
        report[GAP] = min(report[GAP], tally[b, GAP])
        if tally[b, DEEPEST] > report[DEEPEST]:
            report[DEEPEST], report[WHICH] = tally[b, DEEPEST], tally[b, WHICH]
        report[ELASTIC] += tally[b, ELASTIC]
        report[STIFFEST] = max(report[STIFFEST], tally[b, STIFFEST])


@njit(**INNER)
def close(state: State, balls: Balls, scratch: Scratch) -> None:
    """Report work done, and how fast points may move; give the ground what planes bear."""
    ground = state.contact.shape[0] - 1
    gather(balls, scratch, ground, state.contact, ground)
    report, tally = state.report, scratch.tally
    report[WORK], report[GIVEN] = 0.0, 0.0
    most = np.zeros(5)
    for b in range(tally.shape[0]):
        report[WORK] += tally[b, WORK]
        report[GIVEN] += tally[b, GIVEN]
        for k in range(5):
            most[k] = max(most[k], tally[b, MOVING + k])
    report[FASTEST] = math.sqrt(most[0]) + math.sqrt(most[1])
    report[HARDEST] = math.sqrt(most[2]) + math.sqrt(most[3]) + most[4]


@njit(**PURE)
def kinetic(model: Model, state: State) -> float:
    """Kinetic energy [J] of all bodies."""
    energy = 0.0
    for i in range(model.reach.shape[0]):
        for k in range(3):
            energy += 0.5 * state.velocity[i, k] ** 2 / model.inverse_mass[i]
            energy += 0.5 * state.spin[i, k] * state.angular_velocity[i, k]
    return energy


@njit(**INNER)
def press_others(
    model: Model, state: State, balls: Balls, contacts: Contacts, scratch: Scratch, dt: float
) -> None:
    """Report on the pairs of balls, and press all other pairs."""
    found(state, scratch)
    count = find(model, state, contacts, balls.partner.shape[0])
    state.report[TOUCHING] = count
    press(model, state, contacts, scratch, count, dt)


@njit(**PURE)
def resolve(
    model: Model, state: State, balls: Balls, contacts: Contacts, scratch: Scratch, dt: float,
    loaded: bool,
) -> None:  # fmt: skip
    """Let contacts press on the bodies where they now are, and end the step."""
    blocks = scratch.tally.shape[0]
    each = 1 if contacts.key.shape[0] == 0 else blocks  # finished while still in cache
    for block in range(0, blocks, each):
        press_balls(block, block + each, model, balls, scratch, dt)
        if block + each == blocks:
            press_others(model, state, balls, contacts, scratch, dt)
        finish(block, block + each, model, state, balls, scratch, dt, loaded)
    close(state, balls, scratch)


@njit(**PURE)
def advance(
    model: Model, state: State, balls: Balls, contacts: Contacts, scratch: Scratch, dt: float,
    loaded: bool, limit: float,
) -> bool:  # fmt: skip
    """Step, unless a sphere has gone further (m²) than `limit`: then stop before the contacts."""
    drift(0, scratch.tally.shape[0], model, state, scratch, dt, loaded)
    if not furthest(state, scratch) <= limit:
        return False
    resolve(model, state, balls, contacts, scratch, dt, loaded)
    return True
