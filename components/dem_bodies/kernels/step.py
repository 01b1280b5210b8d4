"""Loops over bodies: the stages of a velocity-Verlet step."""

import math

from numba import njit

from quintet.components.dem_bodies.kernels.ball_contacts import ball_loads, begin_block
from quintet.components.dem_bodies.kernels.batch import batch_of
from quintet.components.dem_bodies.kernels.body_contacts import contact_loads, detect_contacts
from quintet.components.dem_bodies.kernels.reductions import reduce_bodies, reduce_pairs
from quintet.components.dem_bodies.kernels.velocity_verlet import drift, end_kick
from quintet.components.dem_bodies.state import (
    TOUCHING,
    TRAVEL,
    BallPairs,
    BodyPairs,
    Model,
    Numbers,
    State,
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
        reduce_bodies(state.report, state.contact_load, sums)
    return end


@njit(**EXACT)
def report_balls(report: Numbers, contact_load: Numbers, sums: Numbers) -> None:
    """Write the report of a step from the sums of all blocks; all bodies are balls."""
    reduce_pairs(report, sums)
    report[TOUCHING] = 0.0
    reduce_bodies(report, contact_load, sums)
