"""Steps in time: the stable step of each node, and the stages of SSP-RK3."""

import math
from typing import Any

import numpy as np
from numba import njit

from quintet.components.meshless_gas.laws.states import (
    change_square,
    crossing_rate,
    is_state,
    primitive_state,
    sound_speed,
    staged,
)
from quintet.components.shared.numba_options import EXACT, FAST

# Shares of the state at the step's start and of the stage before it, and the weight of the stage
# in the whole step. Shu & Osher, J. Comput. Phys. 77 (1988) 439.
STAGES = ((0.0, 1.0, 1.0 / 6.0), (0.75, 0.25, 1.0 / 6.0), (1.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0))


@njit(**EXACT)
def write_sound(first: int, last: int, primitive: Any, gamma: float, sound: Any) -> None:
    """Write the speed of sound (n,) m/s of nodes."""
    for i in range(first, last):
        sound[i] = sound_speed(primitive[i, 0], primitive[i, 4], gamma)


@njit(**FAST)
def write_bounds(
    first: int,
    last: int,
    rows: Any,
    primitive: Any,
    sound: Any,
    neighbours: Any,
    coefficients: Any,
    frame: Any,
    bounds: Any,
) -> float:
    """Write the stable step [s] of each node at a Courant number of 1; return the least.

    Δt_i = 1/Σ_j of what `crossing_rate` has.
    """
    least = math.inf
    for row in range(first, last):
        i = np.uintp(rows[row])
        fx = fy = fz = 0.0
        if frame is not None:
            fx, fy, fz = frame[i, 0], frame[i, 1], frame[i, 2]
        velocity_i = (primitive[i, 1] - fx, primitive[i, 2] - fy, primitive[i, 3] - fz)
        summed = 0.0
        for k in range(neighbours.shape[1]):
            j = np.uintp(neighbours[i, k])
            coefficient = (coefficients[i, k, 0], coefficients[i, k, 1], coefficients[i, k, 2])
            velocity_j = (primitive[j, 1] - fx, primitive[j, 2] - fy, primitive[j, 3] - fz)
            summed += crossing_rate(velocity_i, velocity_j, coefficient, sound[i], sound[j])
        bounds[i] = 1.0 / summed
        least = min(least, bounds[i])
    return least


@njit(**EXACT)
def advance(
    first: int,
    last: int,
    rows: Any,
    start: Any,
    residual: Any,
    step: float,
    steps: Any,
    old: float,
    new: float,
    gamma: float,
    conservative: Any,
    primitive: Any,
) -> int:
    """Make a stage: U = old U₀ + new (U + Δt R); return the row of a state that is none, or -1.

    Parameters
    ----------
    start, conservative : (n, 5) kg/m3, kg/(m2 s), J/m3
        At the step's start, and now.
    step : float, s
    steps : None or (n,) 1
        Steps of the nodes over `step`.
    old, new : float, 1
        Where `old` is 0, at the first stage, `start` is written.
    primitive : (n, 5)
        Written.
    """
    wrong = -1
    for row in range(first, last):
        i = np.uintp(rows[row])
        dt = step
        if steps is not None:
            dt *= steps[i]
        if old == 0.0:
            for q in range(5):
                start[i, q] = conservative[i, q]
        r0 = staged(start[i, 0], conservative[i, 0], residual[i, 0], dt, old, new)
        r1 = staged(start[i, 1], conservative[i, 1], residual[i, 1], dt, old, new)
        r2 = staged(start[i, 2], conservative[i, 2], residual[i, 2], dt, old, new)
        r3 = staged(start[i, 3], conservative[i, 3], residual[i, 3], dt, old, new)
        r4 = staged(start[i, 4], conservative[i, 4], residual[i, 4], dt, old, new)
        conservative[i, 0], conservative[i, 1], conservative[i, 2] = r0, r1, r2
        conservative[i, 3], conservative[i, 4] = r3, r4
        r, u, v, w, p = primitive_state(r0, r1, r2, r3, r4, gamma)
        primitive[i, 0], primitive[i, 1], primitive[i, 2] = r, u, v
        primitive[i, 3], primitive[i, 4] = w, p
        if not is_state(r, p):
            wrong = row
    return wrong


@njit(**EXACT)
def write_changes(
    first: int, last: int, rows: Any, residual: Any, bounds: Any, conservative: Any, changes: Any
) -> None:
    """Write the squares (m,) of relative changes of densities in the stable steps of nodes."""
    for row in range(first, last):
        i = rows[row]
        changes[row] = change_square(residual[i, 0], bounds[i], conservative[i, 0])


@njit(**EXACT)
def write_conservative(primitive: Any, gamma: float, conservative: Any) -> None:
    """Write density, momentum and energy of primitive states (n, 5)."""
    for i in range(primitive.shape[0]):
        r, u, v, w = primitive[i, 0], primitive[i, 1], primitive[i, 2], primitive[i, 3]
        conservative[i, 0], conservative[i, 1] = r, r * u
        conservative[i, 2], conservative[i, 3] = r * v, r * w
        energy = primitive[i, 4] / (gamma - 1.0) + 0.5 * r * (u * u + v * v + w * w)
        conservative[i, 4] = energy
