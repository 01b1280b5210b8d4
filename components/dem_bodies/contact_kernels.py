"""Loops over pairs: which touch and how deep, then what force each bears."""

import math

from numba import njit

from quintet.components.dem_bodies.laws import (
    DAMPING,
    carried,
    clamped,
    crossing,
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
)
from quintet.components.shared.rotations import PURE, Vector, backward, cross, dot, forward

Found = tuple[float, Vector, Vector]  # gap m, normal from j to i, point half way

FAR = 1e300  # m, of edges that do not cross


@njit(**PURE)
def on_plane(model: Model, state: State, s: int, p: int) -> Found:
    """Sphere s above plane p."""
    n = (model.plane[p, 0], model.plane[p, 1], model.plane[p, 2])
    c = (state.centre[s, 0], state.centre[s, 1], state.centre[s, 2])
    gap = dot(n, c) - model.plane[p, 3] - model.sphere_radius[s]
    back = model.sphere_radius[s] + 0.5 * gap
    return gap, n, (c[0] - back * n[0], c[1] - back * n[1], c[2] - back * n[2])


@njit(**PURE)
def facing(a: Vector, b: Vector, radius_a: float, radius_b: float) -> Found:
    """Two spheres about the points a and b."""
    d = (a[0] - b[0], a[1] - b[1], a[2] - b[2])
    distance = math.sqrt(dot(d, d))
    gap = distance - radius_a - radius_b
    n = (d[0] / distance, d[1] / distance, d[2] / distance) if distance > 0.0 else (0.0, 0.0, 1.0)
    back = radius_a + 0.5 * gap
    return gap, n, (a[0] - back * n[0], a[1] - back * n[1], a[2] - back * n[2])


@njit(**PURE)
def on_box(model: Model, state: State, s: int, j: int) -> Found:
    """Sphere s and the rounded box j: a sphere rolling on the box less its rounding."""
    c = (state.centre[s, 0], state.centre[s, 1], state.centre[s, 2])
    a = state.axes[j]
    r = (a[0], a[1], a[2], a[3], a[4], a[5], a[6], a[7], a[8])
    o = state.position[j]
    x, y, z = backward(r, c[0] - o[0], c[1] - o[1], c[2] - o[2])
    h = model.half[j]
    x, y, z = forward(r, clamped(x, h[0]), clamped(y, h[1]), clamped(z, h[2]))
    nearest = (o[0] + x, o[1] + y, o[2] + z)
    return facing(c, nearest, model.sphere_radius[s], model.rounding[j])


@njit(**PURE)
def across(model: Model, state: State, e: int, f: int) -> Found:
    """Rounded edges e and f where they cross."""
    a, b = state.centre[model.edge_ends[e, 0]], state.centre[model.edge_ends[e, 1]]
    c, d = state.centre[model.edge_ends[f, 0]], state.centre[model.edge_ends[f, 1]]
    p, u = (a[0], a[1], a[2]), (b[0] - a[0], b[1] - a[1], b[2] - a[2])
    q, v = (c[0], c[1], c[2]), (d[0] - c[0], d[1] - c[1], d[2] - c[2])
    s, t = crossing(p, u, q, v)
    if s < 0.0:
        return FAR, p, p
    on_e = (p[0] + s * u[0], p[1] + s * u[1], p[2] + s * u[2])
    on_f = (q[0] + t * v[0], q[1] + t * v[1], q[2] + t * v[2])
    radius = model.sphere_radius[model.edge_ends[e, 0]]
    return facing(on_e, on_f, radius, model.sphere_radius[model.edge_ends[f, 0]])


