"""Rotations of many items at once: unit quaternions (n, 4) w, x, y, z, body to world.

Rotation vectors (n, 3) [rad] are in world axes. Formulas after Solà, "Quaternion kinematics for
the error-state Kalman filter" (2017), arXiv:1711.02508; equation numbers are his.
"""

import numpy as np

from quintet.interfaces.component import Array

TURN = 2.0 * np.pi
SMALL = 1e-4  # rad; below it the series of the inverse Jacobian is exact to rounding


def product(a: Array, b: Array) -> Array:
    """Quaternion (n, 4) of the rotation `b` followed by the rotation `a`; equation 12."""
    aw, av, bw, bv = a[:, :1], a[:, 1:], b[:, :1], b[:, 1:]
    scalar = aw * bw - (av * bv).sum(axis=1, keepdims=True)
    return np.concatenate([scalar, aw * bv + bw * av + np.cross(av, bv)], axis=1)


def conjugate(quaternion: Array) -> Array:
    """Quaternion (n, 4) of the rotation back; equation 17."""
    return quaternion * np.array([1.0, -1.0, -1.0, -1.0])


def exponential(vector: Array) -> Array:
    """Quaternion (n, 4) of a rotation vector (n, 3); equation 101."""
    angle = np.sqrt((vector * vector).sum(axis=1, keepdims=True))
    # numpy's sinc(x) is sin(πx) / (πx)
    return np.concatenate([np.cos(0.5 * angle), 0.5 * np.sinc(angle / TURN) * vector], axis=1)


def logarithm(quaternion: Array, near: Array) -> Array:
    """Rotation vector (n, 3) of a quaternion (n, 4), of all its turns that nearest to `near`.

    Equation 105, and as many whole turns more as bring it nearest to `near` (n, 3).
    """
    w, v = quaternion[:, :1], quaternion[:, 1:]
    v = np.where(w < 0.0, -v, v)
    sine = np.sqrt((v * v).sum(axis=1, keepdims=True))
    angle = 2.0 * np.arctan2(sine, np.abs(w))
    far = np.sqrt((near * near).sum(axis=1, keepdims=True))
    direction = near / np.where(far > 0.0, far, 1.0)
    axis = np.where(sine > 0.0, v / np.where(sine > 0.0, sine, 1.0), direction)
    turns = np.rint(((near * axis).sum(axis=1, keepdims=True) - angle) / TURN)
    return np.asarray((angle + TURN * turns) * axis)


def matrix(quaternion: Array) -> Array:
    """Rotation matrices (n, 3, 3) of unit quaternions (n, 4); equation 115."""
    w, x, y, z = quaternion.T
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    return np.moveaxis(np.array(rows), 2, 0)


def turned(quaternion: Array, angular_velocity: Array, time: float) -> Array:
    """Quaternion (n, 4) after turning steadily for a time [s] at (n, 3) rad/s."""
    return product(exponential(time * angular_velocity), quaternion)


def vector_between(start: Array, end: Array, near: Array) -> Array:
    """Rotation vector (n, 3) that leads from one quaternion to another, nearest to `near`."""
    return logarithm(product(end, conjugate(start)), near)


def rate_of_vector(vector: Array, angular_velocity: Array) -> Array:
    """Time derivative (n, 3) of a rotation vector at an angular velocity: equation 146.

    Beyond half a turn, where the formula nears its pole at a whole one, the angular velocity.
    """
    square = (vector * vector).sum(axis=1, keepdims=True)
    angle = np.sqrt(square)
    safe = np.where((angle > SMALL) & (angle < np.pi), angle, 1.0)
    factor = 1.0 / safe**2 - 1.0 / (2.0 * safe * np.tan(0.5 * safe))
    factor = np.where(angle > SMALL, factor, 1.0 / 12.0)
    across = np.cross(vector, angular_velocity)
    bent = angular_velocity - 0.5 * across + factor * np.cross(vector, across)
    return np.where(angle < np.pi, bent, angular_velocity)
