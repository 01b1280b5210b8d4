"""Tension: what of a stress pulls."""

import math

import numpy as np
from numba import njit

from quintet.components.shared.numba_options import INNER

SWEEPS = 8  # of Jacobi's rotations: it converges quadratically
PLACES = ((0, 3, 5), (3, 1, 4), (5, 4, 2))  # of the six numbers in a matrix


@njit(**INNER)
def positive_part(tensor, part):  # type: ignore[no-untyped-def]
    """Write the tensor Σ max(λ, 0) n nᵀ of the eigenvalues and eigenvectors of another.

    By Jacobi's rotations. Both are six numbers, xx yy zz xy yz zx; `part` is an array.
    """
    a, e = np.empty((3, 3)), np.eye(3)
    for i in range(3):
        for j in range(3):
            a[i, j] = tensor[PLACES[i][j]]
    for _ in range(SWEEPS):
        for p, q in ((0, 1), (1, 2), (0, 2)):
            if a[p, q] == 0.0:
                continue
            half = 0.5 * (a[q, q] - a[p, p]) / a[p, q]
            t = math.copysign(1.0, half) / (abs(half) + math.sqrt(half * half + 1.0))
            c = 1.0 / math.sqrt(t * t + 1.0)
            s = t * c
            for k in range(3):
                a[k, p], a[k, q] = c * a[k, p] - s * a[k, q], s * a[k, p] + c * a[k, q]
                e[k, p], e[k, q] = c * e[k, p] - s * e[k, q], s * e[k, p] + c * e[k, q]
            for k in range(3):
                a[p, k], a[q, k] = c * a[p, k] - s * a[q, k], s * a[p, k] + c * a[q, k]
            a[p, q], a[q, p] = 0.0, 0.0
    for d in range(6):
        part[d] = 0.0
    for k in range(3):
        pull = max(a[k, k], 0.0)
        for i in range(3):
            for j in range(i + 1):
                part[PLACES[i][j]] += pull * e[i, k] * e[j, k]
