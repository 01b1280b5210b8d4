"""Contacts that are deeper than edges are round: of which face, or of which two edges, they are.

Hertz's law needs a radius of curvature. That of a sharp edge would let it sink in without bound;
a real one yields until it is blunt. So a sharp or thin body has contacts of the `contact_radius`
of a blunt and less slender one, and they may be many times deeper than its `edge_radius`: a corner
may then be within the inner box of the other, and edges may have passed each other, where the
distance of their axes says neither how deep they are nor in which direction. That is then the
direction in which the two bodies overlap least (Gottschalk, Lin & Manocha, SIGGRAPH 1996, 171:
separating axes), which for all others is that of the distance.
"""

import math
from typing import NamedTuple

from numba import njit

from quintet.components.dem_bodies.kernels.geometry import (
    FAR,
    Gap,
    nearest_on_lines,
    rotation_matrix,
    row_vector,
)
from quintet.components.dem_bodies.state import Numbers
from quintet.components.shared.numba_options import INNER
from quintet.components.shared.rotations import (
    Matrix,
    Vector,
    axpy,
    cross,
    dot,
    scaled,
    sub,
    to_body,
    to_world,
)

SUNK = 0.5  # of the radii of two edges: contacts that are deeper are judged here
FLAT = 1e-2  # rad by which faces may be out of parallel that still bear as a whole
EQUAL = 1.0 + 1e-3  # overlaps that differ by no more are the same


class Box(NamedTuple):
    """A rounded box in numbers: arrays that are handed on cost more than all that is done here."""

    middle: Vector  # m
    axes: Matrix
    half: Vector  # m, half edges of the inner box
    edge_radius: float  # m; 0 for a body that is no box


class Edge(NamedTuple):
    """A rounded edge of a box: its inner ends in the world, and one of them in body axes."""

    start: Vector  # m
    along: Vector  # m
    start_of_body: Vector  # m
    end_of_body: Vector  # m


@njit(**INNER)
def box_of(motion: Numbers, axes: Numbers, half: Numbers, edge_radius: Numbers, i: int) -> Box:
    """Box i."""
    where = row_vector(motion, i)
    return Box(where, rotation_matrix(axes, i), row_vector(half, i), edge_radius[i])


@njit(**INNER)
def edge_of(centre: Numbers, local: Numbers, first: int, last: int) -> Edge:
    """Edge between two corner spheres."""
    start = row_vector(centre, first)
    along = sub(row_vector(centre, last), start)
    return Edge(start, along, row_vector(local, first), row_vector(local, last))


@njit(**INNER)
def extent(box: Box, n: Vector) -> float:
    """Half the extent [m] of a box along a unit vector."""
    x, y, z = to_body(box.axes, n[0], n[1], n[2])
    a, b, c = box.half
    return a * abs(x) + b * abs(y) + c * abs(z) + box.edge_radius


@njit(**INNER)
def face_normals(box: Box) -> tuple[Vector, Vector, Vector]:
    """Axes of a box in the world."""
    r = box.axes
    return (r[0], r[3], r[6]), (r[1], r[4], r[7]), (r[2], r[5], r[8])


@njit(**INNER)
def sunk_corner(centre: Vector, radius: float, mine: Box, other: Box) -> Gap:
    """Sphere that is sunk in another box, and the face through which it came.

    `mine` is the box of which it is a corner; it has no edge radius if the sphere is of none.
    """
    local, is_box = sub(centre, other.middle), mine.edge_radius > 0.0
    away = sub(mine.middle, other.middle) if is_box else local
    least, normal, level = FAR, away, 0.0
    normals = face_normals(other)
    for k in range(3):
        n, face = normals[k], other.half[k] + other.edge_radius
        apart = dot(away, n)
        overlap = face + (extent(mine, n) if is_box else radius) - abs(apart)
        if overlap < least:
            least, level = overlap, face
            normal = scaled(1.0 if apart >= 0.0 else -1.0, n)
    gap = dot(local, normal) - level - radius
    return gap, normal, axpy(-radius - 0.5 * gap, normal, centre)


@njit(**INNER)
def sunk_in_polygon(
    centres: Numbers, radii: Numbers, corner: Numbers, s: int, mine: tuple[int, int],
    others: tuple[int, int], other: Box,
) -> Gap:  # fmt: skip
    """Sphere s that is sunk in a polygon, and the edge through which it came.

    Its body has the spheres `mine` and the polygon the inner corners `others`, first and one past
    the last.
    """
    furthest, centre, gap = -FAR, row_vector(centres, s), 0.0
    normal = centre
    for k in range(others[0], others[1]):
        to = k + 1 if k + 1 < others[1] else others[0]
        ux, uz = corner[to, 0] - corner[k, 0], corner[to, 2] - corner[k, 2]
        length = math.sqrt(ux * ux + uz * uz)
        n = to_world(other.axes, uz / length, 0.0, -ux / length)
        a = to_world(other.axes, corner[k, 0], corner[k, 1], corner[k, 2])
        a, nearest = axpy(1.0, a, other.middle), FAR
        for p in range(mine[0], mine[1]):
            nearest = min(nearest, dot(sub(row_vector(centres, p), a), n) - radii[p])
        if nearest > furthest:
            furthest, normal = nearest, n
            gap = dot(sub(centre, a), n) - radii[s] - other.edge_radius
    return gap, normal, axpy(-radii[s] - 0.5 * gap, normal, centre)


@njit(**INNER)
def least_overlap(one: Box, other: Box) -> float:
    """Least overlap [m] of two boxes along the normals of their faces."""
    d, least = sub(one.middle, other.middle), FAR
    for n in face_normals(one) + face_normals(other):
        least = min(least, extent(one, n) + extent(other, n) - abs(dot(d, n)))
    return least


@njit(**INNER)
def bears(box: Box, edge: Edge, n: Vector) -> bool:
    """Whether a direction lies between the normals of the two faces at an edge of a box."""
    v = to_body(box.axes, n[0], n[1], n[2])
    for k in range(3):
        a = edge.start_of_body[k]
        if a * edge.end_of_body[k] > 0.0 and (v[k] if a > 0.0 else -v[k]) < -FLAT:
            return False
    return True


@njit(**INNER)
def sunk_edges(mine: Edge, one: Box, others: Edge, other: Box, found: Gap) -> Gap:
    """Crossing edges of two boxes: as they were found, or how deep they have passed each other."""
    n = cross(mine.along, others.along)
    n = scaled(1.0 / math.sqrt(dot(n, n)), n)
    back = scaled(-1.0, n)
    if not (bears(other, others, n) and bears(one, mine, back)):
        n, back = back, n
        if not (bears(other, others, n) and bears(one, mine, back)):
            return found
    s, t = nearest_on_lines(mine.start, mine.along, others.start, others.along)
    p = axpy(s, mine.along, mine.start)
    apart = dot(sub(p, axpy(t, others.along, others.start)), n)
    gap = apart - one.edge_radius - other.edge_radius
    if apart >= 0.0 or -gap > EQUAL * least_overlap(one, other):
        return found
    return gap, n, axpy(-one.edge_radius - 0.5 * gap, n, p)
