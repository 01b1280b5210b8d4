"""Compiled loops: search for faces near particles, and penalty forces between those that touch.

Faces are closed, as `geometry.face_kernels` has them.
"""

import math
from typing import NamedTuple

import numpy as np
from numba import njit

from quintet.components.shared.contact.laws import contact_stiffness, friction
from quintet.components.shared.geometry.face_kernels import Array, Cells, Whole, foot, place_on
from quintet.components.shared.numba_options import EXACT, INNER

HALF_DEPTH = 0.5  # m along y, of edges in a plane
ON = 1e-3  # of a radius: a particle whose foot is so little beside a face counts as above it


class Surface(NamedTuple):
    """Faces and nodes as they are at the begin of a step."""

    corner: Whole  # (m, 4) nodes
    active: Array  # (m,) 1 or 0
    modulus: Array  # (m,) Pa
    thickness: Array  # (m,) m
    friction: Array  # (m,) 1
    stiffness: Array  # (m,) 1
    position: Array  # (k, 3) m
    velocity: Array  # (k, 3) m/s, mean of the last step


class Points(NamedTuple):
    """Particles at the start of a step: arrays by row; `identity` stays while rows change."""

    place: Array  # (n, 3 or more) m
    velocity: Array  # (n, 3) m/s, changed by contact
    identity: Whole  # (n,)
    mass: Array  # (n,) kg
    area: Array  # (n,) m2
    modulus: Array  # (n,) Pa
    radius: Array  # (n,) m, half a spacing
    spin: Array  # (n, 3) rad/s, changed by friction; (0, 3) of points that do not turn
    inverse_moment: Array  # (n,) 1/(kg m2), that about any axis; (0,) likewise
    fixed: Whole  # (n,) 1 2 4 added up: does not move along x, y, z; (0,) where all are free


class Near(NamedTuple):
    """Faces near particles: those of row `row[q]` are face[begin[q] : begin[q + 1]], rising."""

    row: Whole
    begin: Whole
    face: Whole


class Loads(NamedTuple):
    """What contact adds to at nodes, and tangential springs."""

    force: Array  # (k, 3) N, on nodes; added to
    stiffness: Array  # (k,) N/m, row sums at nodes; added to
    slip: Array  # (any, 3) m, by the number of a particle: stretch of its tangential spring
    held: Array  # (any,) J, likewise: energy of that spring
    kicked: Array  # (any, 3) m/s, likewise: half of what the step's force changes its velocity by


class Sums(NamedTuple):
    """Sums over contacts."""

    energy: float  # J, held by the springs
    dissipated: float  # J, by friction in this step
    half_kick: float  # J, that half of a step's force would add to the kinetic energy
    rate: float  # 1/s2, largest row sum of stiffness over mass of a particle that is near
    turning: float  # 1/s2, largest k (1/m + R²/I) of one that turns
    depth: float  # m, deepest penetration
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
def list_near(place: Array, reach: float, cells: Cells, faces: Whole) -> Near:
    """List the faces whose boxes are nearer to a particle than a reach.

    Parameters
    ----------
    place : (n, 3 or more) float array, m
    reach : float, m
    cells : Cells
        Of some faces.
    faces : (c,) int array
        Numbers of these, rising.
    """
    low, size, grid, corner = cells.low, cells.size, cells.grid, cells.corner
    seen, hits = np.full(corner.shape[0], -1), np.empty(corner.shape[0], np.int64)
    rows, begin, listed = [0 for _ in range(0)], [0], [0 for _ in range(0)]
    span = np.empty((2, 3), np.int64)
    for i in range(place.shape[0]):
        inside = True
        for d in range(3):
            least = (place[i, d] - reach - low[d]) / size
            most = (place[i, d] + reach - low[d]) / size
            inside &= most >= 0.0 and least <= grid[d]
            span[0, d] = int(min(max(least, 0.0), grid[d] - 1.0))
            span[1, d] = int(min(max(most, 0.0), grid[d] - 1.0))
        if not inside:
            continue
        count = 0
        for a in range(span[0, 0], span[1, 0] + 1):
            for b in range(span[0, 1], span[1, 1] + 1):
                for c in range(span[0, 2], span[1, 2] + 1):
                    cell = (a * grid[1] + b) * grid[2] + c
                    for at in range(cells.begin[cell], cells.begin[cell + 1]):
                        f = cells.face[at]
                        if seen[f] != i and box_distance(place[i], corner[f]) <= reach * reach:
                            seen[f], hits[count] = i, f
                            count += 1
        if count:
            for f in np.sort(hits[:count]):
                listed.append(faces[f])
            rows.append(i)
            begin.append(len(listed))
    return Near(np.array(rows, np.int64), np.array(begin, np.int64), np.array(listed, np.int64))


