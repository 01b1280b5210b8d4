"""Gaps of one pair: spheres, planes, rounded boxes and edges; and vectors in rows of arrays."""

import math

from numba import njit

from quintet.components.dem_bodies.state import Numbers
from quintet.components.shared.rotations import (
    INNER,
    Matrix,
    Vector,
    backward,
    beside,
    dot,
    forward,
    less,
)

Found = tuple[float, Vector, Vector]  # gap m, normal from j to i, point half way m

FAR = 1e300  # m, of edges that do not cross


@njit(**INNER)
def vector(rows: Numbers, k: int) -> Vector:
    """Return the first three numbers of a row."""
    return rows[k, 0], rows[k, 1], rows[k, 2]


@njit(**INNER)
def write(rows: Numbers, i: int, first: int, a: Vector) -> None:
    """Write three numbers of a row."""
    rows[i, first], rows[i, first + 1], rows[i, first + 2] = a


@njit(**INNER)
def add(rows: Numbers, i: int, a: Vector) -> None:
    """Add a vector to a row."""
    rows[i, 0] += a[0]
    rows[i, 1] += a[1]
    rows[i, 2] += a[2]


@njit(**INNER)
def three(rows: Numbers, k: int, first: int) -> Vector:
    """Return three numbers of a row."""
    return rows[k, first], rows[k, first + 1], rows[k, first + 2]


@njit(**INNER)
def scaled(scale: float, a: Vector) -> Vector:
    """Return scale a."""
    return scale * a[0], scale * a[1], scale * a[2]


@njit(**INNER)
def clamped(x: float, limit: float) -> float:
    """Return x within ±limit."""
    return min(max(x, -limit), limit)


@njit(**INNER)
def crossing(p: Vector, u: Vector, q: Vector, v: Vector) -> tuple[float, float]:
    """Where the lines p + s u and q + t v are nearest; (-1, -1) unless inside both segments.

    Segments within 1/1000 rad of parallel have no crossing: their ends make the contact.
    Ericson, Real-Time Collision Detection (2005), section 5.1.9.
    """
    r = less(p, q)
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
    r = less(p, q)
    uu, vv, uv, ur, vr = dot(u, u), dot(v, v), dot(u, v), dot(u, r), dot(v, r)
    area = uu * vv - uv * uv
    s = min(max((uv * vr - ur * vv) / area, 0.0), 1.0) if area > 1e-12 * uu * vv else 0.0
    t = min(max((uv * s + vr) / vv, 0.0), 1.0)
    s = min(max((uv * t - ur) / uu, 0.0), 1.0)
    d = beside(beside(r, s, u), -t, v)
    return math.sqrt(dot(d, d))


@njit(**INNER)
def axes_of(axes: Numbers, k: int) -> Matrix:
    """Return the rotation matrix in a row."""
    return (
        axes[k, 0], axes[k, 1], axes[k, 2],
        axes[k, 3], axes[k, 4], axes[k, 5],
        axes[k, 6], axes[k, 7], axes[k, 8],
    )  # fmt: skip


@njit(**INNER)
def on_plane(centre: Vector, radius: float, normal: Vector, offset: float) -> Found:
    """Sphere above a plane."""
    gap = dot(normal, centre) - offset - radius
    return gap, normal, beside(centre, -radius - 0.5 * gap, normal)


@njit(**INNER)
def facing(a: Vector, b: Vector, radius_a: float, radius_b: float) -> Found:
    """Two spheres about the points a and b."""
    d = less(a, b)
    distance = math.sqrt(dot(d, d))
    n = (d[0] / distance, d[1] / distance, d[2] / distance) if distance > 0.0 else (0.0, 0.0, 1.0)
    gap = distance - radius_a - radius_b
    return gap, n, beside(a, -radius_a - 0.5 * gap, n)


@njit(**INNER)
def on_box(
    centre: Vector, radius: float, middle: Vector, r: Matrix, half: Vector, rounding: float
) -> Found:
    """Sphere and a rounded box: a sphere of radius `rounding` swept through the box of `half`."""
    d = less(centre, middle)
    x, y, z = backward(r, d[0], d[1], d[2])
    x, y, z = clamped(x, half[0]), clamped(y, half[1]), clamped(z, half[2])
    return facing(centre, beside(middle, 1.0, forward(r, x, y, z)), radius, rounding)


@njit(**INNER)
def across(p: Vector, u: Vector, q: Vector, v: Vector, radius_p: float, radius_q: float) -> Found:
    """Rounded edges p + s u and q + t v where they cross inside both."""
    s, t = crossing(p, u, q, v)
    if s < 0.0:
        return FAR, p, p
    return facing(beside(p, s, u), beside(q, t, v), radius_p, radius_q)
