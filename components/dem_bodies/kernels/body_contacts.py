"""Loops over all other pairs: which touch and how deep, then the force of each contact."""

import math

from numba import njit

from quintet.components.dem_bodies.kernels.geometry import (
    Gap,
    edge_edge,
    row_vector,
    sphere_body,
    sphere_plane,
    sphere_sphere,
)
from quintet.components.dem_bodies.kernels.locked_motion import free_inverse_mass
from quintet.components.dem_bodies.kernels.sharp import (
    SUNK,
    box_of,
    corner_penetration,
    edge_of,
    edge_penetration,
    polygon_penetration,
)
from quintet.components.dem_bodies.laws import contact_force, damping_weight, pair_constants
from quintet.components.dem_bodies.state import (
    DEEPEST,
    DEEPEST_PAIR,
    EDGE_EDGE,
    ELASTIC_ENERGY,
    END_VELOCITY,
    SMALLEST_GAP,
    SPHERE_BOX,
    SPHERE_PLANE,
    SPHERE_SPHERE,
    STIFFEST,
    VELOCITY,
    BodyPairs,
    Model,
    Numbers,
    State,
    Whole,
)
from quintet.components.shared.numba_options import INNER
from quintet.components.shared.rotations import Vector, cross, dot, sub

# Over that of both bodies, if they were free: a contact of which neither can yield. Nothing moves
# it, and its dampers are those of free bodies.
LOCKED_MASS = 1e9


@njit(**INNER)
def add_contact(
    report: Numbers, history: Numbers, touching: Whole, geometry: Numbers, count: int, pair: int,
    ahead: int, i: int, j: int, materials: int, separation: Gap, radius: float, smallest: float,
) -> int:  # fmt: skip
    """Write down a pair if it touches, forget its history if not; return the number of contacts."""
    gap, n, point = separation
    report[SMALLEST_GAP] = min(report[SMALLEST_GAP], gap)
    if not gap < 0.0:
        if history[pair, 3] > 0.0:
            for k in range(5):
                history[pair, k] = 0.0
        return count
    if -gap > report[DEEPEST] * smallest:
        report[DEEPEST] = -gap / smallest
        report[DEEPEST_PAIR] = ahead + pair
    touching[count, 0], touching[count, 1] = pair, i
    touching[count, 2], touching[count, 3] = j, materials
    for k in range(3):
        geometry[count, k] = n[k]
        geometry[count, 3 + k] = point[k]
    geometry[count, 6], geometry[count, 7] = -gap, radius
    return count + 1


@njit(**INNER)
def spheres_on_planes(model: Model, state: State, pairs: BodyPairs, ahead: int, count: int) -> int:
    """Write down the spheres that touch planes; return the number of contacts so far."""
    ground, kinds = model.bounding_radius.shape[0], model.material_pairs.shape[0]
    begin, ends, material, row = pairs.begin, pairs.ends, model.material, model.sphere_row
    history, touching, geometry, report = (
        pairs.history, pairs.touching, pairs.geometry, state.report,
    )  # fmt: skip
    centre, plane, size = state.centre, model.plane, model.sphere_radius
    radius, thickness, of_plane = model.contact_radius, model.half_thickness, model.plane_material
    for k in range(begin[SPHERE_PLANE], begin[SPHERE_PLANE + 1]):
        s, p = ends[k, 0], ends[k, 1]
        i = row[s]
        both = material[i] * kinds + of_plane[p]
        gap = sphere_plane(row_vector(centre, s), size[s], row_vector(plane, p), plane[p, 3])
        mean, low = radius[s], min(radius[s], thickness[i])
        count = add_contact(
            report, history, touching, geometry, count, k, ahead, i, ground, both, gap, mean, low
        )
    return count


@njit(**INNER)
def spheres_on_spheres(model: Model, state: State, pairs: BodyPairs, ahead: int, count: int) -> int:
    """Write down the spheres that touch spheres; return the number of contacts so far."""
    begin, ends, material, row = pairs.begin, pairs.ends, model.material, model.sphere_row
    history, touching, geometry, report = (
        pairs.history, pairs.touching, pairs.geometry, state.report,
    )  # fmt: skip
    centre, size, kinds = state.centre, model.sphere_radius, model.material_pairs.shape[0]
    for k in range(begin[SPHERE_SPHERE], begin[SPHERE_SPHERE + 1]):
        s, p = ends[k, 0], ends[k, 1]
        i, j, r, q = row[s], row[p], size[s], size[p]
        both = material[i] * kinds + material[j]
        gap = sphere_sphere(row_vector(centre, s), row_vector(centre, p), r, q)
        mean, low = r * q / (r + q), min(r, q)
        count = add_contact(
            report, history, touching, geometry, count, k, ahead, i, j, both, gap, mean, low
        )
    return count