@njit(**INNER)
def box_distance(p, x):  # type: ignore[no-untyped-def]
    """Squared distance [m2] of a point from the box around a face (4, 3)."""
    away = 0.0
    for d in range(3):
        least = min(min(x[0, d], x[1, d]), min(x[2, d], x[3, d]))
        most = max(max(x[0, d], x[1, d]), max(x[2, d], x[3, d]))
        away += max(least - p[d], p[d] - most, 0.0) ** 2
    return away


@njit(**INNER)
def gather(surface, f, x):  # type: ignore[no-untyped-def]
    """Write the corners (4, 3) m of a face."""
    for c in range(4):
        node = surface.corner[f, c]
        for d in range(3):
            x[c, d] = surface.position[node, d]


@njit(**INNER)
def normal_at(x, room, out):  # type: ignore[no-untyped-def]
    """Write the outward normal (3,) of a face (4, 3), of its tangents in `room`."""
    tx, ty, tz = room[1, 0], room[1, 1], room[1, 2]
    sx, sy, sz = room[2, 0], room[2, 1], room[2, 2]
    is_edge = True
    for d in range(3):
        is_edge &= x[0, d] == x[3, d] and x[1, d] == x[2, d]
    if is_edge:
        sx, sy, sz = 0.0, -HALF_DEPTH, 0.0
    out[0], out[1], out[2] = ty * sz - tz * sy, tz * sx - tx * sz, tx * sy - ty * sx
    length = math.sqrt(out[0] ** 2 + out[1] ** 2 + out[2] ** 2)
    for d in range(3):
        out[d] = out[d] / length if length > 0.0 else 0.0


@njit(**INNER)
def nearest(p, near, q, surface, reach, x, room):  # type: ignore[no-untyped-def]
    """Nearest active face of the listed ones within a reach, -1 if there is none; ξ and η.

    The face with the nearest box comes first: it usually is the one, and the others are skipped.
    """
    first, least = -1, reach * reach
    for at in range(near.begin[q], near.begin[q + 1]):
        f = near.face[at]
        if surface.active[f] > 0.0:
            gather(surface, f, x)
            away = box_distance(p, x)
            if away < least:
                first, least = f, away
    best, face, xi, eta = reach * reach, -1, 0.0, 0.0
    if first >= 0:
        gather(surface, first, x)
        a, b, d2 = foot(p, x, room)
        if d2 < best:
            best, face, xi, eta = d2, first, a, b
        for at in range(near.begin[q], near.begin[q + 1]):
            f = near.face[at]
            if surface.active[f] == 0.0 or f == first:
                continue
            gather(surface, f, x)
            if box_distance(p, x) < best:
                a, b, d2 = foot(p, x, room)
                if d2 < best:
                    best, face, xi, eta = d2, f, a, b
    return face, xi, eta


@njit(**INNER)
def gap_of(p, x, xi, eta, radius, room, n):  # type: ignore[no-untyped-def]
    """Gap [m] between a particle and a face, ∞ where they cannot touch; direction into `n` (3,).

    Above the face the direction is that from its nearest point; a particle whose centre is below
    the face is pushed along the normal, if it is by a radius at most.
    """
    place_on(x, xi, eta, room)
    normal_at(x, room, n)
    above, square = 0.0, 0.0
    for d in range(3):
        above += (p[d] - room[0, d]) * n[d]
        square += (p[d] - room[0, d]) ** 2
    distance = math.sqrt(square)
    if above > 0.0:
        for d in range(3):
            n[d] = (p[d] - room[0, d]) / distance
        return distance - radius
    beside = math.sqrt(max(square - above * above, 0.0))
    return above - radius if beside <= ON * radius else math.inf


