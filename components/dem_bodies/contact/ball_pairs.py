"""Pairs of balls as kernels take them: constants, loads between blocks of rows, and history."""

import numpy as np

from quintet.components.dem_bodies.kernels.ball_pairs import (
    constants_of_pairs,
    index_outgoing,
    kinds_of_pairs,
    match_pairs,
)
from quintet.components.dem_bodies.state import (
    BallPairs,
    Model,
    Short,
    Whole,
    blocks_of,
)


def ball_pairs(model: Model, begin: Whole, partner: Short, records_forces: bool) -> BallPairs:
    """Pairs of these partners, without history."""
    rows, pairs, blocks = len(model.kind), len(partner), blocks_of(len(model.kind))
    row, earliest = np.empty(pairs, np.uint32), np.zeros(blocks, np.int64)
    ends = np.zeros(blocks + 1, np.int64), np.zeros(rows + 1, np.int64)
    incoming = index_outgoing(begin, partner, row, *ends, earliest)
    kinds = kinds_of_pairs(model, row, partner)
    _, some, constants_row = np.unique(kinds, return_index=True, return_inverse=True)
    rolls = bool(model.material_pairs[:, :, 4].any() and model.ball.any())
    return BallPairs(
        begin=begin,
        row=row,
        partner=partner,
        constants_row=constants_row.astype(np.uint32),
        constants=constants_of_pairs(model, row, partner, some),
        history=np.zeros((4, pairs)),
        rolling_moment=np.zeros((pairs, 3)) if rolls else None,
        force=np.zeros((pairs if rolls or records_forces else 0, 3)),
        outgoing=np.zeros((len(incoming), 6)),
        outgoing_begin=ends[0],
        incoming_begin=ends[1],
        incoming=incoming,
        earliest=earliest,
    )


def no_ball_pairs(model: Model) -> BallPairs | None:
    """Pairs of balls before any are listed; None if there are no balls."""
    if not model.ball.any():
        return None
    begin = np.zeros(np.count_nonzero(model.ball) + 1, np.int64)
    return ball_pairs(model, begin, np.zeros(0, np.uint32), False)


def transfer_history(old: BallPairs, old_body: Whole, new: BallPairs, body: Whole) -> None:
    """Take over the history of the pairs that touch."""
    source = np.empty(len(new.row), np.int64)
    before = (old.row, old.partner, old.history, old_body)
    match_pairs(*before, new.row, new.partner, body, source)
    known = np.flatnonzero(source)
    place = np.abs(source[known]) - 1
    # The force is that on the pair's first body, which may have become its second.
    swapped = known[source[known] < 0]
    new.history[:, known] = old.history[:, place]
    new.history[:3, swapped] *= -1.0
    if new.rolling_moment is not None and old.rolling_moment is not None:
        new.rolling_moment[known] = old.rolling_moment[place]
        new.rolling_moment[swapped] *= -1.0
