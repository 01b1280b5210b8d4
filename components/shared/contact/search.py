"""Compiled search: which faces are near particles, and which of them is the nearest.

Faces are closed, as `geometry.face_kernels` has them.
"""

import math
from typing import NamedTuple

import numpy as np
from numba import njit

from quintet.components.shared.geometry.face_kernels import (
    Array,
    Cells,
    Whole,
    box_distance,
    foot,
    place_on,
)
from quintet.components.shared.numba_options import EXACT, INNER

HALF_DEPTH = 0.5  # m along y, of edges in a plane
ON = 1e-3  # of a radius: a particle whose foot is so little beside a face counts as above it
TIED = 1.0 + 1e-12  # squared distances that differ by less may be equal but for rounding


class Near(NamedTuple):
    """Faces near particles.

    Those of the particle in row `row[q]` are `face[begin[q] : begin[q + 1]]`, rising, counted
    among the `listed` ones.
    """

    row: Whole  # (r,)
    begin: Whole  # (r + 1,)
    face: Whole
    listed: Whole  # (u,) faces that are near any particle, rising
    last: Whole  # (r,) which of the listed ones was the nearest in the last step; -1 at first


class Listed(NamedTuple):
    """Places of the listed faces in this step."""

    x: Array  # (u, 4, 3) m, corners
    lowest: Array  # (u, 3) m, of the boxes around them
    highest: Array  # (u, 3) m


@njit(**EXACT)
def list_near(place: Array, reach: float, cells: Cells, faces: Whole) -> tuple[Whole, Whole, Whole]:
    """List the faces whose boxes are nearer to a particle than a reach.

    Parameters
    ----------
    place : (n, 3 or more) float array, m
    reach : float, m
    cells : Cells
        Of some faces.
    faces : (c,) int array
        Numbers of these, rising.

    Returns
    -------
    row, begin, face
        As in `Near`, with the numbers of the faces.
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
    return np.array(rows, np.int64), np.array(begin, np.int64), np.array(listed, np.int64)


@njit(**EXACT)
def places_of_listed(near: Near, corner: Whole, position: Array) -> Listed:
    """Gather the corners of listed faces, of nodes at (k, 3) m, and the boxes around them."""
    count = near.listed.shape[0]
    x, lowest, highest = np.empty((count, 4, 3)), np.empty((count, 3)), np.empty((count, 3))
    for f in range(count):
        for c in range(4):
            node = corner[near.listed[f], c]
            for d in range(3):
                x[f, c, d] = position[node, d]
        for d in range(3):
            lowest[f, d] = min(min(x[f, 0, d], x[f, 1, d]), min(x[f, 2, d], x[f, 3, d]))
            highest[f, d] = max(max(x[f, 0, d], x[f, 1, d]), max(x[f, 2, d], x[f, 3, d]))
    return Listed(x, lowest, highest)


@njit(**INNER)
def away_from(p, listed, f):  # type: ignore[no-untyped-def]
    """Squared distance [m2] of a point from the box around a listed face."""
    away = 0.0
    for d in range(3):
        away += max(max(listed.lowest[f, d] - p[d], p[d] - listed.highest[f, d]), 0.0) ** 2
    return away


@njit(**INNER)
def nearest(p, near, q, listed, reach, room):  # type: ignore[no-untyped-def]
    """Nearest of the faces of row q within a reach, -1 if there is none; ξ and η.

    That of the last step is tried first: it usually is the nearest, and the boxes of the others are
    further away.
    """
    first, least = near.last[q], math.inf
    if first < 0:
        for at in range(near.begin[q], near.begin[q + 1]):
            away = away_from(p, listed, near.face[at])
            if away < least:
                first, least = near.face[at], away
    face, xi, eta, _ = nearest_from(p, first, near, q, listed, reach * reach, room)
    near.last[q] = first if face < 0 else face
    return face, xi, eta


@njit(**INNER)
def nearest_from(p, first, near, q, listed, reach, room):  # type: ignore[no-untyped-def]
    """Nearest of the faces of row q, of which one is tried first; ξ, η and the squared distance.

    Faces as far as a squared `reach` [m2] or further do not count; -1 if there are no others. Of
    equally near faces the first one counts, whichever was tried first.
    """
    best, face = reach, -1
    xi, eta, d2 = foot(p, listed.x[first], room)
    if d2 < best:
        best, face = d2, first
    for at in range(near.begin[q], near.begin[q + 1]):
        f = near.face[at]
        if f != first and away_from(p, listed, f) <= TIED * best:
            a, b, d2 = foot(p, listed.x[f], room)
            if d2 < best or (d2 == best and f < face):
                best, face, xi, eta = d2, f, a, b
    return face, xi, eta, best


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


@njit(**INNER)
def write_shares(corner, xi, eta, share, nodes, weight, at):  # type: ignore[no-untyped-def]
    """Write the nodes (4,) of a face and shares of its shape functions at ξ and η, from `at` on."""
    for c in range(4):
        nodes[at + c] = corner[c]
    weight[at], weight[at + 1] = (1.0 - xi) * (1.0 - eta), (1.0 + xi) * (1.0 - eta)
    weight[at + 2], weight[at + 3] = (1.0 + xi) * (1.0 + eta), (1.0 - xi) * (1.0 + eta)
    for c in range(4):
        weight[at + c] *= 0.25 * share


@njit(**INNER)
def spread_out(p, face, near, q, listed, corner, spread, radius, room, n, nodes, weight):  # type: ignore[no-untyped-def]
    """Write nodes and weights of the points across a particle that lies on a face.

    The points lie in the plane of its normal, in rows along the face's first side and across it;
    of edges only along it. Each has the nearest face of its own.

    Parameters
    ----------
    spread : two int
        Points along both directions.

    Returns
    -------
    bool
        Whether all points lie on faces; what was written is of no use otherwise.
    """
    tangent, side, point = np.empty(3), np.empty(3), np.empty(3)
    along, square, at = 0.0, 0.0, 0
    for d in range(3):
        tangent[d] = listed.x[face, 1, d] - listed.x[face, 0, d]
        along += tangent[d] * n[d]
    for d in range(3):
        tangent[d] -= along * n[d]
        square += tangent[d] * tangent[d]
    for d in range(3):
        tangent[d] /= math.sqrt(square)
    for d in range(3):
        a, b = (d + 1) % 3, (d + 2) % 3
        side[d] = n[a] * tangent[b] - n[b] * tangent[a]
    for i in range(spread[0]):
        for j in range(spread[1]):
            x, y = (2 * i + 1) / spread[0] - 1.0, (2 * j + 1) / spread[1] - 1.0
            for d in range(3):
                point[d] = p[d] + radius * (x * tangent[d] + y * side[d])
            f, xi, eta, _ = nearest_from(point, face, near, q, listed, math.inf, room)
            place_on(listed.x[f], xi, eta, room)
            above, away = 0.0, 0.0
            for d in range(3):
                above += (point[d] - room[0, d]) * n[d]
                away += (point[d] - room[0, d]) ** 2
            if away - above * above > (ON * radius) ** 2:
                return False
            share = 1.0 / (spread[0] * spread[1])
            write_shares(corner[near.listed[f]], xi, eta, share, nodes, weight, at)
            at += 4
    return True