@njit(**PURE)
def note(
    contacts: Contacts, report: Numbers, count: int, pair: int, i: int, j: int,
    law: int, found: Found, radius: float, smallest: float,
) -> int:  # fmt: skip
    """Write down a pair if it touches, forget its history if not; return the number noted."""
    gap, n, point = found
    if gap < report[GAP]:
        report[GAP] = gap
    if not gap < 0.0:
        if contacts.history[pair, 3] > 0.0:
            contacts.history[pair] = 0.0
        return count
    if -gap > report[DEEPEST] * smallest:
        report[DEEPEST] = -gap / smallest
        report[WHICH] = pair
    touching, row = contacts.touching[count], contacts.geometry[count]
    touching[0], touching[1], touching[2], touching[3] = pair, i, j, law
    row[0], row[1], row[2] = n
    row[3], row[4], row[5] = point
    row[6], row[7] = -gap, radius
    return count + 1


@njit(**PURE)
def find(model: Model, state: State, contacts: Contacts) -> int:
    """Note all pairs that touch; return how many."""
    count, kinds, ground = 0, model.law.shape[0], model.reach.shape[0]
    begin, report, material = contacts.begin, state.report, model.material
    report[GAP], report[DEEPEST], report[WHICH] = FAR, 0.0, -1.0
    for k in range(begin[PLANE], begin[PLANE + 1]):
        s, p = contacts.ends[k]
        i = model.sphere_body[s]
        law, r = material[i] * kinds + model.plane_material[p], model.sphere_radius[s]
        found = on_plane(model, state, s, p)
        count = note(contacts, report, count, k, i, ground, law, found, r, r)
    for k in range(begin[SPHERE], begin[SPHERE + 1]):
        s, p = contacts.ends[k]
        i, j = model.sphere_body[s], model.sphere_body[p]
        law, r, q = material[i] * kinds + material[j], model.sphere_radius[s], model.sphere_radius[p]
        a = (state.centre[s, 0], state.centre[s, 1], state.centre[s, 2])
        b = (state.centre[p, 0], state.centre[p, 1], state.centre[p, 2])
        found = facing(a, b, r, q)
        count = note(contacts, report, count, k, i, j, law, found, r * q / (r + q), min(r, q))
    for k in range(begin[BOX], begin[BOX + 1]):
        s, j = contacts.ends[k]
        i = model.sphere_body[s]
        law, r = material[i] * kinds + material[j], model.sphere_radius[s]
        found = on_box(model, state, s, j)
        smallest = min(r, model.rounding[j])
        count = note(contacts, report, count, k, i, j, law, found, r, smallest)
    for k in range(begin[EDGE], begin[EDGE + 1]):
        e, f = contacts.ends[k]
        s, p = model.edge_ends[e, 0], model.edge_ends[f, 0]
        i, j = model.sphere_body[s], model.sphere_body[p]
        law, r, q = material[i] * kinds + material[j], model.sphere_radius[s], model.sphere_radius[p]
        found = across(model, state, e, f)
        # Crossed cylinders: as a sphere on a plane, of the mean radius.
        count = note(contacts, report, count, k, i, j, law, found, math.sqrt(r * q), min(r, q))
    return count


@njit(**PURE)
def slip(rates: Numbers, arm: Vector, first: int) -> Vector:
    """Velocity [m/s] of a body's point at an arm from its centre; `first` 0 mean, 6 at the end."""
    w = (rates[first + 3], rates[first + 4], rates[first + 5])
    x, y, z = cross(w, arm)
    return rates[first] + x, rates[first + 1] + y, rates[first + 2] + z


@njit(**PURE)
def yielding(inverse_mass: float, mobility: Numbers, arm: Vector, n: Vector) -> float:
    """1/m* [1/kg] of a body's point along n: 1/m + (r × n)·I⁻¹(r × n)."""
    x, y, z = cross(arm, n)
    square = mobility[0] * x * x + mobility[1] * y * y + mobility[2] * z * z
    mixed = mobility[3] * x * y + mobility[4] * x * z + mobility[5] * y * z
    return inverse_mass + square + 2.0 * mixed


@njit(**PURE)
def grown(history: Numbers, depth: float, closing: float, dt: float, born: bool) -> float:
    """Depth [m] that bears load; a crossing of edges bears nothing where it came into being.

    Edges begin to cross when a corner slides over an edge, with the faces already pressed
    together. To let that depth bear at once would make energy from nothing.
    """
    if born and history[3] == 0.0:
        history[4] = max(0.0, depth - max(0.0, closing) * dt)
    history[4] = min(history[4], depth)
    return depth - history[4]


