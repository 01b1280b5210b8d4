"""Batches of pairs of balls: reading from rows and pairs, and adding to them, one by one."""

import numpy as np
from numba import njit

from quintet.components.dem_bodies.kernels.ball_laws import from_plane
from quintet.components.dem_bodies.kernels.geometry import (
    row_vector,
    set_row_vector,
    vector,
)
from quintet.components.dem_bodies.state import (
    BLOCK,
    COLUMNS,
    END_OMEGA,
    END_VELOCITY,
    GROUND_LOAD,
    OMEGA,
    RADIUS,
    VELOCITY,
    BallPairs,
    Numbers,
    Short,
)
from quintet.components.shared.numba_options import EXACT, INNER
from quintet.components.shared.rotations import Vector, cross, scaled, sub

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
            d = from_plane(x, radius, row_vector(plane, b - rows), plane[b - rows, 3])
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


@njit(**EXACT)
def batch_of(pairs: BallPairs) -> tuple[Numbers, Short]:
    """Make room for a batch, if there are pairs: its numbers, and whose constants it has."""
    count = pairs.partner.shape[0]
    return np.zeros(NUMBERS * BATCH if count > 0 else 0), np.full(BATCH, NONE, np.uint32)


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
