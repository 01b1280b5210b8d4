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
    """A rounded box in numbers: to pass arrays costs more than all that is done here."""

    middle: Vector  # m
    axes: Matrix
    half: Vector  # m, half edges of the inner box
    edge_radius: float  # m; 0 for a body that is no box


class Edge(NamedTuple):
    """A rounded edge of a box: its inner ends in the world, and both in body axes."""

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
def corner_penetration(centre: Vector, radius: float, mine: Box, other: Box) -> Gap:
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
def polygon_penetration(
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
def least_overlap(box_i: Box, box_j: Box) -> float:
    """Least overlap [m] of two boxes along the normals of their faces."""
    d, least = sub(box_i.middle, box_j.middle), FAR
    for n in face_normals(box_i) + face_normals(box_j):
        least = min(least, extent(box_i, n) + extent(box_j, n) - abs(dot(d, n)))
    return least


@njit(**INNER)
def supports(box: Box, edge: Edge, n: Vector) -> bool:
    """Whether a direction lies between the normals of the two faces at an edge of a box."""
    v = to_body(box.axes, n[0], n[1], n[2])
    for k in range(3):
        a = edge.start_of_body[k]
        if a * edge.end_of_body[k] > 0.0 and (v[k] if a > 0.0 else -v[k]) < -FLAT:
            return False
    return True


@njit(**INNER)
def edge_penetration(edge_i: Edge, box_i: Box, edge_j: Edge, box_j: Box, gap: Gap) -> Gap:
    """Gap of two boxes' crossing edges, or how deep they have passed each other."""
    n = cross(edge_i.along, edge_j.along)
    n = scaled(1.0 / math.sqrt(dot(n, n)), n)
    back = scaled(-1.0, n)
    if not (supports(box_j, edge_j, n) and supports(box_i, edge_i, back)):
        n, back = back, n
        if not (supports(box_j, edge_j, n) and supports(box_i, edge_i, back)):
            return gap
    s, t = nearest_on_lines(edge_i.start, edge_i.along, edge_j.start, edge_j.along)
    p = axpy(s, edge_i.along, edge_i.start)
    apart = dot(sub(p, axpy(t, edge_j.along, edge_j.start)), n)
    depth = apart - box_i.edge_radius - box_j.edge_radius
    if apart >= 0.0 or -depth > EQUAL * least_overlap(box_i, box_j):
        return gap
    return depth, n, axpy(-box_i.edge_radius - 0.5 * depth, n, p)
