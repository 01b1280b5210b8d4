"""Listing the pairs of balls, and of balls and planes, that may touch; rows sorted in space.

Rows are sorted by cell, so that what a ball may meet among later rows is five ranges of rows,
whose ends only move on from one ball to the next; and so that all that a step reads is near.
"""

from typing import NamedTuple

import numpy as np
from numba import njit

from quintet.components.dem_bodies.cells import BITS, number
from quintet.components.dem_bodies.geometry import on_plane, vector
from quintet.components.dem_bodies.laws import constants
from quintet.components.dem_bodies.state import (
    BLOCK,
    Balls,
    Model,
    Numbers,
    Short,
    State,
    Whole,
    blocks_of,
)
from quintet.components.shared.rotations import PURE, dot, less

ROW, LAYER = 1 << BITS, 1 << 2 * BITS
# First of the cells that a range of later rows may be in, and how many follow.
AHEAD = ((0, 1), (ROW - 1, 2), (LAYER - ROW - 1, 2), (LAYER - 1, 2), (LAYER + ROW - 1, 2))


class Touched(NamedTuple):
    """Pairs of balls that touch, and of balls and planes."""

    bodies: Whole  # (k, 2); planes are the ground
    point: Numbers  # (k, 3) m
    normal: Numbers  # (k, 3) to the first body
    force: Numbers  # (k, 3) N, on the first body
    depth: Numbers  # (k,) m


class Sorted(NamedTuple):
    """Balls in the order of their cells."""

    cells: Whole  # (b,) rising
    width: float  # m, of a cell


@njit(**PURE)
def meet(
    model: Model, motion: Numbers, cells: Whole, skin: float, begin: Whole, partner: Short
) -> int:
    """Write the partners of each row, while there is room, and where rows begin; count them."""
    planes, rows, count, found = model.plane.shape[0], motion.shape[0], cells.shape[0], 0
    low, high = np.zeros(5, np.int64), np.zeros(5, np.int64)
    for a in range(count):
        begin[a] = found
        x, radius = vector(motion, a), motion[a, 3]
        for p in range(planes):
            if on_plane(x, radius, vector(model.plane, p), model.plane[p, 3])[0] < skin:
                if found < partner.shape[0]:
                    partner[found] = rows + p
                found += 1
        for k in range(5):
            first = cells[a] + AHEAD[k][0]
            last = first + AHEAD[k][1]
            while low[k] < count and cells[low[k]] < first:
                low[k] += 1
            while high[k] < count and cells[high[k]] <= last:
                high[k] += 1
            for b in range(max(low[k], a + 1), high[k]):
                d, near = less(x, vector(motion, b)), radius + motion[b, 3] + skin
                if dot(d, d) < near * near:
                    if found < partner.shape[0]:
                        partner[found] = b
                    found += 1
    begin[count] = found
    return found


@njit(**PURE)
def laws_of(model: Model, row: Short, partner: Short) -> Whole:
    """Number of the law of each pair, by the kinds of its balls, or of a ball and a plane."""
    rows, kinds = model.kind.shape[0], max(model.kind.max() + 1, model.law.shape[0])
    numbers = np.empty(partner.shape[0], np.int64)
    for k in range(partner.shape[0]):
        i, b = model.kind[row[k]], partner[k]
        if b < rows:
            j = model.kind[b]
            numbers[k] = min(i, j) * kinds + max(i, j)
        else:
            numbers[k] = kinds * (kinds + i) + model.plane_material[b - rows]
    return numbers


@njit(**PURE)
def constants_of(model: Model, row: Short, partner: Short, some: Whole) -> Numbers:
    """Constants of some of the pairs: a plane is a partner without end."""
    rows = model.kind.shape[0]
    table = np.empty((some.shape[0], 7))
    for s in range(some.shape[0]):
        k = some[s]
        i, b = row[k], partner[k]
        radius, inverse, a = model.reach[i], model.inverse_mass[i], model.material[i]
        if b < rows:
            other, radius = model.material[b], 1.0 / (1.0 / radius + 1.0 / model.reach[b])
            inverse += model.inverse_mass[b]
        else:
            other = model.plane_material[b - rows]
        modulus, shear = model.law[a, other, 0], model.law[a, other, 1]
        ζ, μ = model.law[a, other, 2], model.law[a, other, 3]
        table[s] = constants(modulus, shear, ζ, μ, radius, 1.0 / inverse)
    return table


def ends(balls: Balls, body: Whole) -> tuple[Whole, Whole]:
    """Body of each pair, and its partner: another body, or beyond all bodies a plane."""
    first = body[balls.row]
    partner = balls.partner.astype(np.int64)
    near = partner < len(body)
    partner[near] = body[partner[near]]
    return first, partner


