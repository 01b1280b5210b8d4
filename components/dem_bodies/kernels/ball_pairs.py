"""Pairs of balls: constants, loads between blocks of rows, and former pairs in contact."""

import numpy as np
from numba import njit

from quintet.components.dem_bodies.laws import pair_constants
from quintet.components.dem_bodies.state import (
    BLOCK,
    Model,
    Numbers,
    Short,
    Whole,
)
from quintet.components.shared.numba_options import EXACT


@njit(**EXACT)
def kinds_of_pairs(model: Model, row: Short, partner: Short) -> Whole:
    """Number of the kind of each pair, by the kinds of its balls, or of a ball and a plane."""
    rows, kinds = model.kind.shape[0], max(model.kind.max() + 1, model.material_pairs.shape[0])
    numbers = np.empty(partner.shape[0], np.int64)
    for k in range(partner.shape[0]):
        i, b = model.kind[row[k]], partner[k]
        if b < rows:
            j = model.kind[b]
            numbers[k] = min(i, j) * kinds + max(i, j)
        else:
            numbers[k] = kinds * (kinds + i) + model.plane_material[b - rows]
    return numbers


@njit(**EXACT)
def constants_of_pairs(model: Model, row: Short, partner: Short, some: Whole) -> Numbers:
    """Constants of some of the pairs: a plane is a ball without end."""
    rows = model.kind.shape[0]
    table = np.empty((some.shape[0], 7))
    for s in range(some.shape[0]):
        k = some[s]
        i, b = row[k], partner[k]
        radius, inverse, a = model.bounding_radius[i], model.inverse_mass[i], model.material[i]
        if b < rows:
            other = model.material[b]
            radius = 1.0 / (1.0 / radius + 1.0 / model.bounding_radius[b])
            inverse += model.inverse_mass[b]
        else:
            other = model.plane_material[b - rows]
        both = model.material_pairs[a, other]
        constants = pair_constants(both[0], both[1], both[2], both[3], radius, 1.0 / inverse)
        for n in range(7):  # to write a row at once takes a second longer to compile
            table[s, n] = constants[n]
    return table


@njit(**EXACT)
def bodies_of(row: int, partner: int, body: Whole) -> tuple[int, int]:
    """Body of a pair's row, and its partner: another body, or beyond all bodies a plane."""
    b = np.int64(partner)
    return int(body[row]), int(body[b] if b < body.shape[0] else b)


@njit(**EXACT)
def index_outgoing(
    begin: Whole, partner: Short, row: Short, outgoing_begin: Whole, incoming_begin: Whole,
    earliest: Whole,
) -> Short:  # fmt: skip
    """Write the row of each pair, and where loads between blocks stand; return `incoming`."""
    rows, sent = incoming_begin.shape[0] - 1, 0
    incoming_begin[:] = 0
    for block in range(earliest.shape[0]):
        earliest[block] = block
    for block in range(earliest.shape[0]):
        outgoing_begin[block] = sent
        for a in range(block * BLOCK, min((block + 1) * BLOCK, begin.shape[0] - 1)):
            for k in range(begin[a], begin[a + 1]):
                row[k], b = a, partner[k]
                if (block + 1) * BLOCK <= b < rows:
                    sent += 1
                    incoming_begin[b + 1] += 1
                    earliest[b // BLOCK] = min(earliest[b // BLOCK], block)
    outgoing_begin[earliest.shape[0]] = sent
    for a in range(rows):
        incoming_begin[a + 1] += incoming_begin[a]
    incoming, place, slot = np.empty(sent, np.uint32), incoming_begin.copy(), 0
    for k in range(partner.shape[0]):
        b = partner[k]
        if (row[k] // BLOCK + 1) * BLOCK <= b < rows:
            incoming[place[b]] = slot
            place[b] += 1
            slot += 1
    return incoming


@njit(**EXACT)
def match_pairs(
    old_row: Short, old_partner: Short, old_history: Numbers, old_body: Whole, row: Short,
    partner: Short, body: Whole, source: Whole,
) -> None:  # fmt: skip
    """Write which old pair in contact each new pair is, plus one; 0 if none.

    Less than 0: its first body has become its second.
    """
    bodies = body.shape[0]
    begin = np.zeros(bodies + 2, np.int64)
    for k in range(old_row.shape[0]):
        if old_history[3, k] != 0.0:
            begin[min(*bodies_of(old_row[k], old_partner[k], old_body)) + 2] += 1
    for i in range(bodies):
        begin[i + 2] += begin[i + 1]
    touching = np.empty(begin[bodies + 1], np.int64)
    for k in range(old_row.shape[0]):
        if old_history[3, k] != 0.0:
            i = min(*bodies_of(old_row[k], old_partner[k], old_body))
            touching[begin[i + 1]] = k
            begin[i + 1] += 1
    for k in range(row.shape[0]):
        i, j = bodies_of(row[k], partner[k], body)
        source[k] = 0
        for place in range(begin[min(i, j)], begin[min(i, j) + 1]):
            old = touching[place]
            p, q = bodies_of(old_row[old], old_partner[old], old_body)
            if max(p, q) == max(i, j):
                source[k] = old + 1 if p == i else -old - 1
