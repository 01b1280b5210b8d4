"""Lists of the pairs of which at least one body is no ball; those of balls are in ball_search."""

import numpy as np

from quintet.components.dem_bodies.kernels.ball_lists import Sorted
from quintet.components.dem_bodies.kernels.body_lists import list_keys, transfer_history
from quintet.components.dem_bodies.state import (
    EDGE_EDGE,
    FIRST,
    KIND,
    BodyPairs,
    Model,
    State,
    Whole,
    body_pairs,
)
from quintet.components.shared.search.cells import keys_of


def body_pairs_of(keys: Whole, old: BodyPairs) -> BodyPairs:
    """Pairs of sorted keys, with the history of the old ones."""
    new = body_pairs(len(keys))
    new.key[:] = keys
    new.begin[:] = np.searchsorted(keys, np.arange(5, dtype=np.int64) << KIND)
    transfer_history(old, new)
    return new


def with_sorted_rows(old: BodyPairs, order: Whole) -> BodyPairs:
    """Keep the history of pairs with balls, whose present rows (b,) are put in a new order."""
    if not len(old.key):
        return old
    key, mask = old.key.copy(), (1 << FIRST) - 1
    first = key >> FIRST & mask
    ball = np.flatnonzero((key >> KIND < EDGE_EDGE) & (first < len(order)))
    key[ball] += (np.argsort(order)[first[ball]] - first[ball]) << FIRST
    rising = np.argsort(key)
    return old._replace(key=key[rising], history=old.history[rising])


def list_body_pairs(
    model: Model, state: State, cells: Sorted | None, old: BodyPairs, skin: float
) -> BodyPairs:
    """List all pairs nearer than the skin [m] of which one body is no ball."""
    if not len(model.others):
        return old
    width = 2.0 * float(model.bounding_radius[model.others].max(initial=0.0)) + skin
    cell_keys = keys_of(state.motion, model.others, width)
    order = np.argsort(cell_keys, kind="stable")
    arguments = (model, state, cell_keys[order], model.others[order], cells, skin)
    keys = np.empty(2 * len(old.key) + 64, np.int64)
    count = list_keys(*arguments, keys)
    if count > len(keys):
        keys = np.empty(count, np.int64)
        list_keys(*arguments, keys)
    return body_pairs_of(np.sort(keys[:count]), old)
