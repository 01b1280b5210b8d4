"""Loops over pairs: which touch and how deep, then what force each bears."""

import math

from numba import njit

from quintet.components.dem_bodies.geometry import (
    Found,
    across,
    axes_of,
    facing,
    on_box,
    on_plane,
    vector,
)
from quintet.components.dem_bodies.laws import beginning, constants, contact
from quintet.components.dem_bodies.state import (
    BOX,
    DEEPEST,
    EDGE,
    ELASTIC,
    END_V,
    GAP,
    PLANE,
    SPHERE,
    STIFFEST,
    WHICH,
    Contacts,
    Model,
    Numbers,
    State,
    V,
    Whole,
)
from quintet.components.shared.rotations import INNER, Vector, cross, dot, less


@njit(**INNER)
def note(
    report: Numbers, history: Numbers, touching: Whole, geometry: Numbers, count: int, pair: int,
    ahead: int, i: int, j: int, law: int, found: Found, radius: float, smallest: float,
) -> int:  # fmt: skip
    """Write down a pair if it touches, forget its history if not; return the number noted."""
    gap, n, point = found
    report[GAP] = min(report[GAP], gap)
    if not gap < 0.0:
        if history[pair, 3] > 0.0:
            for k in range(5):
                history[pair, k] = 0.0
        return count
    if -gap > report[DEEPEST] * smallest:
        report[DEEPEST] = -gap / smallest
        report[WHICH] = ahead + pair
    touching[count, 0], touching[count, 1] = pair, i
    touching[count, 2], touching[count, 3] = j, law
    for k in range(3):
        geometry[count, k] = n[k]
        geometry[count, 3 + k] = point[k]
    geometry[count, 6], geometry[count, 7] = -gap, radius
    return count + 1


@njit(**INNER)
def find(model: Model, state: State, contacts: Contacts, ahead: int) -> int:
    """Note all pairs that touch, numbered after those of balls; return how many."""
    count, kinds, ground = 0, model.law.shape[0], model.reach.shape[0]
    begin, ends, history = contacts.begin, contacts.ends, contacts.history
    touching, geometry, report = contacts.touching, contacts.geometry, state.report
    material, body, size, round_ = (
        model.material, model.sphere_body, model.sphere_radius, model.rounding,
    )  # fmt: skip
    centre, plane, edge = state.centre, model.plane, model.edge_ends
    for k in range(begin[PLANE], begin[PLANE + 1]):
        s, p = ends[k, 0], ends[k, 1]
        i, r = body[s], size[s]
        law = material[i] * kinds + model.plane_material[p]
        found = on_plane(vector(centre, s), r, vector(plane, p), plane[p, 3])
        count = note(
            report, history, touching, geometry, count, k, ahead, i, ground, law, found, r, r
        )
    for k in range(begin[SPHERE], begin[SPHERE + 1]):
        s, p = ends[k, 0], ends[k, 1]
        i, j, r, q = body[s], body[p], size[s], size[p]
        law = material[i] * kinds + material[j]
        found = facing(vector(centre, s), vector(centre, p), r, q)
        mean, low = r * q / (r + q), min(r, q)
        count = note(
            report, history, touching, geometry, count, k, ahead, i, j, law, found, mean, low
        )
    for k in range(begin[BOX], begin[BOX + 1]):
        s, j = ends[k, 0], ends[k, 1]
        i, r = body[s], size[s]
        law, q, o = material[i] * kinds + material[j], round_[j], vector(state.motion, j)
        half, low = vector(model.half, j), min(r, q)
        found = on_box(vector(centre, s), r, o, axes_of(state.axes, j), half, q)
        count = note(report, history, touching, geometry, count, k, ahead, i, j, law, found, r, low)
    for k in range(begin[EDGE], begin[EDGE + 1]):
        e, f = ends[k, 0], ends[k, 1]
        i, j = body[edge[e, 0]], body[edge[f, 0]]
        law, r, q = material[i] * kinds + material[j], round_[i], round_[j]
        a, b = vector(centre, edge[e, 0]), vector(centre, edge[f, 0])
        along, other = less(vector(centre, edge[e, 1]), a), less(vector(centre, edge[f, 1]), b)
        found = across(a, along, b, other, r, q)
        # Crossed cylinders: as a sphere on a plane, of the mean radius.
        mean, low = math.sqrt(r * q), min(r, q)
        count = note(
            report, history, touching, geometry, count, k, ahead, i, j, law, found, mean, low
        )
    return count


