"""Highest frequency of a lattice: Lanczos on its stiffness matrix, summed in a fixed order."""

import math

import numpy as np
from numba import njit

from quintet.components.particle_dynamics.state import Whole
from quintet.components.shared.numba_options import EXACT
from quintet.interfaces.component import Array


@njit(**EXACT)
def apply_stiffness(
    bonds: Whole, direction: Array, along: Array, across: Array, free: Array, x: Array, y: Array
) -> None:
    """Write the product of stiffness and displacement.

    Parameters
    ----------
    bonds : (b, 2) int array
    direction : (b, 3) float array, 1
        Unit vectors along them.
    along, across : (b,) float array, N/m
        dF/dr and F/r.
    free : (n,) float array, 1
        1, and 0 of points that do not move.
    x : (n, 3) float array, m
    y : (n, 3) float array, N
        Written.
    """
    y[:] = 0.0
    for b in range(bonds.shape[0]):
        i, j = bonds[b, 0], bonds[b, 1]
        stretch = 0.0
        for k in range(3):
            stretch += direction[b, k] * (x[i, k] - x[j, k])
        for k in range(3):
            pull = (along[b] - across[b]) * stretch * direction[b, k]
            pull += across[b] * (x[i, k] - x[j, k])
            y[i, k] += pull
            y[j, k] -= pull
    for i in range(y.shape[0]):
        for k in range(3):
            y[i, k] *= free[i]


@njit(**EXACT)
def dot(x: Array, y: Array) -> float:
    """Scalar product of two displacements (n, 3)."""
    product = 0.0
    for i in range(x.shape[0]):
        for k in range(3):
            product += x[i, k] * y[i, k]
    return product


@njit(**EXACT)
def tridiagonal(
    bonds: Whole, direction: Array, along: Array, across: Array, free: Array, start: Array,
    steps: int,
) -> tuple[Array, Array]:  # fmt: skip
    """Lanczos's diagonals of the stiffness matrix, from a start (n, 3), orthogonalised in full."""
    basis = np.zeros((steps, *start.shape))
    diagonal, beside = np.zeros(steps), np.zeros(steps)
    basis[0] = start / math.sqrt(dot(start, start))
    residual = np.empty_like(start)
    for m in range(steps):
        apply_stiffness(bonds, direction, along, across, free, basis[m], residual)
        diagonal[m] = dot(residual, basis[m])
        for _ in range(2):
            for k in range(m + 1):
                residual -= dot(residual, basis[k]) * basis[k]
        length = math.sqrt(dot(residual, residual))
        if m + 1 == steps or length < 1e-10 * abs(diagonal[0]):
            return diagonal[: m + 1], beside[:m]
        beside[m] = length
        basis[m + 1] = residual / length
    return diagonal, beside


@njit(**EXACT)
def highest_eigenvalue(diagonal: Array, beside: Array) -> float:
    """Highest eigenvalue of a symmetric tridiagonal matrix, by bisection with Sturm's sequence."""
    size = diagonal.shape[0]
    high = 0.0
    for k in range(size):
        reach = abs(diagonal[k])
        reach += abs(beside[k]) if k < size - 1 else 0.0
        reach += abs(beside[k - 1]) if k > 0 else 0.0
        high = max(high, reach)
    low = -high
    for _ in range(80):
        middle = 0.5 * (low + high)
        above, pivot = 0, 1.0
        for k in range(size):
            square = beside[k - 1] * beside[k - 1] if k > 0 else 0.0
            pivot = diagonal[k] - middle - square / pivot
            if pivot == 0.0:
                pivot = 1e-300
            above += int(pivot > 0.0)
        if above > 0:
            low = middle
        else:
            high = middle
    return 0.5 * (low + high)
