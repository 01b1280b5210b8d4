"""Listing the pairs of balls, and of balls and planes, that may touch; rows sorted in space.

Rows are sorted by cell, so that the later rows that may be near a ball are five ranges of rows,
whose ends only move on from one ball to the next; and so that all that a step reads is near.
"""

from typing import NamedTuple

import numpy as np

from quintet.components.dem_bodies.contact.ball_pairs import ball_pairs, transfer_history
from quintet.components.dem_bodies.kernels.ball_lists import Sorted, list_partners
from quintet.components.dem_bodies.kernels.ball_pairs import bodies_of
from quintet.components.dem_bodies.state import (
    RADIUS,
    BallPairs,
    Model,
    Numbers,
    State,
    Whole,
)
from quintet.components.shared.search.cells import keys_of


class Touching(NamedTuple):
    """Pairs of balls that touch, and of balls and planes."""

    bodies: Whole  # (k, 2); planes are the ground
    point: Numbers  # (k, 3) m
    normal: Numbers  # (k, 3) to the first body
    force: Numbers  # (k, 3) N, on the first body
    depth: Numbers  # (k,) m


def sorted_balls(model: Model, state: State, skin: float) -> tuple[Sorted, Whole]:
    """Return the keys of the balls' cells in rising order, and their present rows in that order."""
    balls = np.flatnonzero(model.ball[:-1])
    width = 2.0 * float(model.bounding_radius[balls].max(initial=0.0)) + skin
    keys = keys_of(state.motion, balls, width)
    order = np.argsort(keys, kind="stable")
    return Sorted(keys[order], width), order


def list_ball_pairs(
    model: Model,
    state: State,
    cells: Sorted,
    old: BallPairs,
    old_body: Whole,
    skin: float,
    records_forces: bool,
    rows: slice | None = None,
    begin: Whole | None = None,
) -> BallPairs:
    """List all pairs of balls, and of balls and planes, nearer than the skin [m]; or of some rows.

    The history of `old` pairs is taken over: their rows are those of `old_body`. With `rows` comes
    `begin` (b + 1,), all zeros, into which is written where the pairs of these begin.
    """
    begin = np.empty(len(cells.keys) + 1, np.int64) if begin is None else begin
    partner = np.empty(2 * len(old.partner) + 64, np.uint32)
    first, last, _ = (rows or slice(None)).indices(len(cells.keys))
    arguments = first, last, model, state.motion, cells.keys, skin
    count = list_partners(*arguments, begin, partner)
    if count > len(partner):
        partner = np.empty(count, np.uint32)
        list_partners(*arguments, begin, partner)
    new = ball_pairs(model, begin, partner[:count].copy(), records_forces)
    transfer_history(old, old_body, new, state.body)
    return new


def touching_balls(model: Model, state: State, pairs: BallPairs) -> Touching:
    """List the pairs that touched in the last step."""
    some, ground = np.flatnonzero(pairs.history[3]), len(state.body) - 1
    row, partner = pairs.row[some], pairs.partner[some].astype(np.int64)
    on_ground = partner > ground
    x, other = state.motion[row], state.motion[np.minimum(partner, ground)]
    r_ij = x[:, :3] - other[:, :3]
    normal = r_ij / np.maximum(np.linalg.norm(r_ij, axis=1, keepdims=True), 1e-300)
    normal[on_ground] = model.plane[partner[on_ground] - ground - 1, :3]
    depth = pairs.history[3, some] ** -2
    bodies = state.body[np.column_stack([row, np.minimum(partner, ground)])]
    point = x[:, :3] - (x[:, RADIUS] - 0.5 * depth)[:, None] * normal
    return Touching(bodies, point, normal, pairs.force[some], depth)


def deepest_pair(state: State, pairs: BallPairs) -> tuple[int, int]:
    """Find the bodies of the pair that is deepest for its radius; a plane is beyond all bodies."""
    radius, inverse_root = state.motion[:, RADIUS], pairs.history[3]
    other = radius[np.minimum(pairs.partner, len(radius) - 1)]  # the ground has none
    low = np.minimum(radius[pairs.row], np.where(other > 0.0, other, np.inf))
    k = int(np.argmin(np.where(inverse_root > 0.0, inverse_root * np.sqrt(low), np.inf)))
    first, second = bodies_of(pairs.row[k], pairs.partner[k], state.body)
    return int(first), int(second)
