"""Loops of conduction: the matrix of conductances, and conjugate gradients."""

import numpy as np
from numba import njit

from quintet.components.fe_plate.heat.laws import ETA, GAUSS, XI, ZETA, shapes_at
from quintet.components.fe_plate.heat.state import Matrix
from quintet.components.fe_plate.meshes.arrays import Array, Whole
from quintet.components.shared.numba_options import EXACT, INNER


@njit(**EXACT)
def pattern(corner: Whole, begin: Whole, at: Whole) -> tuple[Whole, Array]:
    """Which nodes share an element with each node, itself left out: starts of rows, and columns.

    Parameters
    ----------
    corner : (e, 8) int array
    begin, at : int arrays
        Corners at each node, as `incident` gives them.
    """
    nodes = begin.shape[0] - 1
    seen = np.full(nodes, -1)
    first = np.zeros(nodes + 1, np.int64)
    for i in range(nodes):
        seen[i] = i
        for k in range(begin[i], begin[i + 1]):
            for j in corner[at[k] // 8]:
                if seen[j] != i:
                    seen[j] = i
                    first[i + 1] += 1
        first[i + 1] += first[i]
    column = np.empty(first[nodes], np.int32)
    seen[:] = -1
    for i in range(nodes):
        seen[i] = i
        end = first[i]
        for k in range(begin[i], begin[i + 1]):
            for j in corner[at[k] // 8]:
                if seen[j] != i:
                    seen[j] = i
                    place = end
                    while place > first[i] and column[place - 1] > j:
                        column[place] = column[place - 1]
                        place -= 1
                    column[place] = j
                    end += 1
    return first, column


@njit(**INNER)
def entry(matrix, i, j):  # type: ignore[no-untyped-def]
    """Place of the column j in the row i."""
    low, high = matrix.first[i], matrix.first[i + 1]
    while high - low > 1:
        middle = (low + high) // 2
        if matrix.column[middle] <= j:
            low = middle
        else:
            high = middle
    return low


@njit(**EXACT)
def write_matrix(
    node: Array, corner: Whole, conductivity: Array, capacity: Array, matrix: Matrix,
    nodal: Array, volume: Array,
) -> int:  # fmt: skip
    """Add up conductances and capacities of all elements; return one that is inside out, or -1.

    Parameters
    ----------
    node : (n, 3) float array, m
    corner : (e, 8) int array
    conductivity : (e,) float array, W/(m K)
    capacity : (e,) float array, J/(m3 K)
    matrix : Matrix
        Its values are written.
    nodal, volume : (n,) float arrays, J/K, m3
        Written.
    """
    x, element = np.empty((8, 3)), np.empty((8, 8))
    shape, natural, gradient = np.empty(8), np.empty((8, 3)), np.empty((8, 3))
    matrix.value[:], matrix.diagonal[:], nodal[:], volume[:] = 0.0, 0.0, 0.0, 0.0
    for e in range(corner.shape[0]):
        for a in range(8):
            for k in range(3):
                x[a, k] = node[corner[e, a], k]
        element[:] = 0.0
        for q in range(8):
            weight = shapes_at(
                GAUSS * XI[q], GAUSS * ETA[q], GAUSS * ZETA[q], x, shape, natural, gradient
            )
            if not weight > 0.0:
                return e
            for a in range(8):
                volume[corner[e, a]] += weight * shape[a]
                nodal[corner[e, a]] += capacity[e] * weight * shape[a]
                for b in range(8):
                    along = gradient[a, 0] * gradient[b, 0] + gradient[a, 1] * gradient[b, 1]
                    along += gradient[a, 2] * gradient[b, 2]
                    element[a, b] += conductivity[e] * weight * along
        for a in range(8):
            i = corner[e, a]
            for b in range(8):
                if b != a:
                    matrix.value[entry(matrix, i, corner[e, b])] += element[a, b]
                    matrix.diagonal[i] -= element[a, b]
    return -1


@njit(**EXACT)
def conduct(matrix: Matrix, temperature: Array, flow: Array) -> None:
    """Write the heat (n,) W that flows into each node; none where all are alike, to the bit."""
    for i in range(flow.shape[0]):
        here, summed = temperature[i], 0.0
        for k in range(matrix.first[i], matrix.first[i + 1]):
            summed += matrix.value[k] * (here - temperature[matrix.column[k]])
        flow[i] = summed


@njit(**INNER)
def dot(left, right):  # type: ignore[no-untyped-def]
    """Scalar product, in four sums side by side."""
    a, b, c, d = 0.0, 0.0, 0.0, 0.0
    whole = left.shape[0] // 4 * 4
    for i in range(0, whole, 4):
        a += left[i] * right[i]
        b += left[i + 1] * right[i + 1]
        c += left[i + 2] * right[i + 2]
        d += left[i + 3] * right[i + 3]
    for i in range(whole, left.shape[0]):
        a += left[i] * right[i]
    return (a + b) + (c + d)


@njit(**EXACT)
def solve(
    matrix: Matrix, shift: Array, free: Array, load: Array, x: Array, tolerance: float, most: int
) -> tuple[int, float]:
    """Solve (K + shift) x = load for the free nodes, by conjugate gradients from where x is.

    Parameters
    ----------
    matrix : Matrix
        K; its diagonal plus the shift is the preconditioner.
    shift : (n,) float array, W/K
    free : (n,) float array, 1
        0 of nodes whose x stays.
    load : (n,) float array, W
    x : (n,) float array, K
        Begun with, and written.
    tolerance : float, 1
        Of the residual over the right side, both in the sum of squares.
    most : int
        Greatest number of iterations.

    Returns
    -------
    int, float
        Iterations, and the residual over the right side.

    References
    ----------
    Hestenes & Stiefel, J. Res. Natl. Bur. Stand. 49 (1952) 409.
    """
    n = x.shape[0]
    r, z, p, q = np.empty(n), np.empty(n), np.empty(n), np.empty(n)
    z[:] = (1.0 - free) * x
    conduct(matrix, z, q)
    r[:] = free * (load + q)
    size = dot(r, r)
    conduct(matrix, x, q)
    r[:] = free * (load + q - shift * x)
    left = dot(r, r)
    enough = tolerance * tolerance * size
    if size == 0.0 and left > 0.0:  # nothing warms it: all are 0 K
        x[:] = (1.0 - free) * x
        return 0, 0.0
    rho, iterations = 0.0, 0
    p[:] = 0.0
    while left > enough and iterations < most:
        for i in range(n):
            z[i] = r[i] / (matrix.diagonal[i] + shift[i])
        last, rho = rho, dot(r, z)
        beta = rho / last if iterations > 0 else 0.0
        for i in range(n):
            p[i] = z[i] + beta * p[i]
        conduct(matrix, p, q)
        for i in range(n):
            q[i] = free[i] * (shift[i] * p[i] - q[i])
        alpha = rho / dot(p, q)
        for i in range(n):
            x[i] += alpha * p[i]
            r[i] -= alpha * q[i]
        left = dot(r, r)
        iterations += 1
    return iterations, np.sqrt(left / size) if size > 0.0 else 0.0
