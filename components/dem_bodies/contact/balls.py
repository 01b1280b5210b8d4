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
# torques; the elastic tangential force and 1/√δ, as in the history; the force.
R_IJ, V_IJ, END_V_IJ, OMEGA_I, OMEGA_J = 0, 3 * BATCH, 6 * BATCH, 9 * BATCH, 12 * BATCH
END_OMEGA_I, END_OMEGA_J, TANGENTIAL, BEFORE = 15 * BATCH, 18 * BATCH, 21 * BATCH, 24 * BATCH
TORQUE_I, TORQUE_J = OMEGA_I, OMEGA_J
FORCE, CONSTANTS, RADII, RADIUS_I = 25 * BATCH, 28 * BATCH, 35 * BATCH, 36 * BATCH
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
    first: int, count: int, row: Short, partner: Short, plane: Numbers, motion: Numbers,
    batch: Numbers,
) -> None:  # fmt: skip
    """Read the motion of both rows of the pairs from one on, from a flat array."""
    rows = motion.shape[0] // COLUMNS
    ground = np.uint32(rows - 1)
    for c in range(count):
        b = partner[first + c]
        i, j = COLUMNS * row[first + c], COLUMNS * min(b, ground)
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


@njit(**INNER)
def load_history(first: int, count: int, history: Numbers, batch: Numbers) -> None:
    """Read the history of the pairs from one on, a flat array, number by number."""
    pairs = history.shape[0] // 4
    for number in range(4):
        k = number * pairs + first
        for c in range(count):
            batch[TANGENTIAL + number * BATCH + c] = history[k + c]


@njit(**INNER)
def store_history(first: int, count: int, history: Numbers, batch: Numbers) -> None:
    """Write the history of the pairs from one on, a flat array, number by number."""
    pairs = history.shape[0] // 4
    for number in range(4):
        k = number * pairs + first
        for c in range(count):
            history[k + c] = batch[TANGENTIAL + number * BATCH + c]


@njit(**INNER)
def load_constants(
    first: int, count: int, constants_row: Short, constants: Numbers, batch: Numbers, loaded: Short
) -> None:
    """Read the constants of the pairs from one on, if these are not there already."""
    differ = np.uint32(0)
    for c in range(count):
        differ |= loaded[c] ^ constants_row[first + c]
    if differ == 0:
        return
    for c in range(count):
        k = constants_row[first + c]
        if loaded[c] != k:
            loaded[c] = k
            for number in range(7):
                batch[CONSTANTS + number * BATCH + c] = constants[k, number]


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
    begins = False
    for c in range(count):
        begins |= (batch[BEFORE + c] == 0.0) & (batch[DEPTH + c] > 0.0)
    if not begins:
        return
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
    first: int, count: int, row: Short, partner: Short, motion: Numbers, loads: Numbers,
    outgoing: Numbers, sums: Numbers, batch: Numbers, block: int, slot: int,
) -> int:  # fmt: skip
    """Add the forces of the pairs from one on to their rows, and keep those for later blocks.

    `motion` and `loads` are flat. `slot` is where the first of the kept is; return where the next
    one is.
    """
    rows = motion.shape[0] // COLUMNS
    end = min((block + 1) * BLOCK, rows)
    for c in range(count):
        a, b = row[first + c], partner[first + c]
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
            turn = sub(cross(force, vector(motion, COLUMNS * a)), torque)
            for d in range(3):
                sums[block, GROUND_LOAD + d] += back[d]
                sums[block, GROUND_LOAD + 3 + d] += turn[d]
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
    # Flat, so that compilers know how far apart rows are; and none is sliced in the loop, where
    # references to it would be counted.
    motion, history = state.motion.reshape(-1), pairs.history.reshape(-1)
    loads, plane, outgoing = state.contact_load.reshape(-1), model.plane, pairs.outgoing
    row, partner, constants_row = pairs.row, pairs.partner, pairs.constants_row
    constants, force, count = pairs.constants, pairs.force, pairs.begin.shape[0] - 1
    begin_block(state, sums, batch, block)
    start = pairs.begin[min(block * BLOCK, count)]
    end, slot = pairs.begin[min((block + 1) * BLOCK, count)], pairs.outgoing_begin[block]
    for k in range(start, end, BATCH):
        n = min(BATCH, end - k)
        load_pairs(k, n, row, partner, plane, motion, batch)
        load_history(k, n, history, batch)
        load_constants(k, n, constants_row, constants, batch, loaded)
        pair_kinematics(n, batch)
        first_step_weights(n, batch, dt)
        pair_forces(n, batch, dt)
        slot = scatter_forces(k, n, row, partner, motion, loads, outgoing, sums, batch, block, slot)
        store_history(k, n, history, batch)
        for c in range(n if force.shape[0] > 0 else 0):
            set_row_vector(force, k + c, 0, column(batch, FORCE + c))
    end_block(sums, batch, block, start)
    if rolling_moment is not None:
        rolling_moments(block, model, state, pairs, rolling_moment, sums, dt)
