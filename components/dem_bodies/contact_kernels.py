"""Loops over pairs: which touch and how deep, then what force each bears."""

import math

from numba import njit

from quintet.components.dem_bodies.geometry import (
    FAR,
    Found,
    across,
    axes_of,
    facing,
    on_box,
    on_plane,
    vector,
)
from quintet.components.dem_bodies.laws import (
    DAMPING,
    carried,
    first_weight,
    friction,
    normal_force,
)
from quintet.components.dem_bodies.state import (
    BOX,
    DEEPEST,
    EDGE,
    ELASTIC,
    GAP,
    PLANE,
    SPHERE,
    STIFFEST,
    WHICH,
    Contacts,
    Model,
    Numbers,
    State,
    Whole,
)
from quintet.components.shared.rotations import INNER, Vector, beside, cross, dot, less


@njit(**INNER)
def note(
    report: Numbers, history: Numbers, touching: Whole, geometry: Numbers, count: int, pair: int,
    i: int, j: int, law: int, found: Found, radius: float, smallest: float,
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
        report[WHICH] = pair
    touching[count, 0], touching[count, 1] = pair, i
    touching[count, 2], touching[count, 3] = j, law
    for k in range(3):
        geometry[count, k] = n[k]
        geometry[count, 3 + k] = point[k]
    geometry[count, 6], geometry[count, 7] = -gap, radius
    return count + 1


@njit(**INNER)
def find(model: Model, state: State, contacts: Contacts) -> int:
    """Note all pairs that touch; return how many."""
    count, kinds, ground = 0, model.law.shape[0], model.reach.shape[0]
    begin, ends, history = contacts.begin, contacts.ends, contacts.history
    touching, geometry, report = contacts.touching, contacts.geometry, state.report
    material, body, size, round_ = (
        model.material, model.sphere_body, model.sphere_radius, model.rounding,
    )  # fmt: skip
    centre, plane, edge = state.centre, model.plane, model.edge_ends
    report[GAP], report[DEEPEST], report[WHICH] = FAR, 0.0, -1.0
    for k in range(begin[PLANE], begin[PLANE + 1]):
        s, p = ends[k, 0], ends[k, 1]
        i, r = body[s], size[s]
        law = material[i] * kinds + model.plane_material[p]
        found = on_plane(vector(centre, s), r, vector(plane, p), plane[p, 3])
        count = note(report, history, touching, geometry, count, k, i, ground, law, found, r, r)
    for k in range(begin[SPHERE], begin[SPHERE + 1]):
        s, p = ends[k, 0], ends[k, 1]
        i, j, r, q = body[s], body[p], size[s], size[p]
        law = material[i] * kinds + material[j]
        found = facing(vector(centre, s), vector(centre, p), r, q)
        mean, low = r * q / (r + q), min(r, q)
        count = note(report, history, touching, geometry, count, k, i, j, law, found, mean, low)
    for k in range(begin[BOX], begin[BOX + 1]):
        s, j = ends[k, 0], ends[k, 1]
        i, r = body[s], size[s]
        law, q, o = material[i] * kinds + material[j], round_[j], vector(state.position, j)
        half, low = vector(model.half, j), min(r, q)
        found = on_box(vector(centre, s), r, o, axes_of(state.axes, j), half, q)
        count = note(report, history, touching, geometry, count, k, i, j, law, found, r, low)
    for k in range(begin[EDGE], begin[EDGE + 1]):
        e, f = ends[k, 0], ends[k, 1]
        i, j = body[edge[e, 0]], body[edge[f, 0]]
        law, r, q = material[i] * kinds + material[j], round_[i], round_[j]
        a, b = vector(centre, edge[e, 0]), vector(centre, edge[f, 0])
        along, other = less(vector(centre, edge[e, 1]), a), less(vector(centre, edge[f, 1]), b)
        found = across(a, along, b, other, r, q)
        # Crossed cylinders: as a sphere on a plane, of the mean radius.
        mean, low = math.sqrt(r * q), min(r, q)
        count = note(report, history, touching, geometry, count, k, i, j, law, found, mean, low)
    return count


@njit(**INNER)
def slip(rates: Numbers, i: int, first: int, arm: Vector) -> Vector:
    """Velocity [m/s] of a body's point at an arm from its centre; `first` 0 mean, 6 at the end."""
    a, b, c = first + 3, first + 4, first + 5
    x, y, z = cross((rates[i, a], rates[i, b], rates[i, c]), arm)
    return rates[i, first] + x, rates[i, first + 1] + y, rates[i, first + 2] + z


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
    position, rates, contact = state.position, state.rates, state.contact
    touching, geometry, history = contacts.touching, contacts.geometry, contacts.history
    kinds, edges = table.shape[0], contacts.begin[EDGE]
    contact[:] = 0.0
    energy, stiffest = 0.0, 0.0
    for c in range(count):
        pair, i, j, law = touching[c, 0], touching[c, 1], touching[c, 2], touching[c, 3]
        a, b = law // kinds, law % kinds
        modulus, shear, ζ, μ = table[a, b, 0], table[a, b, 1], table[a, b, 2], table[a, b, 3]
        n, depth, radius = vector(geometry, c), geometry[c, 6], geometry[c, 7]
        point = (geometry[c, 3], geometry[c, 4], geometry[c, 5])
        arm_i, arm_j = less(point, vector(position, i)), less(point, vector(position, j))
        yield_i = yielding(inverse_mass[i], mobility, i, arm_i, n)
        mass = 1.0 / (yield_i + yielding(inverse_mass[j], mobility, j, arm_j, n))
        v = less(slip(rates, i, 6, arm_i), slip(rates, j, 6, arm_j))
        opening = dot(v, n)
        before, bearing = history[pair, 3] - history[pair, 4], depth
        if pair >= edges:
            bearing = grown(history, pair, depth, -opening, dt)
        history[pair, 3] = depth
        if bearing <= 0.0:
            history[pair, 0], history[pair, 1], history[pair, 2] = 0.0, 0.0, 0.0
            continue
        root = math.sqrt(radius * bearing)
        ratio = ζ
        if before == 0.0 and -opening * dt > 0.0:
            ratio *= first_weight(min(1.0, bearing / (-opening * dt)))
        normal, elastic = normal_force(modulus, root, bearing, ratio, mass, -opening)
        # Tangential: the elastic part turns with the contact, shrinks with its area on
        # unloading (Walton & Braun 1986) and grows with the mean slip of the step.
        shrink = math.sqrt(bearing / before) if bearing < before else 1.0
        held = carried(vector(history, pair), n, shrink)
        mean = less(slip(rates, i, 0, arm_i), slip(rates, j, 0, arm_j))
        stiffness = 8.0 * shear * root
        held = beside(held, -stiffness * dt, beside(mean, -dot(mean, n), n))
        damping = DAMPING * ζ * math.sqrt(stiffness * mass)
        side, held = friction(held, beside(v, -opening, n), damping, μ * normal)
        force = beside(side, normal, n)
        torque_i, torque_j = cross(arm_i, force), cross(arm_j, force)
        for k in range(3):
            history[pair, k] = held[k]
            contact[i, k] += force[k]
            contact[j, k] -= force[k]
            contact[i, 3 + k] += torque_i[k]
            contact[j, 3 + k] -= torque_j[k]
        energy += 0.4 * elastic * bearing + 0.5 * dot(held, held) / stiffness
        stiffest = max(stiffest, 2.0 * modulus * root / mass)
    state.report[ELASTIC], state.report[STIFFEST] = energy, stiffest
