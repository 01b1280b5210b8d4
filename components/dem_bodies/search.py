"""Listing the pairs that may touch before some point has moved by half the skin.

Here are those of which one body at least is no ball; what two balls, or a ball and a plane, may
do is listed in ball_search.
"""

import numpy as np
from numba import njit

from quintet.components.dem_bodies.ball_search import (
    Sorted,
    listed_balls,
    sorted_balls,
)
from quintet.components.dem_bodies.cells import BITS, cell_of, number
from quintet.components.dem_bodies.geometry import (
    axes_of,
    on_box,
    on_plane,
    segment_distance,
    vector,
)
from quintet.components.dem_bodies.state import (
    BOX,
    EDGE,
    FIRST,
    KIND,
    PLANE,
    SPHERE,
    Balls,
    Contacts,
    Model,
    Numbers,
    State,
    Whole,
    arrange,
    empty_contacts,
)
from quintet.components.shared.rotations import INNER, PURE, dot, less


@njit(**INNER)
def emit(keys: Whole, count: int, kind: int, first: int, second: int) -> int:
    """Write a pair's key while there is room; return the number of pairs."""
    if count < keys.shape[0]:
        keys[count] = (kind << KIND) + (first << FIRST) + second
    return count + 1


@njit(**INNER)
def edges_apart(ends: Whole, centre: Numbers, e: int, f: int) -> float:
    """Distance [m] of two edges' axes."""
    a, b = vector(centre, ends[e, 0]), vector(centre, ends[f, 0])
    along, other = less(vector(centre, ends[e, 1]), a), less(vector(centre, ends[f, 1]), b)
    return segment_distance(a, along, b, other)


@njit(**INNER)
def list_spheres_of_box(
    model: Model, state: State, i: int, j: int, skin: float, keys: Whole, count: int
) -> int:
    """List the spheres of body i that are near the box j."""
    r, o = axes_of(state.axes, j), vector(state.motion, j)
    half, q = vector(model.half, j), model.rounding[j]
    for s in range(model.sphere_from[i], model.sphere_from[i + 1]):
        if on_box(vector(state.centre, s), model.sphere_radius[s], o, r, half, q)[0] < skin:
            count = emit(keys, count, BOX, s, j)
    return count


@njit(**INNER)
def list_bodies(
    model: Model, state: State, i: int, j: int, skin: float, keys: Whole, count: int
) -> int:
    """List what is near of two bodies: spheres, spheres and faces, edges."""
    box_i, box_j = model.rounding[i] > 0.0, model.rounding[j] > 0.0
    if box_j:
        count = list_spheres_of_box(model, state, i, j, skin, keys, count)
    if box_i:
        count = list_spheres_of_box(model, state, j, i, skin, keys, count)
    if not box_i and not box_j:
        for s in range(model.sphere_from[i], model.sphere_from[i + 1]):
            for p in range(model.sphere_from[j], model.sphere_from[j + 1]):
                near = model.sphere_radius[s] + model.sphere_radius[p] + skin
                d = less(vector(state.centre, s), vector(state.centre, p))
                if dot(d, d) < near * near:
                    count = emit(keys, count, SPHERE, s, p)
    rounds = model.rounding[i] + model.rounding[j]
    for e in range(model.edge_from[i], model.edge_from[i + 1]):
        for f in range(model.edge_from[j], model.edge_from[j + 1]):
            if edges_apart(model.edge_ends, state.centre, e, f) < rounds + skin:
                count = emit(keys, count, EDGE, e, f)
    return count


@njit(**INNER)
def list_planes(model: Model, state: State, i: int, skin: float, keys: Whole, count: int) -> int:
    """List the planes that the spheres of a body are near."""
    for s in range(model.sphere_from[i], model.sphere_from[i + 1]):
        for p in range(model.plane.shape[0]):
            normal, c = vector(model.plane, p), vector(state.centre, s)
            if on_plane(c, model.sphere_radius[s], normal, model.plane[p, 3])[0] < skin:
                count = emit(keys, count, PLANE, s, p)
    return count


@njit(**INNER)
def list_near(
    model: Model, state: State, i: int, j: int, skin: float, keys: Whole, count: int
) -> int:
    """List what is near of two bodies, if they are near one another."""
    d = less(vector(state.motion, i), vector(state.motion, j))
    near = model.reach[i] + model.reach[j] + skin
    if dot(d, d) < near * near:
        return list_bodies(model, state, min(i, j), max(i, j), skin, keys, count)
    return count


