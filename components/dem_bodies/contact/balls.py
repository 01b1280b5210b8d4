"""Loops over the pairs of balls, and of balls and planes: depth, force, and loads on both rows.

Pairs are computed in batches. What needs numbers of the pairs alone is computed for several of
them at once; only what is read from rows and added to them goes pair by pair.
"""

import math

import numpy as np
from numba import njit

from quintet.components.dem_bodies.contact.geometry import (
    FAR,
    row_vector,
    set_row_vector,
    set_vector,
    vector,
)
from quintet.components.dem_bodies.contact.rolling_resistance import rolling_moments
from quintet.components.dem_bodies.laws import LEAST, contact_force, damping_weight
from quintet.components.dem_bodies.state import (
    BLOCK,
    COLUMNS,
    DEEPEST,
    DEEPEST_PAIR,
    ELASTIC_ENERGY,
    END_OMEGA,
    END_VELOCITY,
    GROUND_LOAD,
    OMEGA,
    RADIUS,
    SMALLEST_GAP,
    STIFFEST,
    SUMS,
    VELOCITY,
    BallPairs,
    Model,
    Numbers,
    Short,
    State,
)
from quintet.components.shared.numba_options import INNER
from quintet.components.shared.rotations import Vector, axpy, cross, dot, scaled, sub

BATCH = 48  # pairs that are computed at once; all their numbers fit in the nearest cache
# A batch has columns, one for each number of the pairs: r_ij, which becomes the normal; velocities
# of i over j, which become those of the point of contact; angular velocities, which become
# torques; the elastic tangential force; the force.
R_IJ, V_IJ, END_V_IJ, OMEGA_I, OMEGA_J = 0, 3 * BATCH, 6 * BATCH, 9 * BATCH, 12 * BATCH
END_OMEGA_I, END_OMEGA_J, TANGENTIAL, FORCE = 15 * BATCH, 18 * BATCH, 21 * BATCH, 24 * BATCH
TORQUE_I, TORQUE_J = OMEGA_I, OMEGA_J
CONSTANTS, BEFORE, RADII, RADIUS_I = 27 * BATCH, 34 * BATCH, 35 * BATCH, 36 * BATCH
DEPTH, ROOT, QUARTER, INVERSE_ROOT, WEIGHT, OPENING = range(37 * BATCH, 43 * BATCH, BATCH)
# Extremes and sums of each place in the batch over a block.
LEAST_GAP, MOST_DEPTH, MOST_STIFFNESS, ENERGY = range(43 * BATCH, 47 * BATCH, BATCH)
NUMBERS = 47
NONE = 0xFFFFFFFF  # no row of constants


@njit(**INNER)
def column(batch: Numbers, first: int) -> Vector:
    """Return three numbers of a pair."""
    return batch[first], batch[first + BATCH], batch[first + 2 * BATCH]


@njit(**INNER)
def set_column(batch: Numbers, first: int, a: Vector) -> None:
    """Write three numbers of a pair."""
    batch[first], batch[first + BATCH], batch[first + 2 * BATCH] = a


@njit(**INNER)
def load_pairs(
    row: Short, partner: Short, plane: Numbers, motion: Numbers, history: Numbers, batch: Numbers
) -> None:
    """Read the motion of both rows and the history of pairs; both arrays are flat."""
    rows = motion.shape[0] // COLUMNS
    ground = np.uint32(rows - 1)
    for c in range(row.shape[0]):
        b = partner[c]
        i, j = COLUMNS * row[c], COLUMNS * min(b, ground)
        x, radius = vector(motion, i), motion[i + RADIUS]
        if b <= ground:
            d = sub(x, vector(motion, j))
        else:
            n = row_vector(plane, b - rows)
            # Who is below the plane is as deep as can be.
            d = scaled(max(dot(n, x) - plane[b - rows, 3], 1e-9 * radius), n)
        set_column(batch, R_IJ + c, d)
        batch[RADIUS_I + c] = radius
        batch[RADII + c] = radius + motion[j + RADIUS]  # the ground has none
        v_j, end_v_j = vector(motion, j + VELOCITY), vector(motion, j + END_VELOCITY)
        set_column(batch, V_IJ + c, sub(vector(motion, i + VELOCITY), v_j))
        set_column(batch, END_V_IJ + c, sub(vector(motion, i + END_VELOCITY), end_v_j))
        set_column(batch, OMEGA_I + c, vector(motion, i + OMEGA))
        set_column(batch, OMEGA_J + c, vector(motion, j + OMEGA))
        set_column(batch, END_OMEGA_I + c, vector(motion, i + END_OMEGA))
        set_column(batch, END_OMEGA_J + c, vector(motion, j + END_OMEGA))
        set_column(batch, TANGENTIAL + c, vector(history, 4 * c))
        batch[BEFORE + c] = history[4 * c + 3]


@njit(**INNER)
def load_constants(constants_row: Short, constants: Numbers, batch: Numbers, loaded: Short) -> None:
    """Read the constants of pairs: mostly those of the pair before in this place."""
    for c in range(constants_row.shape[0]):
        if loaded[c] != constants_row[c]:
            loaded[c] = constants_row[c]
            for number in range(7):
                batch[CONSTANTS + number * BATCH + c] = constants[constants_row[c], number]


