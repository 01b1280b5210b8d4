"""Gaps of one pair: spheres, planes, rounded boxes and edges; and vectors in arrays."""

import math

from numba import njit

from quintet.components.dem_bodies.state import Model, Numbers, State
from quintet.components.shared.numba_options import INNER
from quintet.components.shared.rotations import (
    Matrix,
    Quaternion,
    Vector,
    axpy,
    dot,
    sub,
    to_body,
    to_world,
)

Gap = tuple[float, Vector, Vector]  # gap m, normal from j to i, point half way m

FAR = 1e300  # m, of edges that do not cross


@njit(**INNER)
def vector(flat: Numbers, k: int) -> Vector:
    """Return three numbers from one on."""
    return flat[k], flat[k + 1], flat[k + 2]


@njit(**INNER)
def set_vector(flat: Numbers, k: int, a: Vector) -> None:
    """Write three numbers from one on."""
    flat[k], flat[k + 1], flat[k + 2] = a


@njit(**INNER)
def quaternion(flat: Numbers, k: int) -> Quaternion:
    """Return four numbers from one on."""
    return flat[k], flat[k + 1], flat[k + 2], flat[k + 3]


@njit(**INNER)
def set_quaternion(flat: Numbers, k: int, q: Quaternion) -> None:
    """Write four numbers from one on."""
    flat[k], flat[k + 1], flat[k + 2], flat[k + 3] = q


@njit(**INNER)
def row_vector(rows: Numbers, i: int, first: int = 0) -> Vector:
    """Return three numbers of a row."""
    return rows[i, first], rows[i, first + 1], rows[i, first + 2]


@njit(**INNER)
def set_row_vector(rows: Numbers, i: int, first: int, a: Vector) -> None:
    """Write three numbers of a row."""
    rows[i, first], rows[i, first + 1], rows[i, first + 2] = a


@njit(**INNER)
def rotation_matrix(axes: Numbers, i: int) -> Matrix:
    """Return the rotation matrix in a row."""
    return (
        axes[i, 0], axes[i, 1], axes[i, 2],
        axes[i, 3], axes[i, 4], axes[i, 5],
        axes[i, 6], axes[i, 7], axes[i, 8],
    )  # fmt: skip


@njit(**INNER)
def clamped(x: float, limit: float) -> float:
    """Return x within ±limit."""
    return min(max(x, -limit), limit)


@njit(**INNER)
def nearest_on_lines(p: Vector, u: Vector, q: Vector, v: Vector) -> tuple[float, float]:
    """Where the lines p + s u and q + t v are nearest; (-1, -1) unless inside both segments.

    Segments within 1/1000 rad of parallel do not cross: their ends make the contact.

    References
    ----------
    Ericson, Real-Time Collision Detection (2005), section 5.1.9.
    """
    r = sub(p, q)
    uu, vv, uv, ur, vr = dot(u, u), dot(v, v), dot(u, v), dot(u, r), dot(v, r)
    area = uu * vv - uv * uv
    if area <= 1e-6 * uu * vv:
        return -1.0, -1.0
    s = (uv * vr - ur * vv) / area
    t = (uu * vr - uv * ur) / area
    if s <= 0.0 or s >= 1.0 or t <= 0.0 or t >= 1.0:
        return -1.0, -1.0
    return s, t


@njit(**INNER)
def segment_distance(p: Vector, u: Vector, q: Vector, v: Vector) -> float:
    """Distance [m] of the segments p + s u and q + t v, 0 ≤ s, t ≤ 1 (Ericson, as above)."""
    r = sub(p, q)
    uu, vv, uv, ur, vr = dot(u, u), dot(v, v), dot(u, v), dot(u, r), dot(v, r)
    area = uu * vv - uv * uv
    s = min(max((uv * vr - ur * vv) / area, 0.0), 1.0) if area > 1e-12 * uu * vv else 0.0
    t = min(max((uv * s + vr) / vv, 0.0), 1.0)
    s = min(max((uv * t - ur) / uu, 0.0), 1.0)
    d = axpy(-t, v, axpy(s, u, r))
    return math.sqrt(dot(d, d))


