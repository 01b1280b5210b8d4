"""Loops over bodies and their spheres: the two halves of a velocity-Verlet step."""

from numba import njit

from quintet.components.dem_bodies.ball_kernels import press_balls
from quintet.components.dem_bodies.contact_kernels import find, press
from quintet.components.dem_bodies.geometry import add, axes_of, scaled, three, vector, write
from quintet.components.dem_bodies.state import (
    BLOCK,
    CURVED,
    END_V,
    END_W,
    GIVEN,
    MOVING,
    PULLED,
    SPINNING,
    SPUN,
    TOUCHING,
    WAY,
    WORK,
    Balls,
    Contacts,
    Model,
    Numbers,
    State,
    V,
    W,
)
from quintet.components.dem_bodies.tallies import close, found, furthest
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
def place(model: Model, state: State, i: int) -> float:
    """Place the spheres of a body that is no ball; return the square of the longest way [m²]."""
    furthest = 0.0
    centre, listed, x = state.centre, state.listed, vector(state.motion, i)
    for s in range(model.sphere_from[i], model.sphere_from[i + 1]):
        a, b, d = vector(model.sphere_centre, s)
        c = beside(x, 1.0, forward(axes_of(state.axes, i), a, b, d))
        write(centre, s, 0, c)
        way = less(c, vector(listed, s))
        furthest = max(furthest, dot(way, way))
    return furthest


@njit(**INNER)
def push(model: Model, state: State, i: int, half: float, loaded: bool) -> Vector:
    """Half a step's change of velocity of row i."""
    inverse = half * model.inverse_mass[i]
    change = scaled(half, vector(model.fall, 0))
    change = beside(change, inverse, vector(state.contact, i))
    if loaded:
        change = beside(change, inverse, vector(state.load, i))
    write(state.motion, i, V, beside(three(state.motion, i, V), 1.0, change))
    return change


@njit(**INNER)
def twist_ball(
    model: Model, state: State, i: int, half: float, loaded: bool
) -> tuple[Vector, Vector]:
    """Half a step's kick of a ball's turning: ω before and after."""
    inverse, before = half * model.inverse_turn[i], three(state.motion, i, W)
    after = beside(before, inverse, three(state.contact, i, 3))
    if loaded:
        after = beside(after, inverse, three(state.load, i, 3))
    write(state.motion, i, W, after)
    return before, after


@njit(**INNER)
def twist(state: State, i: int, half: float, loaded: bool) -> tuple[Vector, Vector]:
    """Half a step's kick of the turning of any other body: ω before and after."""
    before = spun(state, i)
    add(state.spin, i, scaled(half, three(state.contact, i, 3)))
    if loaded:
        add(state.spin, i, scaled(half, three(state.load, i, 3)))
    after = spun(state, i)
    write(state.motion, i, W, after)
    return before, after


@njit(**INNER)
def works(
    state: State, i: int, half: float, change: Vector, before: Vector, after: Vector, loaded: bool
) -> tuple[float, float]:
    """Works [J] of contacts and loads on a row in half a step that ended now.

    With the mean of both ends' velocities, work is exactly the kinetic energy that it gives.
    """
    contact, load, given = state.contact, state.load, 0.0
    v, w = beside(three(state.motion, i, V), -0.5, change), beside(before, 1.0, after)
    if loaded:
        given = half * (dot(vector(load, i), v) + 0.5 * dot(three(load, i, 3), w))
    return half * (dot(vector(contact, i), v) + 0.5 * dot(three(contact, i, 3), w)), given


@njit(**INNER)
def drift(
    first: int, last: int, model: Model, state: State, tally: Numbers, dt: float, loaded: bool
) -> None:
    """Half kick, then move the bodies of the blocks [first, last) and their spheres.

    Velocity and angular momentum are left at the middle of the step. Dampers need a velocity at
    its end: it is foreseen with the forces of the step's beginning, which keeps second order.
    """
    half, bodies, others = 0.5 * dt, model.reach.shape[0], model.others.shape[0]
    motion, contact, load = state.motion, state.contact, state.load
    for block in range(first, last):
        furthest, work, given = 0.0, 0.0, 0.0
        start, end = block * BLOCK, min((block + 1) * BLOCK, bodies)
        for i in range(start, min(end, bodies - others)):
            change = push(model, state, i, half, loaded)
            before, w = twist_ball(model, state, i, half, loaded)
            done, gave = works(state, i, half, change, before, w, loaded)
            work, given = work + done, given + gave
            v = three(motion, i, V)
            x = beside(vector(motion, i), dt, v)
            write(motion, i, 0, x)
            write(motion, i, END_V, beside(v, 1.0, change))
            write(motion, i, END_W, less(scaled(2.0, w), before))
            roll(state, i, w, dt)
            if others > 0:
                write(state.centre, i, 0, x)
            way = less(x, vector(state.listed, i))
            furthest = max(furthest, dot(way, way))
        for i in range(max(start, bodies - others), end):
            change = push(model, state, i, half, loaded)
            before, w = twist(state, i, half, loaded)
            done, gave = works(state, i, half, change, before, w, loaded)
            work, given = work + done, given + gave
            v = three(motion, i, V)
            write(motion, i, 0, beside(vector(motion, i), dt, v))
            write(motion, i, END_V, beside(v, 1.0, change))
            write(motion, i, W, turn(model, state, i, dt))
            x, y, z = beside(vector(state.spin, i), half, three(contact, i, 3))
            x, y, z = beside((x, y, z), half, three(load, i, 3))
            write(motion, i, END_W, times(state.mobility, i, x, y, z))
            furthest = max(furthest, place(model, state, i))
        tally[block, WAY] = furthest
        tally[block, WORK], tally[block, GIVEN] = work, given


