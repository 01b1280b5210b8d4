"""Listing the pairs that may touch before some point has moved by half the skin.

Bodies are sorted into cells that are numbered along x, then y, then z, so that the cells next
to one another along x are one range of the sorted numbers, wherever in space the bodies are.
"""

import math

import numpy as np
from numba import njit

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
    Contacts,
    Model,
    Numbers,
    State,
    Whole,
    empty_contacts,
)
from quintet.components.shared.rotations import INNER, PURE, dot, less

BITS = 21  # of a cell's number along each axis
MIDDLE = 1 << (BITS - 1)


@njit(**INNER)
def cell_of(x: float, width: float) -> int:
    """Return the number of the cell along one axis; what is very far shares the last one."""
    return int(min(max(math.floor(x / width), 2.0 - MIDDLE), MIDDLE - 2.0)) + MIDDLE


@njit(**PURE)
def number(position: Numbers, bodies: int, width: float) -> Whole:
    """Return the cell of each body, as one number."""
    cells = np.empty(bodies, np.int64)
    for i in range(bodies):
        x, y, z = vector(position, i)
        cells[i] = (cell_of(z, width) << 2 * BITS) + (cell_of(y, width) << BITS)
        cells[i] += cell_of(x, width)
    return cells


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
    r, o = axes_of(state.axes, j), vector(state.position, j)
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


@njit(**PURE)
def list_pairs(
    model: Model, state: State, cells: Whole, order: Whole, skin: float, keys: Whole
) -> int:
    """Write the keys of all pairs nearer than the skin [m]; return their number.

    `cells` (m,) is sorted, `order` (m,) are the bodies in that order. If there is not room for
    all keys, only their number is right.
    """
    count = 0
    for s in range(model.sphere_body.shape[0]):
        for p in range(model.plane.shape[0]):
            normal, c = vector(model.plane, p), vector(state.centre, s)
            if on_plane(c, model.sphere_radius[s], normal, model.plane[p, 3])[0] < skin:
                count = emit(keys, count, PLANE, s, p)
    for a in range(order.shape[0]):
        i = order[a]
        for z in range(-1, 2):
            for y in range(-1, 2):
                row = cells[a] + (z << 2 * BITS) + (y << BITS)
                last = np.searchsorted(cells, row + 1, side="right")
                for b in range(np.searchsorted(cells, row - 1), last):
                    j = order[b]
                    if j <= i:
                        continue
                    d = less(vector(state.position, i), vector(state.position, j))
                    near = model.reach[i] + model.reach[j] + skin
                    if dot(d, d) < near * near:
                        count = list_bodies(model, state, i, j, skin, keys, count)
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


def listed(model: Model, state: State, old: Contacts, skin: float) -> Contacts:
    """List anew all pairs nearer than the skin [m]."""
    width = 2.0 * float(model.reach.max()) + skin
    cells = number(state.position, len(model.reach), width)
    order = np.argsort(cells, kind="stable")
    keys = np.empty(2 * len(old.key) + 64, np.int64)
    count = list_pairs(model, state, cells[order], order, skin, keys)
    if count > len(keys):
        keys = np.empty(count, np.int64)
        list_pairs(model, state, cells[order], order, skin, keys)
    state.listed[:] = state.centre
    return contacts_from(np.sort(keys[:count]), old)