@njit(**INNER)
def slip(motion: Numbers, a: int, first: int, arm: Vector) -> Vector:
    """Velocity [m/s] of row a's point at an arm from its centre; `first` V mean, END_V at end."""
    turn = (motion[a, first + 3], motion[a, first + 4], motion[a, first + 5])
    x, y, z = cross(turn, arm)
    return motion[a, first] + x, motion[a, first + 1] + y, motion[a, first + 2] + z


@njit(**INNER)
def yielding(inverse_mass: float, mobility: Numbers, i: int, arm: Vector, n: Vector) -> float:
    """1/m* [1/kg] of a body's point along n: 1/m + (r × n)·I⁻¹(r × n)."""
    x, y, z = cross(arm, n)
    square = mobility[i, 0] * x * x + mobility[i, 1] * y * y + mobility[i, 2] * z * z
    mixed = mobility[i, 3] * x * y + mobility[i, 4] * x * z + mobility[i, 5] * y * z
    return inverse_mass + square + 2.0 * mixed


@njit(**INNER)
def grown(history: Numbers, pair: int, depth: float, closing: float, dt: float) -> float:
    """Depth [m] that bears load; a crossing of edges bears nothing where it came into being.

    Edges begin to cross when a corner slides over an edge, with the faces already pressed
    together. To let that depth bear at once would make energy from nothing.
    """
    if history[pair, 3] == 0.0 and dt > 0.0:
        history[pair, 4] = max(0.0, depth - max(0.0, closing) * dt)
    history[pair, 4] = min(history[pair, 4], depth)
    return float(depth - history[pair, 4])


@njit(**INNER)
def press(model: Model, state: State, contacts: Contacts, count: int, dt: float) -> None:
    """Forces and torques of all noted contacts: what one body gets the other loses."""
    table, inverse_mass, mobility = model.law, model.inverse_mass, state.mobility
    motion, sums = state.motion, state.contact
    touching, geometry, history = contacts.touching, contacts.geometry, contacts.history
    kinds, edges = table.shape[0], contacts.begin[EDGE]
    energy, stiffest = state.report[ELASTIC], state.report[STIFFEST]
    for k in range(count):
        pair, i, j, law = touching[k, 0], touching[k, 1], touching[k, 2], touching[k, 3]
        n, depth, radius = vector(geometry, k), geometry[k, 6], geometry[k, 7]
        point = (geometry[k, 3], geometry[k, 4], geometry[k, 5])
        arm_i, arm_j = less(point, vector(motion, i)), less(point, vector(motion, j))
        yield_i = yielding(inverse_mass[i], mobility, i, arm_i, n)
        mass = 1.0 / (yield_i + yielding(inverse_mass[j], mobility, j, arm_j, n))
        end = less(slip(motion, i, END_V, arm_i), slip(motion, j, END_V, arm_j))
        before, bearing = history[pair, 3] - history[pair, 4], depth
        if pair >= edges:
            bearing = grown(history, pair, depth, -dot(end, n), dt)
        history[pair, 3] = depth
        if bearing <= 0.0:
            for d in range(3):
                history[pair, d], geometry[k, 8 + d] = 0.0, 0.0
            continue
        p, q = law // kinds, law % kinds
        c = constants(table[p, q, 0], table[p, q, 1], table[p, q, 2], table[p, q, 3], radius, mass)
        mean = less(slip(motion, i, V, arm_i), slip(motion, j, V, arm_j))
        weight = 1.0 / math.sqrt(before) if before > 0.0 else 0.0
        root = math.sqrt(bearing)
        roots = (root, math.sqrt(root), 1.0 / root)
        force, held, elastic = contact(
            c,
            vector(history, pair),
            weight,
            n,
            bearing,
            roots,
            beginning(weight, bearing, -dot(end, n), dt),
            mean,
            end,
            dt,
        )
        torque_i, torque_j = cross(arm_i, force), cross(arm_j, force)
        for d in range(3):
            history[pair, d], geometry[k, 8 + d] = held[d], force[d]
            sums[i, d] += force[d]
            sums[j, d] -= force[d]
            sums[i, 3 + d] += torque_i[d]
            sums[j, 3 + d] -= torque_j[d]
        energy += elastic
        stiffest = max(stiffest, c[5] * root)
    state.report[ELASTIC], state.report[STIFFEST] = energy, stiffest
