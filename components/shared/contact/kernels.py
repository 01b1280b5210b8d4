"""Compiled loops: forces between particles and the faces that they touch."""

import math
from typing import NamedTuple

import numpy as np
from numba import njit

from quintet.components.shared.contact.laws import (
    change_stiffness,
    friction,
    in_series,
    layer_law,
    sphere_law,
)
from quintet.components.shared.contact.search import Near
from quintet.components.shared.geometry.face_kernels import Array, Whole
from quintet.components.shared.numba_options import EXACT, LANEWISE


class Surface(NamedTuple):
    """Faces and nodes as they are at the begin of a step."""

    corner: Whole  # (m, 4) nodes
    modulus: Array  # (m,) Pa, longitudinal; where spheres touch E/(1-ν²)
    tangential: Array  # (m,) Pa, G/(2-ν)
    thickness: Array  # (m,) m
    friction: Array  # (m,) 1
    stiffness: Array  # (m,) 1
    mass: Array  # (k,) kg
    position: Array  # (k, 3) m
    velocity: Array  # (k, 3) m/s, mean of the last step


class Points(NamedTuple):
    """Particles at the start of a step: arrays by row; `identity` stays while rows change.

    Those with `spin` are spheres, which touch by Hertz's law.
    """

    place: Array  # (n, 3 or more) m
    velocity: Array  # (n, 3) m/s, changed by contact
    identity: Whole  # (n,)
    mass: Array  # (n,) kg
    area: Array  # (n,) m2; (0,) of spheres
    modulus: Array  # (n,) Pa, longitudinal; of spheres E/(1-ν²)
    tangential: Array  # (n,) Pa, G/(2-ν) of spheres; (0,) of others
    radius: Array  # (n,) m; of particles half a spacing
    spin: Array  # (n, 3) rad/s, changed by friction; (0, 3) of points that do not turn
    inverse_moment: Array  # (n,) 1/(kg m2), that about any axis; (0,) likewise
    fixed: Whole  # (n,) 1 2 4 added up: does not move along x, y, z; (0,) where all are free


class Loads(NamedTuple):
    """What contact adds to at nodes, and tangential springs."""

    force: Array  # (k, 3) N, on nodes; added to
    stiffness: Array  # (k,) N/m, Σ w k of the particles near nodes; added to
    slip: Array  # (any, 3) m, by the number of a particle: stretch of its tangential spring
    held: Array  # (any,) J, likewise: energy of that spring
    kicked: Array  # (any, 3) m/s, likewise: half of the step's velocity change by contact


class Sums(NamedTuple):
    """Sums over contacts, and extreme values of particles near faces."""

    energy: float  # J, held by the springs
    dissipated: float  # J, by friction in this step
    half_kick: float  # J, that half of a step's force would add to the kinetic energy
    points: float  # 1/s2, largest ω² of a particle on faces at rest
    nodes: float  # 1/s2, largest ω² of what holds a particle, were it at rest
    impact: float  # 1/s2, largest k/m of a particle
    depth: float  # 1, largest penetration over the radius of the particle, or as `room_below`
    spread: float  # 1, largest radius of a sphere's contact over the least edge of its element
    limit: float  # s, in which one that is near comes half of the way to a radius below its face


@njit(**EXACT)
def furthest_from(velocity: Array, mean: Array) -> float:
    """Largest magnitude [m/s] of velocities (n, 3 or more) less a mean one (3,)."""
    most = 0.0
    for i in range(velocity.shape[0]):
        square = 0.0
        for d in range(3):
            square += (velocity[i, d] - mean[d]) ** 2
        most = max(most, square)
    return math.sqrt(most)


