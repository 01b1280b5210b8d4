"""Loops over the pairs of balls, and of balls and planes: depth, force, and what partners get."""

import math

import numpy as np
from numba import njit

from quintet.components.dem_bodies.geometry import FAR, scaled, three, vector, write
from quintet.components.dem_bodies.laws import LEAST, beginning, contact
from quintet.components.dem_bodies.state import (
    BLOCK,
    BORNE,
    DEEPEST,
    ELASTIC,
    END_V,
    GAP,
    STIFFEST,
    TALLIES,
    WHICH,
    Balls,
    Model,
    Numbers,
    State,
    V,
)
from quintet.components.shared.rotations import INNER, Vector, beside, cross, dot, less

ROOM = 72  # pairs that are computed at once; a fixed length lets the compiler do several in one
# Where in the room each number of the pairs begins.
X, Y, Z, SQUARE, REACH, DEPTH, ROOT, QUARTER, WEIGHT, FIRST = range(0, 10 * ROOM, ROOM)
MEAN, END, HELD, BEFORE, LAW, FORCE, ENERGY = (
    10 * ROOM, 13 * ROOM, 16 * ROOM, 19 * ROOM, 20 * ROOM, 27 * ROOM, 30 * ROOM,
)  # fmt: skip
WHOSE = 31 * ROOM
NUMBERS = 32


@njit(**INNER)
def column(room: Numbers, first: int) -> Vector:
    """Return three numbers of a pair."""
    return room[first], room[first + ROOM], room[first + 2 * ROOM]


@njit(**INNER)
def put(room: Numbers, first: int, a: Vector) -> None:
    """Write three numbers of a pair."""
    room[first], room[first + ROOM], room[first + 2 * ROOM] = a


@njit(**INNER)
def against(motion: Numbers, a: int, b: int, first: int, n: Vector, i: float, j: float) -> Vector:
    """Velocity [m/s] of row a's point at the arm -i n over row b's at the arm j n."""
    v = less(three(motion, a, first), three(motion, b, first))
    turn = beside(scaled(i, three(motion, a, first + 3)), j, three(motion, b, first + 3))
    return less(v, cross(turn, n))


@njit(**INNER)
def face(first: int, last: int, model: Model, balls: Balls, motion: Numbers, room: Numbers) -> None:
    """Way from the partner and sum of the radii of the pairs [first, last)."""
    row, partner, plane, rows = balls.row, balls.partner, model.plane, motion.shape[0]
    for k in range(first, last):
        x, b, c = vector(motion, row[k]), partner[k], k - first
        radius = motion[row[k], 3]
        if b < rows:
            d, reach = less(x, vector(motion, b)), radius + motion[b, 3]
        else:
            n, reach = vector(plane, b - rows), radius
            # Who is below the plane is as deep as can be.
            d = scaled(max(dot(n, x) - plane[b - rows, 3], 1e-9 * radius), n)
        put(room, X + c, d)
        room[SQUARE + c], room[REACH + c] = dot(d, d), reach


@njit(**INNER)
def measure(count: int, room: Numbers) -> None:
    """Normal, depth and its roots, several pairs at once."""
    for c in range(count):
        distance = math.sqrt(room[SQUARE + c])
        inverse = 1.0 / max(distance, LEAST)
        depth = room[REACH + c] - distance
        root = math.sqrt(max(depth, 0.0))
        room[DEPTH + c], room[ROOT + c], room[QUARTER + c] = depth, root, math.sqrt(root)
        room[WEIGHT + c] = 1.0 / max(root, LEAST)
        room[X + c] *= inverse
        room[Y + c] *= inverse
        room[Z + c] *= inverse


@njit(**INNER)
def approach(
    first: int, last: int, balls: Balls, motion: Numbers, room: Numbers, dt: float
) -> None:
    """Velocities of the pairs [first, last), their history and constants."""
    row, partner, held, constants = balls.row, balls.partner, balls.held, balls.constants
    ground = motion.shape[0] - 1
    for k in range(first, last):
        c, a, b = k - first, row[k], min(partner[k], ground)
        depth, n = room[DEPTH + c], column(room, X + c)
        i, j = motion[a, 3] - 0.5 * depth, motion[b, 3] - 0.5 * depth
        end = against(motion, a, b, END_V, n, i, j)
        put(room, MEAN + c, against(motion, a, b, V, n, i, j))
        put(room, END + c, end)
        put(room, HELD + c, vector(held, k))
        room[BEFORE + c], room[FIRST + c] = held[k, 3], 1.0
        if held[k, 3] == 0.0:
            room[FIRST + c] = beginning(0.0, depth, -dot(end, n), dt)
        if room[WHOSE + c] != balls.law[k]:  # mostly still that of the pair before in this place
            room[WHOSE + c] = balls.law[k]
            for d in range(7):
                room[LAW + d * ROOM + c] = constants[balls.law[k], d]