@njit(**EXACT)
def touch(
    points: Points, surface: Surface, near: Near, last: float, dt: float, loads: Loads
) -> Sums:
    """Change velocities by the forces on particles that touch a face; each touches the nearest.

    Particles nearer to a face than a radius count for the stable step although they do not touch.

    Parameters
    ----------
    points, surface, near
    last : float, s
        Step before, in which tangential springs were stretched.
    dt : float, s
        Step that begins, all of whose impulse comes at once.
    loads : Loads
        Added to.
    """
    x, room, n, weight = np.empty((4, 3)), np.empty((3, 3)), np.empty(3), np.empty(4)
    slid, at, turning, limit = np.empty(3), np.empty(3), 0.0, math.inf
    energy, dissipated, rate, deepest, half_kick = 0.0, 0.0, 0.0, 0.0, 0.0
    for q in range(near.row.shape[0]):
        i, radius = near.row[q], points.radius[near.row[q]]
        for d in range(3):
            at[d] = points.place[i, d]
        face, xi, eta = nearest(at, near, q, surface, 2.0 * radius, x, room)
        number, gap = points.identity[i], math.inf
        slip, half = loads.slip[number], loads.kicked[number]
        half[0], half[1], half[2] = 0.0, 0.0, 0.0
        if face >= 0:
            gather(surface, face, x)
            gap = gap_of(at, x, xi, eta, radius, room, n)
            if gap < -2.0 * radius:  # it has passed through
                deepest, gap = max(deepest, -gap), math.inf
        if gap <= radius:
            weight[0], weight[1] = 0.25 * (1.0 - xi) * (1.0 - eta), 0.25 * (1.0 + xi) * (1.0 - eta)
            weight[2], weight[3] = 0.25 * (1.0 + xi) * (1.0 + eta), 0.25 * (1.0 - xi) * (1.0 + eta)
            stiff = contact_stiffness(
                points.area[i], 2.0 * radius, points.modulus[i], surface.thickness[face],
                surface.modulus[face], surface.stiffness[face],
            )  # fmt: skip
            rate = max(rate, 2.0 * stiff / points.mass[i])
            if points.spin.shape[0]:
                mobility = 1.0 / points.mass[i] + radius * radius * points.inverse_moment[i]
                turning = max(turning, stiff * mobility)
            closing = 0.0
            for d in range(3):
                moved = 0.0
                for c in range(4):
                    moved += weight[c] * surface.velocity[surface.corner[face, c], d]
                slid[d] = last * (points.velocity[i, d] - moved)
                closing -= n[d] * (points.velocity[i, d] - moved)
            if closing > 0.0:
                limit = min(limit, 0.5 * (max(gap, 0.0) + radius) / closing)
            for c in range(4):
                loads.stiffness[surface.corner[face, c]] += 2.0 * stiff * weight[c]
        if gap >= 0.0:
            slip[0], slip[1], slip[2] = 0.0, 0.0, 0.0
            dissipated, loads.held[number] = dissipated + loads.held[number], 0.0
            continue
        push = -stiff * gap
        lever = radius + gap  # m, from the centre to the face, against the normal
        if points.spin.shape[0]:
            wx, wy, wz = points.spin[i, 0], points.spin[i, 1], points.spin[i, 2]
            slid[0] -= last * lever * (wy * n[2] - wz * n[1])
            slid[1] -= last * lever * (wz * n[0] - wx * n[2])
            slid[2] -= last * lever * (wx * n[1] - wy * n[0])
        held, lost = friction(slip, slid, n, stiff, surface.friction[face] * push)
        energy, dissipated = energy - 0.5 * push * gap + held, dissipated + lost
        loads.held[number] = held
        deepest = max(deepest, -gap)
        for d in range(3):
            force = push * n[d] - stiff * slip[d]
            for c in range(4):
                loads.force[surface.corner[face, c], d] -= weight[c] * force
            if points.fixed.shape[0] and (points.fixed[i] >> d) & 1:
                continue
            kicked = dt * force / points.mass[i]
            half_kick += 0.5 * dt * force * (points.velocity[i, d] + 0.25 * kicked)
            points.velocity[i, d] += kicked
            half[d] = 0.5 * kicked
        if points.spin.shape[0]:
            twist = dt * stiff * lever * points.inverse_moment[i]
            points.spin[i, 0] += twist * (n[1] * slip[2] - n[2] * slip[1])
            points.spin[i, 1] += twist * (n[2] * slip[0] - n[0] * slip[2])
            points.spin[i, 2] += twist * (n[0] * slip[1] - n[1] * slip[0])
    return Sums(energy, dissipated, half_kick, rate, turning, deepest, limit)