@njit(**INNER)
def velocity_at_contact(
    v: Vector, ω_i: Vector, ω_j: Vector, n: Vector, i: float, j: float
) -> Vector:
    """Velocity [m/s] of a point at the arm -i n over another's at the arm j n."""
    return sub(v, cross(axpy(j, ω_j, scaled(i, ω_i)), n))


@njit(**INNER)
def pair_kinematics(count: int, batch: Numbers) -> None:
    """Normal, depth and its roots, and velocities of the point of contact."""
    for c in range(count):
        d, radii, radius = column(batch, R_IJ + c), batch[RADII + c], batch[RADIUS_I + c]
        distance = math.sqrt(dot(d, d))
        n, depth = scaled(1.0 / max(distance, LEAST), d), radii - distance
        root = math.sqrt(max(depth, 0.0))
        i, j = radius - 0.5 * depth, radii - radius - 0.5 * depth
        ω_i, ω_j = column(batch, OMEGA_I + c), column(batch, OMEGA_J + c)
        end_ω_i, end_ω_j = column(batch, END_OMEGA_I + c), column(batch, END_OMEGA_J + c)
        end = velocity_at_contact(column(batch, END_V_IJ + c), end_ω_i, end_ω_j, n, i, j)
        set_column(batch, R_IJ + c, n)
        mean = velocity_at_contact(column(batch, V_IJ + c), ω_i, ω_j, n, i, j)
        set_column(batch, V_IJ + c, mean)
        set_column(batch, END_V_IJ + c, end)
        batch[DEPTH + c], batch[ROOT + c], batch[QUARTER + c] = depth, root, math.sqrt(root)
        batch[INVERSE_ROOT + c], batch[WEIGHT + c] = 1.0 / max(root, LEAST), 1.0
        batch[OPENING + c] = dot(end, n)


@njit(**INNER)
def first_step_weights(count: int, batch: Numbers, dt: float) -> None:
    """Weight of the damping of the pairs that begin to touch."""
    for c in range(count):
        if batch[BEFORE + c] == 0.0 and batch[DEPTH + c] > 0.0:
            weight = damping_weight(0.0, batch[DEPTH + c], -batch[OPENING + c], dt)
            batch[WEIGHT + c] = weight


@njit(**INNER)
def pair_forces(count: int, batch: Numbers, dt: float) -> None:
    """Force, torques and history of the pairs; their extremes and energy."""
    for c in range(count):
        constants = (
            batch[CONSTANTS + c], batch[CONSTANTS + BATCH + c], batch[CONSTANTS + 2 * BATCH + c],
            batch[CONSTANTS + 3 * BATCH + c], batch[CONSTANTS + 4 * BATCH + c],
            batch[CONSTANTS + 5 * BATCH + c], batch[CONSTANTS + 6 * BATCH + c],
        )  # fmt: skip
        depth, root, n = batch[DEPTH + c], batch[ROOT + c], column(batch, R_IJ + c)
        radius, other = batch[RADIUS_I + c], batch[RADII + c] - batch[RADIUS_I + c]
        force, tangential, energy = contact_force(
            constants, column(batch, TANGENTIAL + c), batch[BEFORE + c], n, max(depth, 0.0),
            (root, batch[QUARTER + c], batch[INVERSE_ROOT + c]), batch[WEIGHT + c],
            column(batch, V_IJ + c), column(batch, END_V_IJ + c), dt,
        )  # fmt: skip
        t = cross(force, n)
        set_column(batch, FORCE + c, force)
        set_column(batch, TANGENTIAL + c, tangential)
        batch[BEFORE + c] = batch[INVERSE_ROOT + c] if depth > 0.0 else 0.0
        set_column(batch, TORQUE_I + c, scaled(radius - 0.5 * depth, t))
        set_column(batch, TORQUE_J + c, scaled(other - 0.5 * depth, t))
        low = min(radius, other) if other > 0.0 else radius
        batch[LEAST_GAP + c] = min(batch[LEAST_GAP + c], -depth)
        batch[MOST_DEPTH + c] = max(batch[MOST_DEPTH + c], depth / low)
        batch[MOST_STIFFNESS + c] = max(batch[MOST_STIFFNESS + c], constants[5] * root)
        batch[ENERGY + c] += energy


@njit(**INNER)
def add_load(loads: Numbers, k: int, force: Vector, torque: Vector) -> None:
    """Add a force and a torque to the six numbers from k on."""
    loads[k] += force[0]
    loads[k + 1] += force[1]
    loads[k + 2] += force[2]
    loads[k + 3] += torque[0]
    loads[k + 4] += torque[1]
    loads[k + 5] += torque[2]


