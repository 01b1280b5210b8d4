"""Reading of the front gauge: how far the bodies that touch each other reach along an axis.

Single grains roll far ahead of a deposit. Its front is therefore the farthest grain in contact with
the main mass, as in Kumar, PhD thesis, University of Cambridge (2015), section on the numerical
set-up of granular column collapse: here the largest group of bodies that are connected by contacts.
A contact with a plane connects nothing.
"""

import numpy as np

from quintet.components.dem_bodies.state import (
    RADIUS,
    TOUCHING,
    BallPairs,
    BodyPairs,
    Model,
    Numbers,
    State,
    Whole,
)
from quintet.interfaces.component import Fields

AXES = "xyz"


def front(
    model: Model, state: State, balls: BallPairs | None, others: BodyPairs, axis: int
) -> Fields:
    """Position [m] of the front along an axis, and the share of the bodies behind it."""
    count = len(state.body) - 1
    groups = groups_of(count, touching_rows(state, balls, others))
    in_largest = groups == np.argmax(np.bincount(groups))
    return {
        "front_gauge.position": np.array([reach(model, state, axis)[in_largest].max()]),
        "front_gauge.share": np.array([np.count_nonzero(in_largest) / count]),
    }


def touching_rows(state: State, balls: BallPairs | None, others: BodyPairs) -> Whole:
    """Rows (k, 2) of the bodies of each contact in the last step; contacts with planes left out."""
    ground = len(state.body) - 1
    pairs = others.touching[: int(state.report[TOUCHING]), 1:3]
    if balls is not None:
        some = np.flatnonzero(balls.history[3])
        of_balls = np.column_stack([balls.row[some], balls.partner[some]]).astype(np.int64)
        pairs = np.concatenate([of_balls, pairs])
    return pairs[(pairs < ground).all(axis=1)]


def groups_of(count: int, pairs: Whole) -> Whole:
    """Lowest member of the group of each of `count` items; `pairs` (k, 2) are connected.

    References
    ----------
    Shiloach & Vishkin (1982), J. Algorithms 3, 57: every group's lowest members are joined, then
    each item is joined to the lowest member itself.
    """
    groups = np.arange(count)
    while True:
        ends = groups[pairs]
        joined, lowest = groups.copy(), ends.min(axis=1)
        for end in ends.T:
            np.minimum.at(joined, end, lowest)
        joined = joined[joined]
        if np.array_equal(joined, groups):
            return groups
        groups = joined


def reach(model: Model, state: State, axis: int) -> Numbers:
    """Largest coordinate [m] of each row's surface along an axis; of corners by their spheres."""
    count = len(state.body) - 1
    ends = state.motion[:count, axis] + state.motion[:count, RADIUS]
    for row in model.others.tolist():
        spheres = slice(model.sphere_begin[row], model.sphere_begin[row + 1])
        ends[row] = (state.centre[spheres, axis] + model.sphere_radius[spheres]).max()
    return np.asarray(ends)
