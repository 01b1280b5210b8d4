"""Laws of one element and one face: trilinear shape functions and their gradients."""

import math

import numpy as np
from numba import njit

from quintet.components.fe_plate.meshes.arrays import Array
from quintet.components.shared.numba_options import INNER

GAUSS = 1.0 / math.sqrt(3.0)
# Natural coordinates of the corners of an element.
XI = np.array([-1.0, 1.0, 1.0, -1.0, -1.0, 1.0, 1.0, -1.0])
ETA = np.array([-1.0, -1.0, 1.0, 1.0, -1.0, -1.0, 1.0, 1.0])
ZETA = np.array([-1.0, -1.0, -1.0, -1.0, 1.0, 1.0, 1.0, 1.0])


@njit(**INNER)
def shapes_at(xi, eta, zeta, x, shape, natural, gradient):  # type: ignore[no-untyped-def]
    """Write shape functions and their gradients at a point of an element; return its Jacobian.

    Parameters
    ----------
    xi, eta, zeta : float, 1
        Natural coordinates of the point.
    x : (8, 3) float array, m
        Corners.
    shape : (8,) float array, 1
        Written.
    natural : (8, 3) float array, 1
        Written: derivatives by natural coordinates.
    gradient : (8, 3) float array, 1/m
        Written.

    Returns
    -------
    float, m3
        Determinant of dx/dξ; the gradients have a meaning if it is above 0.

    References
    ----------
    Hughes, The Finite Element Method (1987), section 3.5.
    """
    for a in range(8):
        p, q, r = 1.0 + XI[a] * xi, 1.0 + ETA[a] * eta, 1.0 + ZETA[a] * zeta
        shape[a] = 0.125 * p * q * r
        natural[a, 0] = 0.125 * XI[a] * q * r
        natural[a, 1] = 0.125 * ETA[a] * p * r
        natural[a, 2] = 0.125 * ZETA[a] * p * q
    j = np.zeros((3, 3))  # dx_k / dξ_l
    for a in range(8):
        for k in range(3):
            for m in range(3):
                j[k, m] += x[a, k] * natural[a, m]
    c = np.empty((3, 3))  # its cofactors
    for k in range(3):
        p, q = (k + 1) % 3, (k + 2) % 3
        for m in range(3):
            r, s = (m + 1) % 3, (m + 2) % 3
            c[k, m] = j[p, r] * j[q, s] - j[p, s] * j[q, r]
    determinant = j[0, 0] * c[0, 0] + j[0, 1] * c[0, 1] + j[0, 2] * c[0, 2]
    for a in range(8):
        for k in range(3):
            rate = natural[a, 0] * c[k, 0] + natural[a, 1] * c[k, 1] + natural[a, 2] * c[k, 2]
            gradient[a, k] = rate / determinant
    return determinant


def face_shares(corners: Array) -> Array:
    """Area (f, 4) m2 for which each corner of bilinear faces (f, 4, 3) m stands: ∫ N dA.

    References
    ----------
    Hughes, The Finite Element Method (1987), section 3.8 (Gauss's 2 x 2 points).
    """
    xi, eta = XI[:4], ETA[:4]
    shares = np.zeros(corners.shape[:2])
    for at, by in ((-GAUSS, -GAUSS), (GAUSS, -GAUSS), (GAUSS, GAUSS), (-GAUSS, GAUSS)):
        shape = 0.25 * (1.0 + xi * at) * (1.0 + eta * by)
        along = np.einsum("a,fak->fk", 0.25 * xi * (1.0 + eta * by), corners)
        across = np.einsum("a,fak->fk", 0.25 * eta * (1.0 + xi * at), corners)
        area = np.linalg.norm(np.cross(along, across), axis=1)
        shares += area[:, None] * shape
    return shares
