"""Compiled loops: forces between particles and the faces that they touch."""

import math
from typing import NamedTuple

import numpy as np
from numba import njit

from quintet.components.shared.contact.laws import (
    contact_stiffness,
    deepest_overlap,
    friction,
    hertz_stiffness,
    in_series,
    stretch_anew,
)
from quintet.components.shared.contact.search import (
    Near,
    gap_of,
    nearest,
    places_of_listed,
    spread_out,
    write_shares,
)
from quintet.components.shared.geometry.face_kernels import Array, Whole
from quintet.components.shared.numba_options import EXACT, INNER


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
    spread: Whole  # (2,) points along both directions over which a particle's force is spread


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
    kicked: Array  # (any, 3) m/s, likewise: half of what the step's force changes its velocity by


class Sums(NamedTuple):
    """Sums over contacts, and extremes of what is near."""

    energy: float  # J, held by the springs
    dissipated: float  # J, by friction in this step
    half_kick: float  # J, that half of a step's force would add to the kinetic energy
    points: float  # 1/s2, largest ω² of a particle on faces at rest
    nodes: float  # 1/s2, largest ω² of what holds a particle, were it at rest
    impact: float  # 1/s2, largest k/m of a particle
    depth: float  # m, deepest penetration
    spread: float  # 1, largest radius of a sphere's contact over the thickness behind the face
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
    points: Points, surface: Surface, near: Near, last: float, dt: float, loads: Loads
) -> Sums:
    """Change velocities by the forces on particles that touch a face; each touches the nearest.

    Particles nearer to a face than a radius count for the stable step although they do not touch.

    Parameters
    ----------
    last : float, s
        Step before, in which tangential springs were stretched.
    dt : float, s
        Step that begins, all of whose impulse comes at once.
    loads : Loads
        Added to.
    """
    count, listed = near.row.shape[0], places_of_listed(near, surface.corner, surface.position)
    face, several = np.full(count, -1), 4 * surface.spread[0] * surface.spread[1]
    nodes, weight = np.zeros((count, several), np.int64), np.zeros((count, several))
    room, n, slid, at = np.empty((3, 3)), np.empty(3), np.empty(3), np.empty(3)
    energy, dissipated, half_kick, limit = 0.0, 0.0, 0.0, math.inf
    of_points, impact, deepest, spread = 0.0, 0.0, 0.0, 0.0
    for q in range(count):
        i = near.row[q]
        number, radius, gap = points.identity[i], points.radius[i], math.inf
        for d in range(3):
            at[d], loads.kicked[number, d] = points.place[i, d], 0.0
        f, xi, eta = nearest(at, near, q, listed, 2.0 * radius, room)
        if f >= 0:
            gap = gap_of(at, listed.x[f], xi, eta, radius, room, n)
            if gap < -2.0 * radius:  # it has passed through
                deepest, gap = max(deepest, -gap), math.inf
        if gap > radius:
            dissipated += let_go(loads, number)
            continue
        face[q] = near.listed[f]
        write_shares(surface.corner[face[q]], xi, eta, 1.0, nodes[q], weight[q], 0)
        if several > 4:
            gap = mean_gap(at, f, near, q, listed, surface, radius, gap, room, n, nodes, weight)
        closing = write_slid(points, i, surface, nodes[q], weight[q], n, last, slid)
        if closing > 0.0:
            limit = min(limit, 0.5 * (max(gap, 0.0) + radius) / closing)
        push, stored, side, most, most_aside = law_of(points, i, surface, face[q], gap, closing)
        impact = max(impact, most / points.mass[i])
        of_points = max(of_points, most_aside, most / points.mass[i])
        for c in range(several):
            loads.stiffness[nodes[q, c]] += weight[q, c] * most
        if gap >= 0.0:
            dissipated += let_go(loads, number)
            continue
        turn_over_face(points, i, n, last, radius + gap, slid)
        held, lost = rub(points, loads, number, slid, n, side, surface.friction[face[q]] * push)
        energy, dissipated, deepest = energy + stored + held, dissipated + lost, max(deepest, -gap)
        half_kick += apply(points, i, nodes[q], weight[q], n, push, side, dt, loads)
        if points.spin.shape[0]:
            half_kick += twist(points, i, loads.slip, number, n, dt * side * (radius + gap))
            spread = max(spread, math.sqrt(-radius * gap) / surface.thickness[face[q]])
    held_by = of_what_holds(nodes, weight, surface.mass, loads.stiffness)
    return Sums(energy, dissipated, half_kick, of_points, held_by, impact, deepest, spread, limit)


@njit(**INNER)
def let_go(loads, number):  # type: ignore[no-untyped-def]
    """Release the tangential spring of a particle; return its energy [J], which is lost."""
    lost = loads.held[number]
    loads.held[number] = 0.0
    for d in range(3):
        loads.slip[number, d] = 0.0
    return lost


