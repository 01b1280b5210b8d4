"""Contact of one pair: Hertz's normal force with damping, Mindlin's tangential force with friction.

Normal    F_n = 4/3 E* √R* δ^{3/2} + 2√(5/6) ζ √(S_n m*) δ̇ ≥ 0,   S_n = 2 E* √(R* δ)
Tangential  dF_t = -S_t v_t dt,  S_t = 8 G* √(R* δ), damped by 2√(5/6) ζ √(S_t m*) v_t, |F_t| ≤ μ F_n
"""

import math

from numba import njit

from quintet.components.shared.rotations import PURE, Vector, dot

DAMPING = 2.0 * math.sqrt(5.0 / 6.0)


@njit(**PURE)
def normal_force(
    modulus: float, root: float, depth: float, ζ: float, mass: float, closing: float
) -> tuple[float, float]:
    """Force [N], never a pull, and its elastic part; root = √(R* δ)."""
    elastic = 4.0 / 3.0 * modulus * root * depth
    damped = DAMPING * ζ * math.sqrt(2.0 * modulus * root * mass) * closing
    return max(0.0, elastic + damped), elastic


@njit(**PURE)
def carried(force: Vector, normal: Vector, scale: float) -> Vector:
    """Elastic tangential force after the contact plane has turned, times a scale."""
    along = dot(force, normal)
    x, y, z = (
        force[0] - along * normal[0],
        force[1] - along * normal[1],
        force[2] - along * normal[2],
    )
    before, after = dot(force, force), x * x + y * y + z * z
    if after > 0.0:
        scale *= math.sqrt(before / after)
    return scale * x, scale * y, scale * z


@njit(**PURE)
def friction(
    elastic: Vector, slip: Vector, damping: float, limit: float
) -> tuple[Vector, Vector]:
    """Tangential force [N] and its elastic part, within Coulomb's limit; slip velocity in m/s."""
    x = elastic[0] - damping * slip[0]
    y = elastic[1] - damping * slip[1]
    z = elastic[2] - damping * slip[2]
    size = math.sqrt(x * x + y * y + z * z)
    if size <= limit:
        return (x, y, z), elastic
    scale = limit / size
    sliding = scale * x, scale * y, scale * z
    return sliding, sliding


@njit(**PURE)
def clamped(x: float, limit: float) -> float:
    """Return x within ±limit."""
    return min(max(x, -limit), limit)


@njit(**PURE)
def crossing(p: Vector, u: Vector, q: Vector, v: Vector) -> tuple[float, float]:
    """Where the lines p + s u and q + t v are nearest; (-1, -1) unless inside both segments.

    Segments within 1/1000 rad of parallel have no crossing: their ends make the contact.
    Ericson, Real-Time Collision Detection (2005), section 5.1.9.
    """
    r = p[0] - q[0], p[1] - q[1], p[2] - q[2]
    uu, vv, uv, ur, vr = dot(u, u), dot(v, v), dot(u, v), dot(u, r), dot(v, r)
    area = uu * vv - uv * uv
    if area <= 1e-6 * uu * vv:
        return -1.0, -1.0
    s = (uv * vr - ur * vv) / area
    t = (uu * vr - uv * ur) / area
    if s <= 0.0 or s >= 1.0 or t <= 0.0 or t >= 1.0:
        return -1.0, -1.0
    return s, t


@njit(**PURE)
def segment_distance(p: Vector, u: Vector, q: Vector, v: Vector) -> float:
    """Distance [m] of the segments p + s u and q + t v, 0 ≤ s, t ≤ 1 (Ericson, as above)."""
    r = p[0] - q[0], p[1] - q[1], p[2] - q[2]
    uu, vv, uv, ur, vr = dot(u, u), dot(v, v), dot(u, v), dot(u, r), dot(v, r)
    area = uu * vv - uv * uv
    s = min(max((uv * vr - ur * vv) / area, 0.0), 1.0) if area > 1e-12 * uu * vv else 0.0
    t = min(max((uv * s + vr) / vv, 0.0), 1.0)
    s = min(max((uv * t - ur) / uu, 0.0), 1.0)
    x = r[0] + s * u[0] - t * v[0]
    y = r[1] + s * u[1] - t * v[1]
    z = r[2] + s * u[2] - t * v[2]
    return math.sqrt(x * x + y * y + z * z)
