"""Loops over the pairs of balls, and of balls and planes: depth, force, and what partners get.

Pairs go through a room, so many at once. What needs numbers of the pairs alone is computed for
several of them in one; only what rows hold is fetched and brought back pair by pair.
"""

import math

import numpy as np
from numba import njit

from quintet.components.dem_bodies.geometry import FAR, scaled, vector, write
from quintet.components.dem_bodies.laws import LEAST, beginning, contact
from quintet.components.dem_bodies.state import (
    BLOCK,
    BORNE,
    COLUMNS,
    DEEPEST,
    ELASTIC,
    END_V,
    END_W,
    GAP,
    STIFFEST,
    TALLIES,
    WHICH,
    Balls,
    Model,
    Numbers,
    Short,
    State,
    V,
    W,
)
from quintet.components.shared.rotations import INNER, Vector, beside, cross, dot, less

ROOM = 48  # pairs that are computed at once; all their numbers fit in the nearest cache
# The room has columns, one for each number of the pairs: the way from the partner, which becomes
# the normal; velocities over the partner's, which become those of the point of contact; angular
# velocities, which become torques; the force.
WAY, OVER, END_OVER, TURN, OTHER_TURN = 0, 3 * ROOM, 6 * ROOM, 9 * ROOM, 12 * ROOM
END_TURN, END_OTHER_TURN, SPRING, FORCE = 15 * ROOM, 18 * ROOM, 21 * ROOM, 24 * ROOM
LAW, BEFORE, REACH, RADIUS, DEPTH = 27 * ROOM, 34 * ROOM, 35 * ROOM, 36 * ROOM, 37 * ROOM
ROOT, QUARTER, WEIGHT, FIRST, OPENING = range(38 * ROOM, 43 * ROOM, ROOM)
# What each place in the room tallies over a block.
NEAREST, WORST, STIFF, ENERGY = range(43 * ROOM, 47 * ROOM, ROOM)
NUMBERS = 47
NONE = 0xFFFFFFFF  # no law


@njit(**INNER)
def column(room: Numbers, first: int) -> Vector:
    """Return three numbers of a pair."""
    return room[first], room[first + ROOM], room[first + 2 * ROOM]


@njit(**INNER)
def put(room: Numbers, first: int, a: Vector) -> None:
    """Write three numbers of a pair."""
    room[first], room[first + ROOM], room[first + 2 * ROOM] = a


@njit(**INNER)
def at(flat: Numbers, k: int) -> Vector:
    """Return three numbers from one on."""
    return flat[k], flat[k + 1], flat[k + 2]


@njit(**INNER)
def fetch(
    row: Short, partner: Short, plane: Numbers, motion: Numbers, held: Numbers, room: Numbers
) -> None:
    """Fetch what is held of the pairs and their rows; `motion` and `held` are flat."""
    rows = motion.shape[0] // COLUMNS
    ground = np.uint32(rows - 1)
    for c in range(row.shape[0]):
        b = partner[c]
        i, j = COLUMNS * row[c], COLUMNS * min(b, ground)
        x, radius = at(motion, i), motion[i + 3]
        if b <= ground:
            d = less(x, at(motion, j))
        else:
            n = vector(plane, b - rows)
            # Who is below the plane is as deep as can be.
            d = scaled(max(dot(n, x) - plane[b - rows, 3], 1e-9 * radius), n)
        put(room, WAY + c, d)
        room[RADIUS + c], room[REACH + c] = radius, radius + motion[j + 3]  # the ground has none
        put(room, OVER + c, less(at(motion, i + V), at(motion, j + V)))
        put(room, END_OVER + c, less(at(motion, i + END_V), at(motion, j + END_V)))
        put(room, TURN + c, at(motion, i + W))
        put(room, OTHER_TURN + c, at(motion, j + W))
        put(room, END_TURN + c, at(motion, i + END_W))
        put(room, END_OTHER_TURN + c, at(motion, j + END_W))
        put(room, SPRING + c, at(held, 4 * c))
        room[BEFORE + c] = held[4 * c + 3]


