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
    foot_within,
    place_on,
)
from quintet.components.shared.numba_options import EXACT, LANEWISE

HALF_DEPTH = 0.5  # m along y, of edges in a plane
ON = 1e-3  # of a radius: a particle whose foot is so little beside a face counts as above it
SURE = 0.25  # of a difference of distances, both of which change by at most what bodies move
SETTLED = 1e-12  # change of ξ and η at which the search for a nearest point ends
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
    last: Whole  # (r,) which of the listed ones was the nearest; -1 at first
    recheck_slack: Array  # (r,) m, slack at which another one may be nearer
    # Written in every step.
    x: Array  # (u, 4, 3) m, corners of the listed faces
    lowest: Array  # (u, 3) m, of the boxes around them
    highest: Array  # (u, 3) m
    nodes: Whole  # (r, 4 or more) nodes that hold each particle
    weight: Array  # (r, 4 or more) 1, their shares, all 0 of a particle that is not near
    gap: Array  # (r,) m, ∞ where no face is near
    normal: Array  # (r, 3) 1, from the face to the particle


def no_faces(several: int) -> Near:
    """Nothing near."""
    none = np.zeros(0, np.int64)
    return near_of(none, np.zeros(1, np.int64), none, several)


def near_of(row: Whole, begin: Whole, face: Whole, several: int) -> Near:
    """Faces near particles, as `list_near` gives them, each particle held by several nodes."""
    listed, face = np.unique(face, return_inverse=True)
    rows, count = len(row), len(listed)
    return Near(
        row=row,
        begin=begin,
        face=face,
        listed=listed,
        last=np.full(rows, -1),
        recheck_slack=np.zeros(rows),
        x=np.empty((count, 4, 3)),
        lowest=np.empty((count, 3)),
        highest=np.empty((count, 3)),
        nodes=np.zeros((rows, several), np.int64),
        weight=np.zeros((rows, several)),
        gap=np.zeros(rows),
        normal=np.zeros((rows, 3)),
    )


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


@njit(**LANEWISE)
def place_listed(near, corner, position):  # type: ignore[no-untyped-def]
    """Write the corners of listed faces, of nodes at (k, 3) m, and the boxes around them."""
    x, lowest, highest = near.x, near.lowest, near.highest
    for f in range(near.listed.shape[0]):
        for c in range(4):
            node = corner[near.listed[f], c]
            for d in range(3):
                x[f, c, d] = position[node, d]
        for d in range(3):
            lowest[f, d] = min(min(x[f, 0, d], x[f, 1, d]), min(x[f, 2, d], x[f, 3, d]))
            highest[f, d] = max(max(x[f, 0, d], x[f, 1, d]), max(x[f, 2, d], x[f, 3, d]))


@njit(**LANEWISE)
def away_from(p, near, f):  # type: ignore[no-untyped-def]
    """Squared distance [m2] of a point from the box around a listed face."""
    away = 0.0
    for d in range(3):
        away += max(max(near.lowest[f, d] - p[d], p[d] - near.highest[f, d]), 0.0) ** 2
    return away


@njit(**LANEWISE)
def nearest(p, near, q, reach, slack, room):  # type: ignore[no-untyped-def]
    """Nearest of the faces of row q within a reach, -1 if there is none; ξ and η.

    That of the last step is tried first: it usually is the nearest, and the boxes of the others are
    further away. How much further is noted: until particles and faces may have approached each
    other by a quarter of it, the others are not looked at. `slack` is by how much they still may;
    `room` is left as `foot_within` leaves it.
    """
    face, least = near.last[q], math.inf
    if face >= 0 and slack > near.recheck_slack[q]:
        xi, eta, d2 = foot_within(p, near.x[face], SETTLED, room)
    else:
        if face < 0:
            for at in range(near.begin[q], near.begin[q + 1]):
                away = away_from(p, near, near.face[at])
                if away < least:
                    face, least = near.face[at], away
        face, xi, eta, d2 = nearest_from(p, face, near, q, room)
        near.last[q], least = face, math.inf
        for at in range(near.begin[q], near.begin[q + 1]):
            if near.face[at] != face:
                least = min(least, away_from(p, near, near.face[at]))
        near.recheck_slack[q] = slack - SURE * (math.sqrt(least) - math.sqrt(d2))
        place_on(near.x[face], xi, eta, room)
    if d2 >= reach * reach:
        face = -1
    return face, xi, eta


@njit(**LANEWISE)
def nearest_from(p, first, near, q, room):  # type: ignore[no-untyped-def]
    """Nearest of the faces of row q, of which one is tried first; ξ, η and the squared distance.

    Of equally near faces the first one counts, whichever was tried first.
    """
    face = first
    xi, eta, best = foot_within(p, near.x[face], SETTLED, room)
    for at in range(near.begin[q], near.begin[q + 1]):
        f = near.face[at]
        if f != first and away_from(p, near, f) <= TIED * best:
            a, b, d2 = foot_within(p, near.x[f], SETTLED, room)
            if d2 < best or (d2 == best and f < face):
                best, face, xi, eta = d2, f, a, b
    return face, xi, eta, best


@njit(**LANEWISE)
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


@njit(**LANEWISE)
def gap_of(p, x, radius, off, room, n):  # type: ignore[no-untyped-def]
    """Gap [m] between a particle and a face, ∞ where they cannot touch; direction into `n` (3,).

    They touch at a distance `off` [m] of the particle's place from the face. `room` has the nearest
    point and the tangents there, as `foot_within` leaves them.
    Above the face the direction is that from its nearest point; a particle whose centre is below
    the face is pushed along the normal, if it is by a radius at most.
    """
    normal_at(x, room, n)
    above, square = 0.0, 0.0
    for d in range(3):
        above += (p[d] - room[0, d]) * n[d]
        square += (p[d] - room[0, d]) ** 2
    if above > 0.0:
        distance = math.sqrt(square)
        for d in range(3):
            n[d] = (p[d] - room[0, d]) / distance
        gap = distance - off
    else:
        beside = math.sqrt(max(square - above * above, 0.0))
        gap = above - off if beside <= ON * radius else math.inf
    return gap