@njit(**INNER)
def sphere_plane(centre: Vector, radius: float, normal: Vector, offset: float) -> Gap:
    """Sphere above a plane."""
    gap = dot(normal, centre) - offset - radius
    return gap, normal, axpy(-radius - 0.5 * gap, normal, centre)


@njit(**INNER)
def sphere_sphere(a: Vector, b: Vector, radius_a: float, radius_b: float) -> Gap:
    """Two spheres about the points a and b."""
    d = sub(a, b)
    distance = math.sqrt(dot(d, d))
    n = (d[0] / distance, d[1] / distance, d[2] / distance) if distance > 0.0 else (0.0, 0.0, 1.0)
    gap = distance - radius_a - radius_b
    return gap, n, axpy(-radius_a - 0.5 * gap, n, a)


@njit(**INNER)
def sphere_box(
    centre: Vector, radius: float, middle: Vector, r: Matrix, half: Vector, edge_radius: float
) -> Gap:
    """Sphere and a rounded box: a sphere of `edge_radius` swept through the box of `half`."""
    d = sub(centre, middle)
    x, y, z = to_body(r, d[0], d[1], d[2])
    x, y, z = clamped(x, half[0]), clamped(y, half[1]), clamped(z, half[2])
    return sphere_sphere(centre, axpy(1.0, to_world(r, x, y, z), middle), radius, edge_radius)


@njit(**INNER)
def nearest_in_polygon(
    corner: Numbers, first: int, last: int, x: float, z: float
) -> tuple[float, float]:
    """Point (x, z) m of a convex polygon that is nearest to one; corners are rows [first, last)."""
    inside, nearest2, px, pz = True, FAR, x, z
    for k in range(first, last):
        to = k + 1 if k + 1 < last else first
        ax, az = corner[k, 0], corner[k, 2]
        ux, uz = corner[to, 0] - ax, corner[to, 2] - az
        dx, dz = x - ax, z - az
        inside = inside and ux * dz - uz * dx >= 0.0
        share = min(max((ux * dx + uz * dz) / (ux * ux + uz * uz), 0.0), 1.0)
        dx, dz = dx - share * ux, dz - share * uz
        if dx * dx + dz * dz < nearest2:
            nearest2, px, pz = dx * dx + dz * dz, ax + share * ux, az + share * uz
    return (x, z) if inside else (px, pz)


@njit(**INNER)
def sphere_body(model: Model, state: State, s: int, j: int) -> Gap:
    """Sphere s and body j, a rounded box; or a polygon in two dimensions, whose corners are round.

    A polygon is what a circle of the edge radius sweeps that moves through its inner corners.
    """
    centre, radius, rounded = (
        row_vector(state.centre, s),
        model.sphere_radius[s],
        model.edge_radius[j],
    )
    middle, r = row_vector(state.motion, j), rotation_matrix(state.axes, j)
    if not model.polygon[j]:
        return sphere_box(centre, radius, middle, r, row_vector(model.half_extent, j), rounded)
    d = sub(centre, middle)
    x, y, z = to_body(r, d[0], d[1], d[2])
    first, last = model.sphere_begin[j], model.sphere_begin[j + 1]
    x, z = nearest_in_polygon(model.sphere_centre, first, last, x, z)
    return sphere_sphere(centre, axpy(1.0, to_world(r, x, y, z), middle), radius, rounded)


@njit(**INNER)
def edge_edge(p: Vector, u: Vector, q: Vector, v: Vector, radius_p: float, radius_q: float) -> Gap:
    """Rounded edges p + s u and q + t v where they cross inside both."""
    s, t = nearest_on_lines(p, u, q, v)
    if s < 0.0:
        return FAR, p, p
    return sphere_sphere(axpy(s, u, p), axpy(t, v, q), radius_p, radius_q)
