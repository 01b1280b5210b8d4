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


def capped(first: Array, total: float, layers: int, largest: float) -> Array:
    """Distances whose steps grow by a constant factor until they are as large as they may be.

    Parameters
    ----------
    first : (m,) m
        Thickness of the first layer, at most total/layers.
    total : float, m
        Distance of the last.
    layers : int
    largest : float, m
        Thickness that no layer passes, but a first one that is thicker.

    Returns
    -------
    (layers + 1, m) m
        Begins with zero.
    """
    most, powers = np.maximum(first, largest), np.arange(layers)[:, None]
    low, high = np.ones(len(first)), np.full(len(first), 10.0)
    for _ in range(ROUNDS):
        middle = 0.5 * (low + high)
        reach = np.minimum(first * middle**powers, most).sum(axis=0)
        low, high = np.where(reach < total, middle, low), np.where(reach < total, high, middle)
    steps = np.minimum(first * low**powers, most)
    inner = np.vstack([np.zeros(len(first)), np.cumsum(steps, axis=0)])
    return np.asarray(inner / inner[-1] * total)


def _sum(ratio: Array, layers: int) -> Array:
    """Sum of a geometric series of so many terms."""
    near = np.abs(ratio - 1.0) < 1e-9
    safe = np.where(near, 2.0, ratio)
    return np.where(near, float(layers), (safe**layers - 1.0) / (safe - 1.0))