@njit(**PURE)
def press(model: Model, state: State, contacts: Contacts, count: int, dt: float) -> None:
    """Forces and torques of all noted contacts: what one body gets the other loses."""
    table = model.law.reshape(-1, 4)
    state.contact[:] = 0.0
    elastic_energy, stiffest = 0.0, 0.0
    edges = contacts.begin[EDGE]
    for c in range(count):
        pair, i, j, law = contacts.touching[c]
        row, history = contacts.geometry[c], contacts.history[pair]
        n, point, depth, radius = (row[0], row[1], row[2]), row[3:6], row[6], row[7]
        modulus, shear, ζ, μ = table[law]
        x, y = state.position[i], state.position[j]
        arm_i = (point[0] - x[0], point[1] - x[1], point[2] - x[2])
        arm_j = (point[0] - y[0], point[1] - y[1], point[2] - y[2])
        mass = 1.0 / (
            yielding(model.inverse_mass[i], state.mobility[i], arm_i, n)
            + yielding(model.inverse_mass[j], state.mobility[j], arm_j, n)
        )
        v_i, v_j = slip(state.rates[i], arm_i, 6), slip(state.rates[j], arm_j, 6)
        v = (v_i[0] - v_j[0], v_i[1] - v_j[1], v_i[2] - v_j[2])
        opening = dot(v, n)
        before, bearing = history[3] - history[4], depth
        if pair >= edges:
            bearing = grown(history, depth, -opening, dt, dt > 0.0)
        history[3] = depth
        if bearing <= 0.0:
            history[0], history[1], history[2] = 0.0, 0.0, 0.0
            continue
        root = math.sqrt(radius * bearing)
        normal, elastic = normal_force(modulus, root, bearing, ζ, mass, -opening)
        # Tangential: the elastic part turns with the contact, shrinks with its area on
        # unloading (Walton & Braun, J. Rheol. 30 (1986) 949) and grows with the mean slip.
        shrink = math.sqrt(bearing / before) if bearing < before else 1.0
        fx, fy, fz = carried((history[0], history[1], history[2]), n, shrink)
        m_i, m_j = slip(state.rates[i], arm_i, 0), slip(state.rates[j], arm_j, 0)
        m = (m_i[0] - m_j[0], m_i[1] - m_j[1], m_i[2] - m_j[2])
        away, stiffness = dot(m, n), 8.0 * shear * root
        k = stiffness * dt
        fx -= k * (m[0] - away * n[0])
        fy -= k * (m[1] - away * n[1])
        fz -= k * (m[2] - away * n[2])
        v_t = (v[0] - opening * n[0], v[1] - opening * n[1], v[2] - opening * n[2])
        damping = DAMPING * ζ * math.sqrt(stiffness * mass)
        (tx, ty, tz), held = friction((fx, fy, fz), v_t, damping, μ * normal)
        history[0], history[1], history[2] = held
        force = (normal * n[0] + tx, normal * n[1] + ty, normal * n[2] + tz)
        torque_i, torque_j = cross(arm_i, force), cross(arm_j, force)
        for a in range(3):
            state.contact[i, a] += force[a]
            state.contact[j, a] -= force[a]
            state.contact[i, 3 + a] += torque_i[a]
            state.contact[j, 3 + a] -= torque_j[a]
        elastic_energy += 0.4 * elastic * bearing + 0.5 * dot(held, held) / stiffness
        stiffest = max(stiffest, 2.0 * modulus * root / mass)
    state.report[ELASTIC], state.report[STIFFEST] = elastic_energy, stiffest


@njit(**PURE)
def touch(model: Model, state: State, contacts: Contacts, dt: float) -> int:
    """Find contacts and let them press; return their number."""
    count = find(model, state, contacts)
    press(model, state, contacts, count, dt)
    return count
