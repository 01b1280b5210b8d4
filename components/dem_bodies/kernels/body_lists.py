"""Pairs that may touch of which one body at least is no ball."""

from numba import njit

from quintet.components.dem_bodies.kernels.ball_lists import Sorted
from quintet.components.dem_bodies.kernels.geometry import (
    row_vector,
    segment_distance,
    sphere_body,
    sphere_plane,
)
from quintet.components.dem_bodies.state import (
    EDGE_EDGE,
    FIRST,
    KIND,
    SPHERE_BOX,
    SPHERE_PLANE,
    SPHERE_SPHERE,
    BodyPairs,
    Model,
    Numbers,
    State,
    Whole,
)
from quintet.components.shared.numba_options import EXACT, INNER
from quintet.components.shared.rotations import dot, sub
from quintet.components.shared.search.cells import LAYER, ROW, number_along, row_of_keys


@njit(**INNER)
def add_key(keys: Whole, count: int, kind: int, first: int, second: int) -> int:
    """Write a pair's key while there is room; return the number of pairs."""
    if count < keys.shape[0]:
        keys[count] = (kind << KIND) + (first << FIRST) + second
    return count + 1


@njit(**INNER)
def edge_distance(ends: Whole, centre: Numbers, e: int, f: int) -> float:
    """Distance [m] of two edges' axes."""
    a, b = row_vector(centre, ends[e, 0]), row_vector(centre, ends[f, 0])
    along, other = sub(row_vector(centre, ends[e, 1]), a), sub(row_vector(centre, ends[f, 1]), b)
    return segment_distance(a, along, b, other)


@njit(**INNER)
def list_spheres_of_box(
    model: Model, state: State, i: int, j: int, skin: float, keys: Whole, count: int
) -> int:
    """List the spheres of body i that are near the box or polygon j."""
    for s in range(model.sphere_begin[i], model.sphere_begin[i + 1]):
        if sphere_body(model, state, s, j)[0] < skin:
            count = add_key(keys, count, SPHERE_BOX, s, j)
    return count


@njit(**INNER)
def list_bodies(
    model: Model, state: State, i: int, j: int, skin: float, keys: Whole, count: int
) -> int:
    """List the near parts of two bodies: spheres, spheres and faces, edges."""
    box_i, box_j = model.edge_radius[i] > 0.0, model.edge_radius[j] > 0.0
    if box_j:
        count = list_spheres_of_box(model, state, i, j, skin, keys, count)
    if box_i:
        count = list_spheres_of_box(model, state, j, i, skin, keys, count)
    if not box_i and not box_j:
        for s in range(model.sphere_begin[i], model.sphere_begin[i + 1]):
            for p in range(model.sphere_begin[j], model.sphere_begin[j + 1]):
                near = model.sphere_radius[s] + model.sphere_radius[p] + skin
                d = sub(row_vector(state.centre, s), row_vector(state.centre, p))
                if dot(d, d) < near * near:
                    count = add_key(keys, count, SPHERE_SPHERE, s, p)
    rounds = model.edge_radius[i] + model.edge_radius[j]
    for e in range(model.edge_begin[i], model.edge_begin[i + 1]):
        for f in range(model.edge_begin[j], model.edge_begin[j + 1]):
            if edge_distance(model.edge_ends, state.centre, e, f) < rounds + skin:
                count = add_key(keys, count, EDGE_EDGE, e, f)
    return count


@njit(**INNER)
def list_planes(model: Model, state: State, i: int, skin: float, keys: Whole, count: int) -> int:
    """List the planes that the spheres of a body are near."""
    for s in range(model.sphere_begin[i], model.sphere_begin[i + 1]):
        for p in range(model.plane.shape[0]):
            normal, c = row_vector(model.plane, p), row_vector(state.centre, s)
            if sphere_plane(c, model.sphere_radius[s], normal, model.plane[p, 3])[0] < skin:
                count = add_key(keys, count, SPHERE_PLANE, s, p)
    return count


@njit(**INNER)
def list_if_near(
    model: Model, state: State, i: int, j: int, skin: float, keys: Whole, count: int
) -> int:
    """List the near parts of two bodies, if they are near each other."""
    d = sub(row_vector(state.motion, i), row_vector(state.motion, j))
    near = model.bounding_radius[i] + model.bounding_radius[j] + skin
    if dot(d, d) < near * near:
        return list_bodies(model, state, min(i, j), max(i, j), skin, keys, count)
    return count


@njit(**INNER)
def list_balls(
    model: Model, state: State, i: int, cell_keys: Whole, width: float, skin: float, keys: Whole,
    count: int,
) -> int:  # fmt: skip
    """List what row i is near of balls, which are sorted by cells (b,) of a width [m]."""
    x, far = row_vector(state.motion, i), model.bounding_radius[i] + 0.5 * width + 0.5 * skin
    z_low, z_high = number_along(x[2] - far, width), number_along(x[2] + far, width)
    x_low, x_high = number_along(x[0] - far, width), number_along(x[0] + far, width)
    y_low, y_high = number_along(x[1] - far, width), number_along(x[1] + far, width)
    if (z_high - z_low + 1) * (y_high - y_low + 1) > cell_keys.shape[0]:
        # Around a body that is large beside the balls are more rows of cells than balls.
        for b in range(cell_keys.shape[0]):
            count = list_if_near(model, state, i, b, skin, keys, count)
        return count
    for z in range(z_low, z_high + 1):
        for y in range(y_low, y_high + 1):
            row = z * LAYER + y * ROW
            for b in range(*row_of_keys(cell_keys, row + x_low, row + x_high)):
                count = list_if_near(model, state, i, b, skin, keys, count)
    return count


@njit(**EXACT)
def list_keys(
    model: Model, state: State, cell_keys: Whole, order: Whole, balls: Sorted | None, skin: float,
    keys: Whole,
) -> int:  # fmt: skip
    """Write the keys of all pairs nearer than the skin [m]; return their number.

    `cell_keys` (o,) is sorted, `order` (o,) are the rows in that order; `balls` are None if there
    are none. If there is not room for all keys, only their number is right.
    """
    count = 0
    for a in range(order.shape[0]):
        i = order[a]
        count = list_planes(model, state, i, skin, keys, count)
        if balls is not None:
            count = list_balls(model, state, i, balls.keys, balls.width, skin, keys, count)
        for z in range(-1, 2):
            for y in range(-1, 2):
                key = cell_keys[a] + z * LAYER + y * ROW
                for b in range(*row_of_keys(cell_keys, key - 1, key + 1)):
                    if order[b] > i:
                        count = list_if_near(model, state, i, order[b], skin, keys, count)
    return count


@njit(**EXACT)
def transfer_history(old: BodyPairs, new: BodyPairs) -> None:
    """Write the ends of the new pairs, and take over the history of those that were listed."""
    a, mask = 0, (1 << FIRST) - 1
    for b in range(new.key.shape[0]):
        key = new.key[b]
        new.ends[b, 0], new.ends[b, 1] = (key >> FIRST) & mask, key & mask
        while a < old.key.shape[0] and old.key[a] < key:
            a += 1
        if a < old.key.shape[0] and old.key[a] == key:
            for d in range(5):  # to copy a row at once takes two seconds longer to compile
                new.history[b, d] = old.history[a, d]