@njit(**INNER)
def scatter_forces(
    row: Short, partner: Short, state: State, loads: Numbers, history: Numbers, outgoing: Numbers,
    sums: Numbers, batch: Numbers, block: int, slot: int,
) -> int:  # fmt: skip
    """Add the forces of the pairs to their rows, and keep those for later blocks.

    `slot` is where the first of these is kept; return where the next one is.
    """
    rows = state.motion.shape[0]
    end = min((block + 1) * BLOCK, rows)
    for c in range(row.shape[0]):
        a, b = row[c], partner[c]
        force, torque = column(batch, FORCE + c), column(batch, TORQUE_I + c)
        back, other = scaled(-1.0, force), column(batch, TORQUE_J + c)
        add_load(loads, 6 * a, force, torque)
        if b < end:
            add_load(loads, 6 * b, back, other)
        elif b < rows:
            set_row_vector(outgoing, slot, 0, back)
            set_row_vector(outgoing, slot, 3, other)
            slot += 1
        else:  # the ground's torque is about the origin
            turn = sub(cross(force, row_vector(state.motion, a)), torque)
            for d in range(3):
                sums[block, GROUND_LOAD + d] += back[d]
                sums[block, GROUND_LOAD + 3 + d] += turn[d]
        set_vector(history, 4 * c, column(batch, TANGENTIAL + c))
        history[4 * c + 3] = batch[BEFORE + c]
    return slot


@njit(**INNER)
def begin_block(state: State, sums: Numbers, batch: Numbers, block: int) -> None:
    """No load and no sum yet."""
    state.contact_load[block * BLOCK : (block + 1) * BLOCK] = 0.0
    sums[block, GROUND_LOAD:SUMS] = 0.0
    for c in range(min(BATCH, batch.shape[0])):
        batch[LEAST_GAP + c] = FAR
        batch[MOST_DEPTH + c], batch[MOST_STIFFNESS + c], batch[ENERGY + c] = 0.0, 0.0, 0.0


@njit(**INNER)
def end_block(sums: Numbers, batch: Numbers, block: int, pair: int) -> None:
    """Extremes and energy of a block; any pair of the block stands for the deepest."""
    gap, deepest, stiffest, energy = FAR, 0.0, 0.0, 0.0
    for c in range(min(BATCH, batch.shape[0])):
        gap, deepest = min(gap, batch[LEAST_GAP + c]), max(deepest, batch[MOST_DEPTH + c])
        stiffest, energy = max(stiffest, batch[MOST_STIFFNESS + c]), energy + batch[ENERGY + c]
    sums[block, SMALLEST_GAP], sums[block, DEEPEST], sums[block, DEEPEST_PAIR] = gap, deepest, -1.0
    sums[block, STIFFEST], sums[block, ELASTIC_ENERGY] = stiffest, energy
    if deepest > 0.0:
        sums[block, DEEPEST_PAIR] = pair


@njit(**INNER)
def batch_of(pairs: BallPairs) -> tuple[Numbers, Short]:
    """Make room for a batch, if there are pairs: its numbers, and whose constants it has."""
    count = pairs.partner.shape[0]
    return np.zeros(NUMBERS * BATCH if count > 0 else 0), np.full(BATCH, NONE, np.uint32)


@njit(**INNER)
def ball_loads(
    block: int, model: Model, state: State, pairs: BallPairs, rolling_moment: Numbers | None,
    sums: Numbers, batch: Numbers, loaded: Short, dt: float,
) -> None:  # fmt: skip
    """Contact loads [N, N m] of the pairs of a block; rows that are no balls have none.

    Parameters
    ----------
    block : int
        Number of the block of rows.
    model, state, pairs
        All bodies and their pairs; `state.contact_load` of the block is written, `pairs.history`
        and `pairs.outgoing` too.
    rolling_moment : (pairs, 3) N m, or None
        Elastic moment against rolling; without it there is no such resistance.
    sums : (blocks, SUMS)
        Extremes and sums of each block.
    batch, loaded
        As `batch_of` makes them.
    dt : float, s
    """
    begin, count = pairs.begin, pairs.begin.shape[0] - 1
    # Flat, so that compilers know how far apart rows are.
    motion, history = state.motion.reshape(state.motion.size), pairs.history.reshape(-1)
    loads = state.contact_load.reshape(state.contact_load.size)
    begin_block(state, sums, batch, block)
    start, end = begin[min(block * BLOCK, count)], begin[min((block + 1) * BLOCK, count)]
    slot = pairs.outgoing_begin[block]
    for k in range(start, end, BATCH):
        to = min(k + BATCH, end)
        row, partner, kept = pairs.row[k:to], pairs.partner[k:to], history[4 * k : 4 * to]
        load_pairs(row, partner, model.plane, motion, kept, batch)
        load_constants(pairs.constants_row[k:to], pairs.constants, batch, loaded)
        pair_kinematics(to - k, batch)
        first_step_weights(to - k, batch, dt)
        pair_forces(to - k, batch, dt)
        slot = scatter_forces(
            row, partner, state, loads, kept, pairs.outgoing, sums, batch, block, slot
        )
        if pairs.force.shape[0] > 0:
            for c in range(to - k):
                set_row_vector(pairs.force, k + c, 0, column(batch, FORCE + c))
    end_block(sums, batch, block, start)
    if rolling_moment is not None:
        rolling_moments(block, model, state, pairs, rolling_moment, sums, dt)