@njit(**INNER)
def spheres_on_bodies(model: Model, state: State, pairs: BodyPairs, ahead: int, count: int) -> int:
    """Write down the spheres that touch boxes or polygons; return the number of contacts so far."""
    begin, ends, material, row = pairs.begin, pairs.ends, model.material, model.sphere_row
    history, touching, geometry, report = (
        pairs.history, pairs.touching, pairs.geometry, state.report,
    )  # fmt: skip
    radius, bearing, thickness = (
        model.contact_radius, model.body_contact_radius, model.half_thickness,
    )  # fmt: skip
    centre, size, edge_radius = state.centre, model.sphere_radius, model.edge_radius
    motion, axes, half = state.motion, state.axes, model.half_extent
    local, begin_of, kinds = model.sphere_centre, model.sphere_begin, model.material_pairs.shape[0]
    for k in range(begin[SPHERE_BOX], begin[SPHERE_BOX + 1]):
        s, j = ends[k, 0], ends[k, 1]
        i, r = row[s], size[s]
        both, q = material[i] * kinds + material[j], edge_radius[j]
        gap = sphere_body(model, state, s, j)
        if (model.sharp[i] or model.sharp[j]) and gap[0] < -SUNK * (r + q):
            mine = box_of(motion, axes, half, edge_radius, i)
            other = box_of(motion, axes, half, edge_radius, j)
            if model.polygon[j]:
                spheres = (begin_of[i], begin_of[i + 1]) if model.polygon[i] else (s, s + 1)
                corners = begin_of[j], begin_of[j + 1]
                gap = polygon_penetration(centre, size, local, s, spheres, corners, other)
            else:
                gap = corner_penetration(row_vector(centre, s), r, mine, other)
        low = min(min(radius[s], thickness[i]), min(bearing[j], thickness[j]))
        count = add_contact(
            report, history, touching, geometry, count, k, ahead, i, j, both, gap, radius[s], low
        )
    return count


@njit(**INNER)
def crossing_edges(model: Model, state: State, pairs: BodyPairs, ahead: int, count: int) -> int:
    """Write down the edges that touch edges; return the number of contacts so far."""
    begin, ends, material, row = pairs.begin, pairs.ends, model.material, model.sphere_row
    history, touching, geometry, report = (
        pairs.history, pairs.touching, pairs.geometry, state.report,
    )  # fmt: skip
    bearing, thickness = model.body_contact_radius, model.half_thickness
    centre, edge, edge_radius = state.centre, model.edge_ends, model.edge_radius
    motion, axes, half = state.motion, state.axes, model.half_extent
    local, kinds = model.sphere_centre, model.material_pairs.shape[0]
    for k in range(begin[EDGE_EDGE], begin[EDGE_EDGE + 1]):
        e, f = ends[k, 0], ends[k, 1]
        i, j = row[edge[e, 0]], row[edge[f, 0]]
        both, r, q = material[i] * kinds + material[j], edge_radius[i], edge_radius[j]
        a, b = row_vector(centre, edge[e, 0]), row_vector(centre, edge[f, 0])
        along = sub(row_vector(centre, edge[e, 1]), a)
        gap = edge_edge(a, along, b, sub(row_vector(centre, edge[f, 1]), b), r, q)
        # Crossed cylinders: as a sphere on a plane, of the mean radius.
        mean = math.sqrt(bearing[i] * bearing[j])
        low = min(min(bearing[i], thickness[i]), min(bearing[j], thickness[j]))
        if (model.sharp[i] or model.sharp[j]) and gap[0] < low:
            mine = box_of(motion, axes, half, edge_radius, i)
            other = box_of(motion, axes, half, edge_radius, j)
            first = edge_of(centre, local, edge[e, 0], edge[e, 1])
            second = edge_of(centre, local, edge[f, 0], edge[f, 1])
            gap = edge_penetration(first, mine, second, other, gap)
        count = add_contact(
            report, history, touching, geometry, count, k, ahead, i, j, both, gap, mean, low
        )
    return count


@njit(**INNER)
def detect_contacts(model: Model, state: State, pairs: BodyPairs, ahead: int) -> int:
    """Write down all pairs that touch, numbered after those of balls; return how many."""
    count = spheres_on_planes(model, state, pairs, ahead, 0)
    count = spheres_on_spheres(model, state, pairs, ahead, count)
    count = spheres_on_bodies(model, state, pairs, ahead, count)
    return crossing_edges(model, state, pairs, ahead, count)


@njit(**INNER)
def point_velocity(motion: Numbers, i: int, first: int, arm: Vector) -> Vector:
    """Velocity [m/s] of row i's point at an arm from its centre.

    `first` is VELOCITY for the mean of the step, END_VELOCITY for its end.
    """
    ω = (motion[i, first + 3], motion[i, first + 4], motion[i, first + 5])
    x, y, z = cross(ω, arm)
    return motion[i, first] + x, motion[i, first + 1] + y, motion[i, first + 2] + z


