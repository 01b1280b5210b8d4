"""Rotations in space: unit quaternions (w, x, y, z) that turn body axes into world axes.

Quaternions are advanced by the exponential map: a body that turns by the vector θ = ω dt has
afterwards q ← exp(θ/2) ∘ q, with exp(θ/2) = [cos(|θ|/2), (θ/|θ|) sin(|θ|/2)].
"""

import math

from numba import njit

from quintet.components.shared.numba_options import INNER

Quaternion = tuple[float, float, float, float]
Vector = tuple[float, float, float]
Matrix = tuple[float, float, float, float, float, float, float, float, float]  # by rows


@njit(**INNER)
def product(p: Quaternion, q: Quaternion) -> Quaternion:
    """Return p ∘ q: first q, then p."""
    a, b, c, d = p
    e, f, g, h = q
    return (
        a * e - b * f - c * g - d * h,
        a * f + b * e + c * h - d * g,
        a * g - b * h + c * e + d * f,
        a * h + b * g - c * f + d * e,
    )


@njit(**INNER)
def exponential(x: float, y: float, z: float) -> Quaternion:
    """Quaternion of the turn by a rotation vector [rad], in world axes."""
    square = x * x + y * y + z * z
    if square < 1e-6:  # the next term of either series is below the rounding of doubles
        scale = 0.5 - square / 48.0 + square * square / 3840.0
        return 1.0 - square / 8.0 + square * square / 384.0, scale * x, scale * y, scale * z
    angle = math.sqrt(square)
    scale = math.sin(0.5 * angle) / angle
    return math.cos(0.5 * angle), scale * x, scale * y, scale * z


@njit(**INNER)
def rotated(q: Quaternion, x: float, y: float, z: float) -> Quaternion:
    """Orientation q after turning by a rotation vector [rad], in world axes.

    One step of Newton's method keeps the length at one: q is off by rounding only.
    """
    a, b, c, d = product(exponential(x, y, z), q)
    scale = 1.5 - 0.5 * (a * a + b * b + c * c + d * d)
    return scale * a, scale * b, scale * c, scale * d


@njit(**INNER)
def matrix(q: Quaternion) -> Matrix:
    """Rotation matrix, row by row, of a unit quaternion: body -> world."""
    w, x, y, z = q
    return (
        1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y),
        2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x),
        2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y),
    )  # fmt: skip


@njit(**INNER)
def to_world(r: Matrix, x: float, y: float, z: float) -> Vector:
    """Return R v: body -> world."""
    return (
        r[0] * x + r[1] * y + r[2] * z,
        r[3] * x + r[4] * y + r[5] * z,
        r[6] * x + r[7] * y + r[8] * z,
    )


@njit(**INNER)
def to_body(r: Matrix, x: float, y: float, z: float) -> Vector:
    """Return Rᵀ v: world -> body."""
    return (
        r[0] * x + r[3] * y + r[6] * z,
        r[1] * x + r[4] * y + r[7] * z,
        r[2] * x + r[5] * y + r[8] * z,
    )


@njit(**INNER)
def cross(a: Vector, b: Vector) -> Vector:
    """Return a × b."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


@njit(**INNER)
def dot(a: Vector, b: Vector) -> float:
    """Return a · b."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@njit(**INNER)
def sub(a: Vector, b: Vector) -> Vector:
    """Return a - b."""
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


@njit(**INNER)
def axpy(α: float, x: Vector, y: Vector) -> Vector:
    """Return α x + y."""
    return α * x[0] + y[0], α * x[1] + y[1], α * x[2] + y[2]


@njit(**INNER)
def scaled(α: float, x: Vector) -> Vector:
    """Return α x."""
    return α * x[0], α * x[1], α * x[2]