@njit(**INNER)
def list_balls(
    model: Model, state: State, i: int, cells: Whole, width: float, skin: float, keys: Whole,
    count: int,
) -> int:  # fmt: skip
    """List what row i is near of balls, which are sorted by cells (b,) of a width [m]."""
    x, far = vector(state.motion, i), model.reach[i] + 0.5 * width + 0.5 * skin
    for z in range(cell_of(x[2] - far, width), cell_of(x[2] + far, width) + 1):
        for y in range(cell_of(x[1] - far, width), cell_of(x[1] + far, width) + 1):
            row = (z << 2 * BITS) + (y << BITS)
            last = np.searchsorted(cells, row + cell_of(x[0] + far, width), side="right")
            for b in range(np.searchsorted(cells, row + cell_of(x[0] - far, width)), last):
                count = list_near(model, state, i, b, skin, keys, count)
    return count


@njit(**PURE)
def list_pairs(
    model: Model, state: State, cells: Whole, order: Whole, ball_cells: Whole, width: float,
    skin: float, keys: Whole,
) -> int:  # fmt: skip
    """Write the keys of all pairs nearer than the skin [m]; return their number.

    `cells` (o,) is sorted, `order` (o,) are the rows in that order; `ball_cells` (b,) are those
    of the balls, and `width` [m] that of their cells. If there is not room for all keys, only
    their number is right.
    """
    count = 0
    for a in range(order.shape[0]):
        i = order[a]
        count = list_planes(model, state, i, skin, keys, count)
        count = list_balls(model, state, i, ball_cells, width, skin, keys, count)
        for z in range(-1, 2):
            for y in range(-1, 2):
                row = cells[a] + (z << 2 * BITS) + (y << BITS)
                last = np.searchsorted(cells, row + 1, side="right")
                for b in range(np.searchsorted(cells, row - 1), last):
                    if order[b] > i:
                        count = list_near(model, state, i, order[b], skin, keys, count)
    return count


@njit(**PURE)
def carry(old: Contacts, new: Contacts) -> None:
    """Write what the new pairs join, and take over the history of those that were listed before."""
    a, mask = 0, (1 << FIRST) - 1
    for b in range(new.key.shape[0]):
        key = new.key[b]
        new.ends[b, 0], new.ends[b, 1] = (key >> FIRST) & mask, key & mask
        while a < old.key.shape[0] and old.key[a] < key:
            a += 1
        if a < old.key.shape[0] and old.key[a] == key:
            new.history[b] = old.history[a]


def contacts_from(keys: Whole, old: Contacts) -> Contacts:
    """Contacts of sorted keys, with the history of the old ones."""
    new = empty_contacts(len(keys))
    new.key[:] = keys
    new.begin[:] = np.searchsorted(keys, np.arange(5, dtype=np.int64) << KIND)
    carry(old, new)
    return new


def renamed(old: Contacts, order: Whole) -> Contacts:
    """Keep the history of pairs with balls, whose present rows (b,) are put in a new order."""
    key, mask = old.key.copy(), (1 << FIRST) - 1
    first = key >> FIRST & mask
    ball = np.flatnonzero((key >> KIND < EDGE) & (first < len(order)))
    key[ball] += (np.argsort(order)[first[ball]] - first[ball]) << FIRST
    rising = np.argsort(key)
    return old._replace(key=key[rising], history=old.history[rising])


def listed_others(
    model: Model, state: State, around: Sorted, old: Contacts, skin: float
) -> Contacts:
    """List anew all pairs nearer than the skin [m] that are not of balls and planes alone."""
    width = 2.0 * float(model.reach[model.others].max(initial=0.0)) + skin
    cells = number(state.motion, model.others, width)
    order = np.argsort(cells, kind="stable")
    given = (model, state, cells[order], model.others[order], around.cells, around.width, skin)
    keys = np.empty(2 * len(old.key) + 64, np.int64)
    count = list_pairs(*given, keys)
    if count > len(keys):
        keys = np.empty(count, np.int64)
        list_pairs(*given, keys)
    return contacts_from(np.sort(keys[:count]), old)


def listed(
    model: Model, state: State, balls: Balls, contacts: Contacts, skin: float, asked: bool
) -> tuple[Balls, Contacts]:
    """Sort the rows, and list anew all pairs nearer than the skin [m]."""
    body = state.body.copy()
    around, order = sorted_balls(model, state, skin)
    arrange(model, state, order)
    balls = listed_balls(model, state, around, balls, body, skin, asked)
    contacts = listed_others(model, state, around, renamed(contacts, order), skin)
    mark(model, state)
    return balls, contacts


@njit(**PURE)
def mark(model: Model, state: State) -> None:
    """Write down where spheres are."""
    for i in range(model.reach.shape[0]):
        for s in range(model.sphere_from[i], model.sphere_from[i + 1]):
            for k in range(3):
                at = state.motion[i, k] if model.ball[i] else state.centre[s, k]
                state.listed[s, k] = at
