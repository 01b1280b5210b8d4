"""Least conductivity of the elements at which exchanges do not swing ever further.

    python -m quintet.scenarios.hot_bar_coupled.gain WINDOW RELAXATION

WINDOW [s] is the time between two exchanges. Points are ten layers with the heat capacity of 3 k
per point, joined by conductances that give the measured resistance; 0.85 of a layer are contacts
between the layers at the ends and their baths (`conductivity`). With the mean
heat flow Q of a window the elements have the temperature T = 570 K - R Q at the interface; a share
RELAXATION of its change reaches the points:
T[n+1] = T[n] + r (570 K - R Q[n] - T[n]). Where T alternates, every window also fills or empties
the layers, so that Q answers T by more than a steady flow does.
"""

import sys

import numpy as np
from scipy.linalg import expm

from quintet.interfaces.component import Array

LAYERS, PER_LAYER = 10, 16
CAPACITY = 3.0 * 3.469783e-12 * PER_LAYER  # J/K, of a layer
RESISTANCE = 6.684e8  # K/W, of the points, measured
CONTACTS = 0.85  # layers, both together
LENGTH, AREA = 0.0225, 1e-4  # m, m2, of the elements


def window_matrix(window: float) -> Array:
    """Temperatures of the layers, heat given by the hot bath [J], and its temperature, a window on.

    All are deviations from the steady state; that of the hot bath is constant in a window.
    """
    conductance = (LAYERS - 1 + CONTACTS) / RESISTANCE  # W/K, between two layers
    contact = conductance / (0.5 * CONTACTS)
    rates = np.zeros((LAYERS + 2, LAYERS + 2))
    heat, bath = LAYERS, LAYERS + 1
    for layer in range(LAYERS - 1):
        for here, there in ((layer, layer + 1), (layer + 1, layer)):
            rates[here, there] += conductance / CAPACITY
            rates[here, here] -= conductance / CAPACITY
    rates[0, 0] -= contact / CAPACITY
    rates[0, bath] += contact / CAPACITY
    rates[LAYERS - 1, LAYERS - 1] -= contact / CAPACITY
    rates[heat, bath], rates[heat, 0] = contact, -contact
    matrix: Array = expm(window * rates)
    return matrix


def growth(conductivity: float, window: float, relaxation: float) -> float:
    """Factor per exchange by which the largest deviation grows."""
    resistance = LENGTH / (conductivity * AREA)
    matrix = window_matrix(window)
    flow = matrix[LAYERS] / window
    bath = np.zeros(LAYERS + 2)
    bath[-1] = 1.0 - relaxation
    whole = matrix.copy()
    whole[-1] = bath - relaxation * resistance * flow
    whole[:, LAYERS] = 0.0  # heat is counted from each window's start
    return float(np.abs(np.linalg.eigvals(whole)).max())


def least_conductivity(window: float, relaxation: float) -> float:
    """Least conductivity [W/(m K)] at which no deviation grows."""
    low, high = 1e-9, 1e-5
    while high - low > 1e-4 * high:
        middle = float(np.sqrt(low * high))
        low, high = (low, middle) if growth(middle, window, relaxation) <= 1.0 else (middle, high)
    return high


if __name__ == "__main__":
    print(f"{least_conductivity(float(sys.argv[1]), float(sys.argv[2])):.3g} W/(m K)")