@njit(**INNER)
def gather(state: State, balls: Balls, i: int) -> None:
    """Add what pairs of earlier blocks brought row i."""
    contact, pushes = state.contact, balls.push
    fx, fy, fz, tx, ty, tz = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for c in range(balls.come[i], balls.come[i + 1]):
        k = balls.coming[c]
        fx, fy, fz = fx + pushes[k, 0], fy + pushes[k, 1], fz + pushes[k, 2]
        tx, ty, tz = tx + pushes[k, 3], ty + pushes[k, 4], tz + pushes[k, 5]
    contact[i, 0], contact[i, 1], contact[i, 2] = (
        contact[i, 0] + fx, contact[i, 1] + fy, contact[i, 2] + fz,
    )  # fmt: skip
    contact[i, 3], contact[i, 4], contact[i, 5] = (
        contact[i, 3] + tx, contact[i, 4] + ty, contact[i, 5] + tz,
    )  # fmt: skip


@njit(**INNER)
def finish(
    first: int, last: int, model: Model, state: State, balls: Balls, tally: Numbers, dt: float,
    loaded: bool,
) -> None:  # fmt: skip
    """Half kick with the new forces, of the rows of blocks [first, last); tally how fast all move.

    Rows get forces from rows before them only, so that blocks may be finished one by one.
    """
    half, bodies = 0.5 * dt, model.reach.shape[0]
    load, fall, motion = state.load, vector(model.fall, 0), state.motion
    for block in range(first, last):
        work, given = 0.0, 0.0
        moving, spinning, pulled, spinup, curved = 0.0, 0.0, dot(fall, fall), 0.0, 0.0
        for i in range(block * BLOCK, min((block + 1) * BLOCK, bodies)):
            gather(state, balls, i)
            change = push(model, state, i, half, loaded)
            if model.ball[i]:
                before, w = twist_ball(model, state, i, half, loaded)
            else:
                before, w = twist(state, i, half, loaded)
            done, gave = works(state, i, half, change, before, w, loaded)
            work, given = work + done, given + gave
            v, reach, turns = three(motion, i, V), motion[i, 3], dot(w, w)
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


@njit(**PURE)
def kinetic(model: Model, state: State) -> float:
    """Kinetic energy [J] of all bodies."""
    energy, motion = 0.0, state.motion
    for i in range(model.reach.shape[0]):
        v, w = three(motion, i, V), three(motion, i, W)
        energy += 0.5 * dot(v, v) / model.inverse_mass[i]
        if model.ball[i]:
            energy += 0.5 * dot(w, w) / model.inverse_turn[i]
        else:
            energy += 0.5 * dot(vector(state.spin, i), w)
    return energy


@njit(**PURE)
def spins(model: Model, state: State) -> Numbers:
    """Angular momentum [kg m²/s] of each row about its centre."""
    spin = state.spin.copy()
    for i in range(model.reach.shape[0]):
        if model.ball[i]:
            write(spin, i, 0, scaled(1.0 / model.inverse_turn[i], three(state.motion, i, W)))
    return spin


@njit(**PURE)
def moves(
    state: State, position: Numbers, velocity: Numbers, orientation: Numbers, turning: Numbers
) -> None:
    """Copy out the motion of all bodies, in the scene's order."""
    motion = state.motion
    for k in range(position.shape[0]):
        i = state.row[k]
        write(position, k, 0, vector(motion, i))
        write(velocity, k, 0, three(motion, i, V))
        write(turning, k, 0, three(motion, i, W))
        for d in range(4):
            orientation[k, d] = state.orientation[i, d]


@njit(**INNER)
def press_others(
    model: Model, state: State, balls: Balls, contacts: Contacts, tally: Numbers, dt: float
) -> None:
    """Report on the pairs of balls, and press all other pairs."""
    found(state, tally)
    count = find(model, state, contacts, balls.partner.shape[0])
    state.report[TOUCHING] = count
    press(model, state, contacts, count, dt)


@njit(**PURE)
def resolve(
    model: Model, state: State, balls: Balls, contacts: Contacts, tally: Numbers, dt: float,
    loaded: bool,
) -> None:  # fmt: skip
    """Let contacts press on the bodies where they now are, and end the step."""
    blocks = tally.shape[0]
    each = 1 if contacts.key.shape[0] == 0 else blocks  # finished while still in cache
    for block in range(0, blocks, each):
        press_balls(block, block + each, model, state, balls, tally, dt)
        if block + each == blocks:
            press_others(model, state, balls, contacts, tally, dt)
        finish(block, block + each, model, state, balls, tally, dt, loaded)
    close(state, tally)


@njit(**PURE)
def advance(
    model: Model, state: State, balls: Balls, contacts: Contacts, tally: Numbers, dt: float,
    loaded: bool, limit: float,
) -> bool:  # fmt: skip
    """Step, unless a sphere has gone further (m²) than `limit`: then stop before the contacts."""
    drift(0, tally.shape[0], model, state, tally, dt, loaded)
    if not furthest(state, tally) <= limit:
        return False
    resolve(model, state, balls, contacts, tally, dt, loaded)
    return True
