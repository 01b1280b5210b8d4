"""Loops over bodies: the stages of a velocity-Verlet step, and copies of its result."""

import math

from numba import njit

from quintet.components.dem_bodies.kernels.ball_contacts import ball_loads, begin_block
from quintet.components.dem_bodies.kernels.batch import batch_of
from quintet.components.dem_bodies.kernels.body_contacts import contact_loads, detect_contacts
from quintet.components.dem_bodies.kernels.geometry import (
    row_vector,
    set_row_vector,
)
from quintet.components.dem_bodies.kernels.reductions import reduce_bodies, reduce_pairs
from quintet.components.dem_bodies.kernels.velocity_verlet import drift, end_kick
from quintet.components.dem_bodies.state import (
    OMEGA,
    TOUCHING,
    TRAVEL,
    VELOCITY,
    BallPairs,
    BodyPairs,
    Model,
    Numbers,
    State,
    Whole,
)
from quintet.components.shared.numba_options import EXACT
from quintet.components.shared.search.verlet_list import slack

# The stages of a step. Drift, balls and kick are shared out among threads.
DRIFT, BALLS, OTHERS, KICK, REPORT, DONE = range(6)
LIST = -1  # in place of a stage: pairs must be listed again first


@njit(**EXACT)
def step(
    first: int, last: int, begin: int, end: int, model: Model, state: State,
    balls: BallPairs | None, others: BodyPairs, sums: Numbers, dt: float, loaded: bool,
    skin: float,
) -> int:  # fmt: skip
    """Run the stages [begin, end) of a velocity-Verlet step for the blocks [first, last).

    One thread runs all stages in one call; several threads share out the blocks stage by stage.
    No bit depends on it: all sums are rounded block by block, and a row gets the loads of
    earlier blocks in the order of the pairs.

    Parameters
    ----------
    first, last : int
        Blocks of rows.
    begin, end : int
        Stages, from DRIFT up to DONE.
    model, state, balls, others
        All bodies and their pairs. Without `balls` what moves balls is not compiled.
    sums : (blocks, SUMS)
        Extremes and sums of each block.
    dt : float, s
    loaded : bool
        Whether any body has a load.
    skin : float, m
        Distance within which pairs are listed.

    Returns
    -------
    int
        The next stage, or LIST: only the drift was done; pairs must be listed again.
    """
    alone = others.key.shape[0] == 0
    if begin <= DRIFT < end:
        drift(first, last, model, state, balls, sums, dt, loaded)
    if begin <= BALLS < end:
        if not slack(skin, math.sqrt(sums[:, TRAVEL].max())) >= 0.0:
            return LIST
        if balls is None:
            for block in range(first, last):
                begin_block(state, sums, block)
        else:
            batch, constants_of = batch_of(balls)
            for block in range(first, last):
                moment = balls.rolling_moment
                ball_loads(block, model, state, balls, moment, sums, batch, constants_of, dt)
                # As soon as all its loads have come, while it is in the nearest cache.
                if alone and balls.earliest[block] >= first:
                    end_kick(block, model, state, balls, sums, dt, loaded)
    if begin <= OTHERS < end:
        reduce_pairs(state.report, sums)
        ahead = 0
        if balls is not None:
            ahead = balls.partner.shape[0]
        count = detect_contacts(model, state, others, ahead)
        state.report[TOUCHING] = count
        contact_loads(model, state, others, count, dt)
    if begin <= KICK < end:
        for block in range(first, last):
            if balls is None:
                end_kick(block, model, state, balls, sums, dt, loaded)
            elif not (alone and balls.earliest[block] >= first):
                end_kick(block, model, state, balls, sums, dt, loaded)
    if begin <= REPORT < end:
        reduce_bodies(state, sums)
    return end


@njit(**EXACT)
def copy_motion(
    row: Whole, motion: Numbers, orientations: Numbers, position: Numbers, velocity: Numbers,
    orientation: Numbers, angular_velocities: Numbers,
) -> None:  # fmt: skip
    """Copy out the motion of all bodies, in the scene's order."""
    for k in range(position.shape[0]):
        i = row[k]
        set_row_vector(position, k, 0, row_vector(motion, i))
        set_row_vector(velocity, k, 0, row_vector(motion, i, VELOCITY))
        set_row_vector(angular_velocities, k, 0, row_vector(motion, i, OMEGA))
        for d in range(4):
            orientation[k, d] = orientations[i, d]
