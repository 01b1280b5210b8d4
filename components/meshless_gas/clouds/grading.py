"""Distances of layers of nodes from a wall."""

import numpy as np

from quintet.interfaces.component import Array

ROUNDS = 80  # of bisection for the growth of layers


def geometric(first: Array | float, total: Array | float, layers: int) -> Array:
    """Distances that grow by a constant factor, from a first one to a total.

    Parameters
    ----------
    first : (m,) or float, m
        Thickness of the first layer.
    total : (m,) or float, m
        Distance of the last.
    layers : int

    Returns
    -------
    (layers + 1, m) m
        Begins with zero; evenly spaced where `first` reaches a share of the total.
    """
    total, first = np.broadcast_arrays(np.atleast_1d(total), np.atleast_1d(first))
    first = np.minimum(first, total / layers)
    low, high = np.full(len(total), 1.0), np.full(len(total), 10.0)
    for _ in range(ROUNDS):
        middle = 0.5 * (low + high)
        reach = first * _sum(middle, layers)
        low, high = np.where(reach < total, middle, low), np.where(reach < total, high, middle)
    thickness = low ** np.arange(layers)[:, None]
    inner = np.vstack([np.zeros(len(total)), np.cumsum(thickness, axis=0)])
    return np.asarray(inner / inner[-1] * total)


def _sum(ratio: Array, layers: int) -> Array:
    """Sum of a geometric series of so many terms."""
    near = np.abs(ratio - 1.0) < 1e-9
    safe = np.where(near, 2.0, ratio)
    return np.where(near, float(layers), (safe**layers - 1.0) / (safe - 1.0))
