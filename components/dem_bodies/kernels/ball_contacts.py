"""Loops over the pairs of balls, and of balls and planes: depth, force, and loads on both rows.

Pairs are computed in batches. What needs numbers of the pairs alone is computed for several of
them at once; only what is read from rows and added to them goes pair by pair.
"""

import math

from numba import njit

from quintet.components.dem_bodies.kernels.ball_laws import kinematics, relative_depth
from quintet.components.dem_bodies.kernels.batch import (
    BATCH,
    BEFORE,
    CONSTANTS,
    DEPTH,
    END_OMEGA_I,
    END_OMEGA_J,
    END_V_IJ,
    ENERGY,
    FORCE,
    INVERSE_ROOT,
    LEAST_GAP,
    MOST_DEPTH,
    MOST_STIFFNESS,
    OMEGA_I,
    OMEGA_J,
    OPENING,
    QUARTER,
    R_IJ,
    RADII,
    RADIUS_I,
    ROOT,
    TANGENTIAL,
    TORQUE_I,
    TORQUE_J,
    V_IJ,
    WEIGHT,
    column,
    load_constants,
    load_history,
    load_pairs,
    scatter_forces,
    set_column,
    store_history,
)
from quintet.components.dem_bodies.kernels.geometry import (
    FAR,
    set_row_vector,
)
from quintet.components.dem_bodies.kernels.rolling_resistance import rolling_moments
from quintet.components.dem_bodies.laws import LEAST, contact_force, damping_weight
from quintet.components.dem_bodies.state import (
    BLOCK,
    DEEPEST,
    DEEPEST_PAIR,
    ELASTIC_ENERGY,
    GROUND_LOAD,
    SMALLEST_GAP,
    STIFFEST,
    SUMS,
    BallPairs,
    Model,
    Numbers,
    Short,
    State,
)
from quintet.components.shared.numba_options import INNER
from quintet.components.shared.rotations import cross, dot, scaled


@njit(**INNER)
def pair_kinematics(count: int, batch: Numbers) -> None:
    """Normal, depth and its roots, and velocities of the point of contact."""
    for c in range(count):
        n, depth, root, mean, end = kinematics(
            column(batch, R_IJ + c), batch[RADII + c], batch[RADIUS_I + c],
            column(batch, V_IJ + c), column(batch, END_V_IJ + c),
            column(batch, OMEGA_I + c), column(batch, OMEGA_J + c),
            column(batch, END_OMEGA_I + c), column(batch, END_OMEGA_J + c),
        )  # fmt: skip
        set_column(batch, R_IJ + c, n)
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
        batch[LEAST_GAP + c] = min(batch[LEAST_GAP + c], -depth)
        relative = relative_depth(depth, radius, other)
        batch[MOST_DEPTH + c] = max(batch[MOST_DEPTH + c], relative)
        batch[MOST_STIFFNESS + c] = max(batch[MOST_STIFFNESS + c], constants[5] * root)
        batch[ENERGY + c] += energy


@njit(**INNER)
def begin_block(state: State, sums: Numbers, block: int) -> None:
    """No load, no contact and no sum yet."""
    load = state.contact_load
    for i in range(block * BLOCK, min((block + 1) * BLOCK, load.shape[0])):
        for k in range(6):
            load[i, k] = 0.0
    for k in range(GROUND_LOAD, SUMS):
        sums[block, k] = 0.0
    sums[block, SMALLEST_GAP], sums[block, DEEPEST], sums[block, DEEPEST_PAIR] = FAR, 0.0, -1.0
    sums[block, STIFFEST], sums[block, ELASTIC_ENERGY] = 0.0, 0.0


@njit(**INNER)
def begin_batch(batch: Numbers) -> None:
    """No extremes and no energy yet."""
    for c in range(min(BATCH, batch.shape[0])):
        batch[LEAST_GAP + c] = FAR
        batch[MOST_DEPTH + c], batch[MOST_STIFFNESS + c], batch[ENERGY + c] = 0.0, 0.0, 0.0


@njit(**INNER)
def end_block(sums: Numbers, batch: Numbers, block: int, pair: int) -> None:
    """Extremes and energy of a block; any pair of the block represents the deepest."""
    gap, deepest, stiffest, energy = FAR, 0.0, 0.0, 0.0
    for c in range(min(BATCH, batch.shape[0])):
        gap, deepest = min(gap, batch[LEAST_GAP + c]), max(deepest, batch[MOST_DEPTH + c])
        stiffest, energy = max(stiffest, batch[MOST_STIFFNESS + c]), energy + batch[ENERGY + c]
    sums[block, SMALLEST_GAP], sums[block, DEEPEST], sums[block, DEEPEST_PAIR] = gap, deepest, -1.0
    sums[block, STIFFEST], sums[block, ELASTIC_ENERGY] = stiffest, energy
    if deepest > 0.0:
        sums[block, DEEPEST_PAIR] = pair


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
    begin_block(state, sums, block)
    begin_batch(batch)
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