@njit(**EXACT)
def touch(
    points: Points, surface: Surface, near: Near, last: float, dt: float, loads: Loads, off: float
) -> Sums:
    """Change velocities by the forces on particles that touch a face; each touches the nearest.

    Particles nearer to a face than a radius count for the stable step although they do not touch.

    Parameters
    ----------
    near : Near
        With gaps, normals and weights of this step, as `measure` writes them.
    last : float, s
        Step before, in which tangential springs were stretched.
    dt : float, s
        Step that begins, all of whose impulse comes at once.
    loads : Loads
        Added to.
    off : float, 1
        As in `measure`.
    """
    nodes, weight, is_sphere = near.nodes, near.weight, points.spin.shape[0] > 0
    n, slid = np.empty(3), np.empty(3)
    energy, dissipated, half_kick, limit = 0.0, 0.0, 0.0, math.inf
    of_points, impact, deepest, spread = 0.0, 0.0, 0.0, 0.0
    for q in range(near.row.shape[0]):
        i, gap = near.row[q], near.gap[q]
        number, radius, face = points.identity[i], points.radius[i], near.listed[near.last[q]]
        for d in range(3):
            n[d], loads.kicked[number, d] = near.normal[q, d], 0.0
        if gap > radius:
            dissipated += let_go(loads, number)
            continue
        closing = write_slid(points, i, surface, nodes, weight, q, n, last, slid)
        if closing > 0.0:
            limit = min(limit, 0.5 * (max(gap, 0.0) + radius) / closing)
        law = law_of(points, i, surface, face, max(-gap, 0.0), closing)
        push, stored, side, most, aside = law
        impact, of_points = max(impact, most / points.mass[i]), max(of_points, aside)
        for c in range(nodes.shape[1]):
            loads.stiffness[nodes[q, c]] += weight[q, c] * most
        if gap >= 0.0:
            dissipated += let_go(loads, number)
            continue
        if is_sphere:
            turn_over_face(points.spin, i, n, last * (radius + gap), slid)
        # That of a layer changes where it slides onto a stiffer or a thinner face.
        dissipated += change_stiffness(loads.slip, loads.held, number, side)
        held, lost = friction(loads.slip, number, slid, n, side, surface.friction[face] * push)
        loads.held[number] = held
        energy, dissipated = energy + stored + held, dissipated + lost
        deepest = max(deepest, -gap / room_below(radius, surface.thickness[face], off))
        half_kick += apply(points, i, nodes, weight, q, n, push, side, dt, loads)
        if is_sphere:
            half_kick += twist(points, i, loads.slip, number, n, dt * side * (radius + gap))
            edge = min(surface.thickness[face], shortest_side(near.x[near.last[q]]))
            spread = max(spread, math.sqrt(-radius * gap) / edge)
    held_by = of_what_holds(nodes, weight, surface.mass, loads.stiffness)
    of_points = max(of_points, impact)
    return Sums(energy, dissipated, half_kick, of_points, held_by, impact, deepest, spread, limit)


@njit(**EXACT)
def released_energy(points: Points, surface: Surface, near: Near, dt: float) -> float:
    """Energy [J] that is lost if all normal springs vanish before a step of dt [s].

    It is what they hold, and what half of the step's impulse would do on both sides: their motion
    at the step's begin still lacks that half.
    """
    nodes, weight, energy = near.nodes, near.weight, 0.0
    n, slid = np.empty(3), np.empty(3)
    for q in range(near.row.shape[0]):
        if near.gap[q] >= 0.0:
            continue
        i, lightness = near.row[q], 1.0 / points.mass[near.row[q]]
        for d in range(3):
            n[d] = near.normal[q, d]
        for c in range(nodes.shape[1]):
            lightness += weight[q, c] ** 2 / surface.mass[nodes[q, c]]
        closing = write_slid(points, i, surface, nodes, weight, q, n, 0.0, slid)
        law = law_of(points, i, surface, near.listed[near.last[q]], -near.gap[q], 0.0)
        push, stored = law[0], law[1]
        energy += stored - 0.5 * dt * push * (closing - 0.25 * dt * push * lightness)
    return energy


@njit(**LANEWISE)
def shortest_side(x):  # type: ignore[no-untyped-def]
    """Shortest side [m] of a face (4, 3); the corner of a triangle that stands twice has none."""
    shortest = math.inf
    for c in range(4):
        square = 0.0
        for d in range(3):
            square += (x[(c + 1) % 4, d] - x[c, d]) ** 2
        if square > 0.0:
            shortest = min(shortest, square)
    return math.sqrt(shortest)


@njit(**LANEWISE)
def room_below(radius, thickness, off):  # type: ignore[no-untyped-def]
    """Depth [m] to which a particle stays on its side of a face before a layer of a thickness [m].

    Deeper than half of a single layer the nearest face of a point of a surface is that behind.
    """
    return radius if off > 0.0 else min(radius, 0.5 * thickness)