@njit(**INNER)
def mean_gap(p, f, near, q, listed, surface, radius, gap, room, n, nodes, weight):  # type: ignore[no-untyped-def]
    """Spread a particle over the faces that it covers; return the mean gap [m] over them.

    One that covers what is no face stays at its nearest point.
    """
    others, shares = np.empty_like(nodes[q]), np.empty_like(weight[q])
    if not spread_out(
        p, f, near, q, listed, surface.corner, surface.spread, radius, room, n, others, shares
    ):  # fmt: skip
        return gap
    gap = -radius
    for c in range(others.shape[0]):
        nodes[q, c], weight[q, c] = others[c], shares[c]
        for d in range(3):
            gap += shares[c] * n[d] * (p[d] - surface.position[others[c], d])
    return gap


@njit(**INNER)
def write_slid(points, i, surface, nodes, weight, n, last, slid):  # type: ignore[no-untyped-def]
    """Write by how much [m] a particle moved over nodes in the last step; closing velocity."""
    closing = 0.0
    for d in range(3):
        moved = 0.0
        for c in range(nodes.shape[0]):
            moved += weight[c] * surface.velocity[nodes[c], d]
        slid[d] = last * (points.velocity[i, d] - moved)
        closing -= n[d] * (points.velocity[i, d] - moved)
    return closing


@njit(**INNER)
def law_of(points, i, surface, f, gap, closing):  # type: ignore[no-untyped-def]
    """Force and stiffness of a particle at a gap [m], and largest ones in the coming impact.

    Returns
    -------
    push, stored : float, N and J
        Normal force, and its energy.
    side : float, N/m
        Stiffness along the face.
    most : float, N/m
        Largest stiffness along the normal, as far as the particle may come.
    most_aside : float, 1/s2
        ω² of a particle that sticks and turns.
    """
    depth, radius = max(-gap, 0.0), points.radius[i]
    if not points.spin.shape[0]:
        stiff = contact_stiffness(
            points.area[i], 2.0 * radius, points.modulus[i], surface.thickness[f],
            surface.modulus[f], surface.stiffness[f],
        )  # fmt: skip
        return stiff * depth, 0.5 * stiff * depth * depth, stiff, stiff, 0.0
    modulus = surface.stiffness[f] * in_series(points.modulus[i], surface.modulus[f])
    shear = surface.stiffness[f] * in_series(points.tangential[i], surface.tangential[f])
    stiff, mass = hertz_stiffness(modulus, radius, depth), points.mass[i]
    push, ratio = 2.0 / 3.0 * stiff * depth, 4.0 * shear / modulus
    most = hertz_stiffness(modulus, radius, deepest_overlap(depth, closing, modulus, radius, mass))
    aside = 0.0
    if surface.friction[f] > 0.0:
        aside = ratio * most * (1.0 / mass + radius * radius * points.inverse_moment[i])
    return push, 0.4 * push * depth, ratio * stiff, most, aside


@njit(**INNER)
def turn_over_face(points, i, n, last, lever, slid):  # type: ignore[no-untyped-def]
    """Add to `slid` what the spin of a sphere moves its surface by, at a lever [m] from it."""
    if points.spin.shape[0]:
        wx, wy, wz = points.spin[i, 0], points.spin[i, 1], points.spin[i, 2]
        slid[0] -= last * lever * (wy * n[2] - wz * n[1])
        slid[1] -= last * lever * (wz * n[0] - wx * n[2])
        slid[2] -= last * lever * (wx * n[1] - wy * n[0])


@njit(**INNER)
def rub(points, loads, number, slid, n, side, limit):  # type: ignore[no-untyped-def]
    """Stretch a particle's tangential spring; return the energy [J] that it holds, and loses."""
    slip, changed = loads.slip[number], 0.0
    if points.spin.shape[0]:  # its stiffness follows the overlap
        changed = loads.held[number] - stretch_anew(slip, loads.held[number], side)
    held, lost = friction(slip, slid, n, side, limit)
    loads.held[number] = held
    return held, lost + changed


@njit(**INNER)
def apply(points, i, nodes, weight, n, push, side, dt, loads):  # type: ignore[no-untyped-def]
    """Apply the force on a particle, and its reaction on nodes; half of its kinetic energy [J]."""
    number, half_kick = points.identity[i], 0.0
    for d in range(3):
        force = push * n[d] - side * loads.slip[number, d]
        for c in range(nodes.shape[0]):
            loads.force[nodes[c], d] -= weight[c] * force
        if points.fixed.shape[0] and (points.fixed[i] >> d) & 1:
            continue
        kicked = dt * force / points.mass[i]
        half_kick += 0.5 * dt * force * (points.velocity[i, d] + 0.25 * kicked)
        points.velocity[i, d] += kicked
        loads.kicked[number, d] = 0.5 * kicked
    return half_kick


@njit(**INNER)
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


@njit(**INNER)
def of_what_holds(nodes, weight, mass, stiffness):  # type: ignore[no-untyped-def]
    """Largest Σ w R/m [1/s2] of the nodes that hold a particle, with R = Σ w k of each.

    With k/m of the particle it bounds ω² of contact: rows of |M⁻¹K| times the vector k/m of
    particles and R/m of nodes, over that vector, are k/m + Σ w R/m and means of these (Collatz
    1942). It is exact where all of them are alike.
    """
    most = 0.0
    for q in range(nodes.shape[0]):
        holds = 0.0
        for c in range(nodes.shape[1]):
            holds += weight[q, c] * stiffness[nodes[q, c]] / mass[nodes[q, c]]
        most = max(most, holds)
    return most