@njit(**INNER)
def know(law: Short, constants: Numbers, room: Numbers, whose: Short) -> None:
    """Fetch the constants of the pairs: mostly those of the pair before in this place."""
    for c in range(law.shape[0]):
        if whose[c] != law[c]:
            whose[c] = law[c]
            for number in range(7):
                room[LAW + number * ROOM + c] = constants[law[c], number]


@njit(**INNER)
def slip(v: Vector, turn: Vector, other: Vector, n: Vector, i: float, j: float) -> Vector:
    """Velocity [m/s] of a point at the arm -i n over another's at the arm j n."""
    return less(v, cross(beside(scaled(i, turn), j, other), n))


@njit(**INNER)
def measure(count: int, room: Numbers) -> None:
    """Normal, depth and its roots, and velocities of the point of contact."""
    for c in range(count):
        d, reach, radius = column(room, WAY + c), room[REACH + c], room[RADIUS + c]
        distance = math.sqrt(dot(d, d))
        n, depth = scaled(1.0 / max(distance, LEAST), d), reach - distance
        root = math.sqrt(max(depth, 0.0))
        i, j = radius - 0.5 * depth, reach - radius - 0.5 * depth
        turn, other = column(room, TURN + c), column(room, OTHER_TURN + c)
        end_turn, end_other = column(room, END_TURN + c), column(room, END_OTHER_TURN + c)
        end = slip(column(room, END_OVER + c), end_turn, end_other, n, i, j)
        put(room, WAY + c, n)
        put(room, OVER + c, slip(column(room, OVER + c), turn, other, n, i, j))
        put(room, END_OVER + c, end)
        room[DEPTH + c], room[ROOT + c], room[QUARTER + c] = depth, root, math.sqrt(root)
        room[WEIGHT + c], room[FIRST + c] = 1.0 / max(root, LEAST), 1.0
        room[OPENING + c] = dot(end, n)


@njit(**INNER)
def weigh(count: int, room: Numbers, dt: float) -> None:
    """Weigh the damping of the pairs that begin to touch."""
    for c in range(count):
        if room[BEFORE + c] == 0.0 and room[DEPTH + c] > 0.0:
            room[FIRST + c] = beginning(0.0, room[DEPTH + c], -room[OPENING + c], dt)


@njit(**INNER)
def bear(count: int, room: Numbers, dt: float) -> None:
    """Force, torques and history of the pairs, and what is tallied."""
    for c in range(count):
        law = (
            room[LAW + c], room[LAW + ROOM + c], room[LAW + 2 * ROOM + c],
            room[LAW + 3 * ROOM + c], room[LAW + 4 * ROOM + c], room[LAW + 5 * ROOM + c],
            room[LAW + 6 * ROOM + c],
        )  # fmt: skip
        depth, root, n = room[DEPTH + c], room[ROOT + c], column(room, WAY + c)
        radius, other = room[RADIUS + c], room[REACH + c] - room[RADIUS + c]
        force, spring, energy = contact(
            law, column(room, SPRING + c), room[BEFORE + c], n, max(depth, 0.0),
            (root, room[QUARTER + c], room[WEIGHT + c]), room[FIRST + c],
            column(room, OVER + c), column(room, END_OVER + c), dt,
        )  # fmt: skip
        t = cross(force, n)
        put(room, FORCE + c, force)
        put(room, SPRING + c, spring)
        room[BEFORE + c] = room[WEIGHT + c] if depth > 0.0 else 0.0
        put(room, TURN + c, scaled(radius - 0.5 * depth, t))
        put(room, OTHER_TURN + c, scaled(other - 0.5 * depth, t))
        low = min(radius, other) if other > 0.0 else radius
        room[NEAREST + c] = min(room[NEAREST + c], -depth)
        room[WORST + c] = max(room[WORST + c], depth / low)
        room[STIFF + c] = max(room[STIFF + c], law[5] * root)
        room[ENERGY + c] += energy


@njit(**INNER)
def bring(loads: Numbers, k: int, force: Vector, torque: Vector) -> None:
    """Add a force and a torque to the six numbers from k on."""
    loads[k] += force[0]
    loads[k + 1] += force[1]
    loads[k + 2] += force[2]
    loads[k + 3] += torque[0]
    loads[k + 4] += torque[1]
    loads[k + 5] += torque[2]