@njit(**LANEWISE)
def law_of(points, i, surface, f, depth, closing):  # type: ignore[no-untyped-def]
    """Forces and stiffness of a particle at a depth [m], as `sphere_law` gives them."""
    scale, radius, modulus = surface.stiffness[f], points.radius[i], points.modulus[i]
    if points.spin.shape[0]:
        law = sphere_law(
            radius, points.mass[i], points.inverse_moment[i],
            scale * in_series(modulus, surface.modulus[f]),
            scale * in_series(points.tangential[i], surface.tangential[f]),
            surface.friction[f], depth, closing,
        )  # fmt: skip
    else:
        element = surface.thickness[f] / surface.modulus[f]
        law = layer_law(points.area[i], 2.0 * radius / modulus, element, scale, depth)
    return law


@njit(**LANEWISE)
def let_go(loads, number):  # type: ignore[no-untyped-def]
    """Release the tangential spring of a particle; return its energy [J], which is lost."""
    lost = loads.held[number]
    loads.held[number] = 0.0
    for d in range(3):
        loads.slip[number, d] = 0.0
    return lost


@njit(**LANEWISE)
def write_slid(points, i, surface, nodes, weight, q, n, last, slid):  # type: ignore[no-untyped-def]
    """Write by how much [m] a particle moved over nodes in the last step; closing velocity."""
    closing = 0.0
    for d in range(3):
        moved = 0.0
        for c in range(nodes.shape[1]):
            moved += weight[q, c] * surface.velocity[nodes[q, c], d]
        slid[d] = last * (points.velocity[i, d] - moved)
        closing -= n[d] * (points.velocity[i, d] - moved)
    return closing


@njit(**LANEWISE)
def turn_over_face(spin, i, n, lever, slid):  # type: ignore[no-untyped-def]
    """Add to `slid` what spin (n, 3) moves a sphere's surface by, at a lever [m s] from it."""
    wx, wy, wz = spin[i, 0], spin[i, 1], spin[i, 2]
    slid[0] -= lever * (wy * n[2] - wz * n[1])
    slid[1] -= lever * (wz * n[0] - wx * n[2])
    slid[2] -= lever * (wx * n[1] - wy * n[0])


@njit(**LANEWISE)
def apply(points, i, nodes, weight, q, n, push, side, dt, loads):  # type: ignore[no-untyped-def]
    """Apply the force on a particle, and its reaction on nodes; half of its kinetic energy [J]."""
    number, lightness, half_kick = points.identity[i], 1.0 / points.mass[i], 0.0
    for d in range(3):
        force = push * n[d] - side * loads.slip[number, d]
        for c in range(nodes.shape[1]):
            loads.force[nodes[q, c], d] -= weight[q, c] * force
        if points.fixed.shape[0] and (points.fixed[i] >> d) & 1:
            continue
        kicked = dt * force * lightness
        half_kick += 0.5 * dt * force * (points.velocity[i, d] + 0.25 * kicked)
        points.velocity[i, d] += kicked
        loads.kicked[number, d] = 0.5 * kicked
    return half_kick


@njit(**LANEWISE)
def twist(points, i, slip, number, n, turn):  # type: ignore[no-untyped-def]
    """Turn a sphere by friction of `turn` [N s] per stretch; half of its kinetic energy [J]."""
    half_kick = 0.0
    for d in range(3):
        a, b = (d + 1) % 3, (d + 2) % 3
        moment = turn * (n[a] * slip[number, b] - n[b] * slip[number, a])  # N m s
        turned = points.inverse_moment[i] * moment
        half_kick += 0.5 * moment * (points.spin[i, d] + 0.25 * turned)
        points.spin[i, d] += turned
    return half_kick


@njit(**LANEWISE)
def of_what_holds(nodes, weight, mass, stiffness):  # type: ignore[no-untyped-def]
    """Largest Σ w R/m [1/s2] of the nodes that hold a particle, with R = Σ w k of each.

    With k/m of the particle it bounds ω² of contact: rows of |M⁻¹K| times the vector k/m of
    particles and R/m of nodes, over that vector, are k/m + Σ w R/m and means of these (Collatz
    1942). It is exact where all of them are alike.
    """
    most, rate = 0.0, np.empty_like(mass)
    for node in range(mass.shape[0]):
        rate[node] = stiffness[node] / mass[node]
    for q in range(nodes.shape[0]):
        holds = 0.0
        for c in range(nodes.shape[1]):
            holds += weight[q, c] * rate[nodes[q, c]]
        most = max(most, holds)
    return most
