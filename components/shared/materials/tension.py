"""Tension: what of a stress pulls."""

import math

from numba import njit

from quintet.components.shared.numba_options import INNER

SWEEPS = 8  # of Jacobi's rotations: it converges quadratically


@njit(**INNER)
def rotation(pp, qq, pq, rp, rq):  # type: ignore[no-untyped-def]
    """Jacobi's rotation of a symmetric matrix, after which its entry pq is 0.

    Returns
    -------
    four floats : the entries pp, qq, rp and rq afterwards
    two floats : cosine and sine of the angle
    """
    if pq == 0.0:
        return pp, qq, rp, rq, 1.0, 0.0
    half = 0.5 * (qq - pp) / pq
    t = math.copysign(1.0, half) / (abs(half) + math.sqrt(half * half + 1.0))
    c = 1.0 / math.sqrt(t * t + 1.0)
    s = t * c
    new_pp = c * (c * pp - s * pq) - s * (c * pq - s * qq)
    new_qq = s * (s * pp + c * pq) + c * (s * pq + c * qq)
    return new_pp, new_qq, c * rp - s * rq, s * rp + c * rq, c, s


@njit(**INNER)
def rotated_pair(u, v, c, s):  # type: ignore[no-untyped-def]
    """Two vectors, rotated in their plane by an angle of a cosine and sine."""
    x, y, z = u
    p, q, r = v
    return (c * x - s * p, c * y - s * q, c * z - s * r), (
        s * x + c * p, s * y + c * q, s * z + c * r,
    )  # fmt: skip


@njit(**INNER)
def positive_part(tensor):  # type: ignore[no-untyped-def]
    """Σ max(λ, 0) n nᵀ of the eigenvalues and eigenvectors of a tensor, by Jacobi's rotations.

    Both are six numbers, xx yy zz xy yz zx.
    """
    xx, yy, zz, xy, yz, zx = tensor
    a, b, c = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)
    for _ in range(SWEEPS):
        xx, yy, zx, yz, cosine, sine = rotation(xx, yy, xy, zx, yz)
        a, b = rotated_pair(a, b, cosine, sine)
        xx, zz, xy, yz, cosine, sine = rotation(xx, zz, zx, 0.0, yz)
        a, c = rotated_pair(a, c, cosine, sine)
        yy, zz, xy, zx, cosine, sine = rotation(yy, zz, yz, xy, 0.0)
        b, c = rotated_pair(b, c, cosine, sine)
        yz = 0.0
    p, q, r = max(xx, 0.0), max(yy, 0.0), max(zz, 0.0)
    return (
        p * a[0] * a[0] + q * b[0] * b[0] + r * c[0] * c[0],
        p * a[1] * a[1] + q * b[1] * b[1] + r * c[1] * c[1],
        p * a[2] * a[2] + q * b[2] * b[2] + r * c[2] * c[2],
        p * a[1] * a[0] + q * b[1] * b[0] + r * c[1] * c[0],
        p * a[2] * a[1] + q * b[2] * b[1] + r * c[2] * c[1],
        p * a[2] * a[0] + q * b[2] * b[0] + r * c[2] * c[0],
    )
