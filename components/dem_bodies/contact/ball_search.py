"""Listing the pairs of balls, and of balls and planes, that may touch; rows sorted in space.

Rows are sorted by cell, so that the later rows that may be near a ball are five ranges of rows,
whose ends only move on from one ball to the next; and so that all that a step reads is near.
"""

from typing import NamedTuple

import numpy as np
from numba import njit

from quintet.components.dem_bodies.contact.ball_pairs import ball_pairs, bodies_of, transfer_history
from quintet.components.dem_bodies.contact.geometry import row_vector, sphere_plane
from quintet.components.dem_bodies.state import (
    RADIUS,
    BallPairs,
    Model,
    Numbers,
    Short,
    State,
    Whole,
)
from quintet.components.shared.numba_options import EXACT
from quintet.components.shared.rotations import dot, sub
from quintet.components.shared.search.cells import LAYER, ROW, keys_of

# First key, and how many follow, of each range of later rows that may be near.
AHEAD = ((0, 1), (ROW - 1, 2), (LAYER - ROW - 1, 2), (LAYER - 1, 2), (LAYER + ROW - 1, 2))


class Touching(NamedTuple):
    """Pairs of balls that touch, and of balls and planes."""

    bodies: Whole  # (k, 2); planes are the ground
    point: Numbers  # (k, 3) m
    normal: Numbers  # (k, 3) to the first body
    force: Numbers  # (k, 3) N, on the first body
    depth: Numbers  # (k,) m


class Sorted(NamedTuple):
    """Balls in the order of the keys of their cells."""

    keys: Whole  # (b,) rising
    width: float  # m, of a cell


@njit(**EXACT)
def list_partners(
    model: Model, motion: Numbers, keys: Whole, skin: float, begin: Whole, partner: Short
) -> int:
    """Write the partners of each row, while there is room, and where rows begin; count them."""
    planes, rows, count, found = model.plane.shape[0], motion.shape[0], keys.shape[0], 0
    low, high = np.zeros(5, np.int64), np.zeros(5, np.int64)
    for a in range(count):
        begin[a] = found
        x, radius = row_vector(motion, a), motion[a, RADIUS]
        for p in range(planes):
            if sphere_plane(x, radius, row_vector(model.plane, p), model.plane[p, 3])[0] < skin:
                if found < partner.shape[0]:
                    partner[found] = rows + p
                found += 1
        for k in range(5):
            first = keys[a] + AHEAD[k][0]
            last = first + AHEAD[k][1]
            while low[k] < count and keys[low[k]] < first:
                low[k] += 1
            while high[k] < count and keys[high[k]] <= last:
                high[k] += 1
            for b in range(max(low[k], a + 1), high[k]):
                d, near = sub(x, row_vector(motion, b)), radius + motion[b, RADIUS] + skin
                if dot(d, d) < near * near:
                    if found < partner.shape[0]:
                        partner[found] = b
                    found += 1
    begin[count] = found
    return found


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
    around: Sorted,
    old: BallPairs,
    old_body: Whole,
    skin: float,
    asked: bool,
) -> BallPairs:
    """List anew all pairs of balls, and of balls and planes, nearer than the skin [m]."""
    begin = np.empty(len(around.keys) + 1, np.int64)
    partner = np.empty(2 * len(old.partner) + 64, np.uint32)
    count = list_partners(model, state.motion, around.keys, skin, begin, partner)
    if count > len(partner):
        partner = np.empty(count, np.uint32)
        list_partners(model, state.motion, around.keys, skin, begin, partner)
    new = ball_pairs(model, begin, partner[:count].copy(), asked)
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