@njit(**INNER)
def share(
    row: Short, partner: Short, state: State, loads: Numbers, held: Numbers, pushes: Numbers,
    tally: Numbers, room: Numbers, block: int, slot: int,
) -> int:  # fmt: skip
    """Add the forces of the pairs to their rows, and keep those for later blocks.

    `slot` is where the first of these is kept; return where the next one is.
    """
    rows = state.motion.shape[0]
    end = min((block + 1) * BLOCK, rows)
    for c in range(row.shape[0]):
        a, b = row[c], partner[c]
        force, torque = column(room, FORCE + c), column(room, TURN + c)
        back, other = scaled(-1.0, force), column(room, OTHER_TURN + c)
        bring(loads, 6 * a, force, torque)
        if b < end:
            bring(loads, 6 * b, back, other)
        elif b < rows:
            write(pushes, slot, 0, back)
            write(pushes, slot, 3, other)
            slot += 1
        else:  # the ground's torque is about the origin
            turn = less(cross(force, vector(state.motion, a)), torque)
            for d in range(3):
                tally[block, BORNE + d] += back[d]
                tally[block, BORNE + 3 + d] += turn[d]
        held[4 * c], held[4 * c + 1], held[4 * c + 2] = column(room, SPRING + c)
        held[4 * c + 3] = room[BEFORE + c]
    return slot


@njit(**INNER)
def begin_block(state: State, tally: Numbers, room: Numbers, block: int) -> None:
    """Nothing is brought or tallied yet."""
    state.contact[block * BLOCK : (block + 1) * BLOCK] = 0.0
    tally[block, BORNE:TALLIES] = 0.0
    for c in range(min(ROOM, room.shape[0])):
        room[NEAREST + c] = FAR
        room[WORST + c], room[STIFF + c], room[ENERGY + c] = 0.0, 0.0, 0.0


@njit(**INNER)
def end_block(tally: Numbers, room: Numbers, block: int, pair: int) -> None:
    """Tally what all places in the room have; for the deepest pair stands any of the block."""
    nearest, worst, stiffest, energy = FAR, 0.0, 0.0, 0.0
    for c in range(min(ROOM, room.shape[0])):
        nearest, worst = min(nearest, room[NEAREST + c]), max(worst, room[WORST + c])
        stiffest, energy = max(stiffest, room[STIFF + c]), energy + room[ENERGY + c]
    tally[block, GAP], tally[block, DEEPEST], tally[block, WHICH] = nearest, worst, -1.0
    tally[block, STIFFEST], tally[block, ELASTIC] = stiffest, energy
    if worst > 0.0:
        tally[block, WHICH] = pair


@njit(**INNER)
def press_balls(
    first: int, last: int, model: Model, state: State, balls: Balls, tally: Numbers, dt: float
) -> None:
    """Press the blocks [first, last) of rows; rows that are no balls have no such pairs."""
    begin, count = balls.begin, balls.begin.shape[0] - 1
    # Flat, so that compilers know how far apart rows are.
    motion, held = state.motion.reshape(state.motion.size), balls.held.reshape(balls.held.size)
    loads = state.contact.reshape(state.contact.size)
    room = np.zeros(NUMBERS * ROOM if begin[count] > 0 else 0)
    whose = np.full(ROOM, NONE, np.uint32)
    for block in range(first, last):
        begin_block(state, tally, room, block)
        start, end = begin[min(block * BLOCK, count)], begin[min((block + 1) * BLOCK, count)]
        slot = balls.leave[block]
        for k in range(start, end, ROOM):
            to = min(k + ROOM, end)
            row, partner, kept = balls.row[k:to], balls.partner[k:to], held[4 * k : 4 * to]
            fetch(row, partner, model.plane, motion, kept, room)
            know(balls.law[k:to], balls.constants, room, whose)
            measure(to - k, room)
            weigh(to - k, room, dt)
            bear(to - k, room, dt)
            slot = share(row, partner, state, loads, kept, balls.push, tally, room, block, slot)
            if balls.force.shape[0] > 0:
                for c in range(to - k):
                    write(balls.force, k + c, 0, column(room, FORCE + c))
        end_block(tally, room, block, start)