@njit(**INNER)
def bear(count: int, room: Numbers, dt: float) -> None:
    """Force, history and energy, several pairs at once."""
    for c in range(count):
        law = (
            room[LAW + c], room[LAW + ROOM + c], room[LAW + 2 * ROOM + c],
            room[LAW + 3 * ROOM + c], room[LAW + 4 * ROOM + c], room[LAW + 5 * ROOM + c],
            room[LAW + 6 * ROOM + c],
        )  # fmt: skip
        depth, n = max(room[DEPTH + c], 0.0), column(room, X + c)
        roots = (room[ROOT + c], room[QUARTER + c], room[WEIGHT + c])
        force, held, energy = contact(
            law, column(room, HELD + c), room[BEFORE + c], n, depth, roots, room[FIRST + c],
            column(room, MEAN + c), column(room, END + c), dt,
        )  # fmt: skip
        put(room, FORCE + c, force)
        put(room, HELD + c, held)
        room[ENERGY + c] = energy


@njit(**INNER)
def bring(loads: Numbers, k: int, force: Vector, torque: Vector) -> None:
    """Add a force and a torque to a row."""
    loads[k, 0] += force[0]
    loads[k, 1] += force[1]
    loads[k, 2] += force[2]
    loads[k, 3] += torque[0]
    loads[k, 4] += torque[1]
    loads[k, 5] += torque[2]


@njit(**INNER)
def share(
    first: int, last: int, state: State, balls: Balls, tally: Numbers, room: Numbers, block: int,
    slot: int,
) -> int:  # fmt: skip
    """Add the forces of the pairs [first, last) to their rows, and keep those for later blocks.

    `slot` is where the first of these is kept; return where the next one is.
    """
    motion, contact, force_on, pushes = state.motion, state.contact, balls.force, balls.push
    row, partner, held, kept = balls.row, balls.partner, balls.held, balls.force.shape[0] > 0
    rows, ground, end = motion.shape[0], motion.shape[0] - 1, (block + 1) * BLOCK
    smallest, deepest, which = tally[block, GAP], tally[block, DEEPEST], tally[block, WHICH]
    energy, stiffest = tally[block, ELASTIC], tally[block, STIFFEST]
    for k in range(first, last):
        c, a, b = k - first, row[k], min(partner[k], ground)
        depth, root, n = room[DEPTH + c], room[ROOT + c], column(room, X + c)
        low = motion[a, 3] if partner[k] >= rows else min(motion[a, 3], motion[b, 3])
        if depth > deepest * low:
            deepest, which = depth / low, k
        smallest, energy = min(smallest, -depth), energy + room[ENERGY + c]
        stiffest = max(stiffest, room[LAW + 5 * ROOM + c] * root)
        force = column(room, FORCE + c)
        t = cross(force, n)
        i, j = motion[a, 3] - 0.5 * depth, motion[b, 3] - 0.5 * depth
        bring(contact, a, force, scaled(i, t))
        back = scaled(-1.0, force)
        if partner[k] >= rows:  # the ground's is about the origin
            turn = cross(force, beside(vector(motion, a), -i, n))
            for d in range(3):
                tally[block, BORNE + d] += back[d]
                tally[block, BORNE + 3 + d] += turn[d]
        elif b < end:
            bring(contact, b, back, scaled(j, t))
        else:
            write(pushes, slot, 0, back)
            write(pushes, slot, 3, scaled(j, t))
            slot += 1
        if kept:
            write(force_on, k, 0, force)
        write(held, k, 0, column(room, HELD + c))
        held[k, 3] = room[WEIGHT + c] if depth > 0.0 else 0.0
    tally[block, GAP], tally[block, DEEPEST], tally[block, WHICH] = smallest, deepest, which
    tally[block, ELASTIC], tally[block, STIFFEST] = energy, stiffest
    return slot


@njit(**INNER)
def press_balls(
    first: int, last: int, model: Model, state: State, balls: Balls, tally: Numbers, dt: float
) -> None:
    """Press the blocks [first, last) of rows; rows that are no balls have no such pairs."""
    begin, motion = balls.begin, state.motion
    count = begin.shape[0] - 1
    room = np.full(NUMBERS * ROOM if begin[count] > 0 else 0, -1.0)
    for block in range(first, last):
        state.contact[block * BLOCK : (block + 1) * BLOCK] = 0.0
        tally[block, BORNE:TALLIES] = 0.0
        tally[block, GAP], tally[block, DEEPEST], tally[block, WHICH] = FAR, 0.0, -1.0
        tally[block, ELASTIC], tally[block, STIFFEST] = 0.0, 0.0
        end, slot = begin[min((block + 1) * BLOCK, count)], balls.leave[block]
        for k in range(begin[min(block * BLOCK, count)], end, ROOM):
            last_pair = min(k + ROOM, end)
            face(k, last_pair, model, balls, motion, room)
            measure(last_pair - k, room)
            approach(k, last_pair, balls, motion, room, dt)
            bear(last_pair - k, room, dt)
            slot = share(k, last_pair, state, balls, tally, room, block, slot)