@njit(**INNER)
def inverse_effective_mass(
    inverse_mass: float, inverse_inertia: Numbers, i: int, arm: Vector, n: Vector
) -> float:
    """1/m* [1/kg] of a body's point along n: 1/m + (r × n)·I⁻¹(r × n)."""
    x, y, z = cross(arm, n)
    s = inverse_inertia
    square = s[i, 0] * x * x + s[i, 1] * y * y + s[i, 2] * z * z
    mixed = s[i, 3] * x * y + s[i, 4] * x * z + s[i, 5] * y * z
    return inverse_mass + square + 2.0 * mixed


@njit(**INNER)
def bearing_depth(history: Numbers, pair: int, depth: float, closing: float, dt: float) -> float:
    """Depth [m] that bears load; a crossing of edges bears none where it came into being.

    Edges begin to cross when a corner slides over an edge, with the faces already pressed
    together, and so does a sharp corner bear as it slides onto a face. To let that depth bear at
    once would make energy from nothing.
    """
    if history[pair, 3] == 0.0 and dt > 0.0:
        history[pair, 4] = max(0.0, depth - max(0.0, closing) * dt)
    history[pair, 4] = min(history[pair, 4], depth)
    return float(depth - history[pair, 4])


@njit(**INNER)
def contact_loads(model: Model, state: State, pairs: BodyPairs, count: int, dt: float) -> None:
    """Forces and torques of all contacts written down: what one body gets the other loses."""
    table, inverse_mass = model.material_pairs, model.inverse_mass
    motion, loads, inverse_inertia = state.motion, state.contact_load, state.world_inverse_inertia
    touching, geometry, history = pairs.touching, pairs.geometry, pairs.history
    kinds, corners, edges = table.shape[0], pairs.begin[SPHERE_BOX], pairs.begin[EDGE_EDGE]
    energy, stiffest = state.report[ELASTIC_ENERGY], state.report[STIFFEST]
    for k in range(count):
        pair, i, j, both = touching[k, 0], touching[k, 1], touching[k, 2], touching[k, 3]
        n, depth, radius = row_vector(geometry, k), geometry[k, 6], geometry[k, 7]
        point = (geometry[k, 3], geometry[k, 4], geometry[k, 5])
        arm_i, arm_j = sub(point, row_vector(motion, i)), sub(point, row_vector(motion, j))
        yield_i, yield_j = free_inverse_mass(model, i, n), free_inverse_mass(model, j, n)
        inverse_i = inverse_effective_mass(yield_i, inverse_inertia, i, arm_i, n)
        inverse_j = inverse_effective_mass(yield_j, inverse_inertia, j, arm_j, n)
        mass = 1.0 / (inverse_i + inverse_j)
        if not mass * (inverse_mass[i] + inverse_mass[j]) < LOCKED_MASS:
            mass = 1.0 / (inverse_mass[i] + inverse_mass[j])
        end_i = point_velocity(motion, i, END_VELOCITY, arm_i)
        end = sub(end_i, point_velocity(motion, j, END_VELOCITY, arm_j))
        before, bearing = history[pair, 3] - history[pair, 4], depth
        if pair >= edges or (pair >= corners and (model.sharp[i] or model.sharp[j])):
            bearing = bearing_depth(history, pair, depth, -dot(end, n), dt)
        history[pair, 3] = depth
        if bearing <= 0.0:
            for d in range(3):
                history[pair, d], geometry[k, 8 + d] = 0.0, 0.0
            continue
        p, q = both // kinds, both % kinds
        modulus, shear, ζ, μ = table[p, q, 0], table[p, q, 1], table[p, q, 2], table[p, q, 3]
        c = pair_constants(modulus, shear, ζ, μ, radius, mass)
        mean_i = point_velocity(motion, i, VELOCITY, arm_i)
        mean = sub(mean_i, point_velocity(motion, j, VELOCITY, arm_j))
        inverse_root = 1.0 / math.sqrt(before) if before > 0.0 else 0.0
        root = math.sqrt(bearing)
        roots = (root, math.sqrt(root), 1.0 / root)
        weight = damping_weight(inverse_root, bearing, -dot(end, n), dt)
        force, tangential, elastic = contact_force(
            c, row_vector(history, pair), inverse_root, n, bearing, roots, weight, mean, end, dt
        )
        torque_i, torque_j = cross(arm_i, force), cross(arm_j, force)
        for d in range(3):
            history[pair, d], geometry[k, 8 + d] = tangential[d], force[d]
            loads[i, d] += force[d]
            loads[j, d] -= force[d]
            loads[i, 3 + d] += torque_i[d]
            loads[j, 3 + d] -= torque_j[d]
        energy += elastic
        stiffest = max(stiffest, c[5] * root)
    state.report[ELASTIC_ENERGY], state.report[STIFFEST] = energy, stiffest