def carry(old: Balls, old_body: Whole, new: Balls, body: Whole) -> None:
    """Take over the history of the pairs that touch."""
    touching = np.flatnonzero(old.held[:, 3])
    first, second = (end[touching] for end in ends(old, old_body))
    key = np.minimum(first, second) << 32 | np.maximum(first, second)
    order = np.argsort(key)
    key, touching, first = key[order], touching[order], first[order]
    new_first, new_second = ends(new, body)
    wanted = np.minimum(new_first, new_second) << 32 | np.maximum(new_first, new_second)
    place = np.searchsorted(key, wanted)
    known = np.flatnonzero(place < len(key))
    known = known[key[place[known]] == wanted[known]]
    source = place[known]
    new.held[known] = old.held[touching[source]]
    # The force is that on the pair's first body, which may have become its second.
    swapped = known[first[source] != new_first[known]]
    new.held[swapped, :3] *= -1.0
    if new.roll.size and len(old.roll):
        new.roll[known] = old.roll[touching[source]]
        new.roll[swapped] *= -1.0


def balls_from(model: Model, begin: Whole, partner: Short, asked: bool) -> Balls:
    """Pairs of given partners, without history; whether their forces are `asked` for."""
    rows, pairs = len(model.kind), len(partner)
    row = np.repeat(np.arange(len(begin) - 1, dtype=np.uint32), np.diff(begin))
    _, some, law = np.unique(laws_of(model, row, partner), return_index=True, return_inverse=True)
    leaves = (partner < rows) & (partner // BLOCK > row // BLOCK)
    towards, blocks = partner[leaves], np.arange(blocks_of(rows) + 1)
    rolls = model.law[:, :, 4].any()
    return Balls(
        begin=begin,
        row=row,
        partner=partner,
        law=law.astype(np.uint32),
        constants=constants_of(model, row, partner, some),
        held=np.zeros((pairs, 4)),
        roll=np.zeros((pairs if rolls else 0, 3)),
        force=np.zeros((pairs if rolls or asked else 0, 3)),
        push=np.zeros((len(towards), 6)),
        leave=np.searchsorted(row[leaves] // BLOCK, blocks),
        come=np.concatenate([[0], np.cumsum(np.bincount(towards, minlength=rows))]),
        coming=np.argsort(towards, kind="stable").astype(np.uint32),
    )


def no_balls(model: Model) -> Balls:
    """Pairs of balls before any are listed."""
    begin = np.zeros(np.count_nonzero(model.ball) + 1, np.int64)
    return balls_from(model, begin, np.zeros(0, np.uint32), False)


def sorted_balls(model: Model, state: State, skin: float) -> tuple[Sorted, Whole]:
    """Return the balls' cells in rising order, and their present rows in that order."""
    balls = np.flatnonzero(model.ball[:-1])
    width = 2.0 * float(model.reach[balls].max(initial=0.0)) + skin
    cells = number(state.motion, balls, width)
    order = np.argsort(cells, kind="stable")
    return Sorted(cells[order], width), order


def listed_balls(
    model: Model,
    state: State,
    around: Sorted,
    old: Balls,
    old_body: Whole,
    skin: float,
    asked: bool,
) -> Balls:
    """List anew all pairs of balls, and of balls and planes, nearer than the skin [m]."""
    begin = np.empty(len(around.cells) + 1, np.int64)
    partner = np.empty(2 * len(old.partner) + 64, np.uint32)
    count = meet(model, state.motion, around.cells, skin, begin, partner)
    if count > len(partner):
        partner = np.empty(count, np.uint32)
        meet(model, state.motion, around.cells, skin, begin, partner)
    new = balls_from(model, begin, partner[:count].copy(), asked)
    carry(old, old_body, new, state.body)
    return new


def touched(model: Model, state: State, balls: Balls) -> Touched:
    """List the pairs that touched in the last step."""
    pairs, ground = np.flatnonzero(balls.held[:, 3]), len(state.body) - 1
    row, partner = balls.row[pairs], balls.partner[pairs].astype(np.int64)
    on_ground = partner > ground
    x, other = state.motion[row], state.motion[np.minimum(partner, ground)]
    way = x[:, :3] - other[:, :3]
    normal = way / np.maximum(np.linalg.norm(way, axis=1, keepdims=True), 1e-300)
    normal[on_ground] = model.plane[partner[on_ground] - ground - 1, :3]
    depth = balls.held[pairs, 3] ** -2
    bodies = state.body[np.column_stack([row, np.minimum(partner, ground)])]
    point = x[:, :3] - (x[:, 3] - 0.5 * depth)[:, None] * normal
    return Touched(bodies, point, normal, balls.force[pairs], depth)


def deepest(state: State, balls: Balls) -> tuple[int, int]:
    """Find the bodies of the pair that is deepest for its radius; a plane is beyond all bodies."""
    radius, weight = state.motion[:, 3], balls.held[:, 3]
    other = radius[np.minimum(balls.partner, len(radius) - 1)]  # the ground has none
    low = np.minimum(radius[balls.row], np.where(other > 0.0, other, np.inf))
    k = int(np.argmin(np.where(weight > 0.0, weight * np.sqrt(low), np.inf)))
    first, second = ends(balls, state.body)
    return int(first[k]), int(second[k])
