"""Listing the pairs that may touch before some point has moved by half the skin.

Here are those of which one body at least is no ball; ball_search lists those of two balls, and of
a ball and a plane.
"""

import numpy as np

from quintet.components.dem_bodies.contact.ball_search import (
    list_ball_pairs,
    sorted_balls,
)
from quintet.components.dem_bodies.kernels.ball_lists import Sorted
from quintet.components.dem_bodies.kernels.body_lists import list_keys, transfer_history
from quintet.components.dem_bodies.state import (
    EDGE_EDGE,
    FIRST,
    KIND,
    BallPairs,
    BodyPairs,
    Model,
    State,
    Whole,
    body_pairs,
    sort_rows,
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
    model: Model, state: State, around: Sorted | None, old: BodyPairs, skin: float
) -> BodyPairs:
    """List anew all pairs nearer than the skin [m] that are not of balls and planes alone."""
    if not len(model.others):
        return old
    width = 2.0 * float(model.bounding_radius[model.others].max(initial=0.0)) + skin
    cell_keys = keys_of(state.motion, model.others, width)
    order = np.argsort(cell_keys, kind="stable")
    given = (model, state, cell_keys[order], model.others[order], around, skin)
    keys = np.empty(2 * len(old.key) + 64, np.int64)
    count = list_keys(*given, keys)
    if count > len(keys):
        keys = np.empty(count, np.int64)
        list_keys(*given, keys)
    return body_pairs_of(np.sort(keys[:count]), old)


def list_pairs(
    model: Model,
    state: State,
    balls: BallPairs | None,
    contacts: BodyPairs,
    skin: float,
    asked: bool,
) -> tuple[BallPairs | None, BodyPairs]:
    """Sort the rows, and list anew all pairs nearer than the skin [m]."""
    around = None
    if balls is not None:
        body, (around, order) = state.body.copy(), sorted_balls(model, state, skin)
        sort_rows(model, state, order)
        balls = list_ball_pairs(model, state, around, balls, body, skin, asked)
        contacts = with_sorted_rows(contacts, order)
    contacts = list_body_pairs(model, state, around, contacts, skin)
    set_listed_centres(model, state)
    return balls, contacts


def set_listed_centres(model: Model, state: State) -> None:
    """Write down where spheres are; balls are the first rows, and have the first spheres."""
    balls = np.count_nonzero(model.ball)
    state.listed_centre[:] = state.centre
    state.listed_centre[:balls] = state.motion[:balls, :3]
