"""Steps in time: the stable step of each node, and the stages of SSP-RK3."""

import math
from typing import Any

import numpy as np
from numba import njit

from quintet.components.shared.numba_options import EXACT, FAST

# Shares of the state at the step's start and of the stage before it, and the weight of the stage
# in the whole step. Shu & Osher, J. Comput. Phys. 77 (1988) 439.
STAGES = ((0.0, 1.0, 1.0 / 6.0), (0.75, 0.25, 1.0 / 6.0), (1.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0))


@njit(**EXACT)
def write_sound(first: int, last: int, primitive: Any, gamma: float, sound: Any) -> None:
    """Write the speed of sound (n,) m/s of nodes."""
    for i in range(first, last):
        sound[i] = math.sqrt(gamma * primitive[i, 4] / primitive[i, 0])


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

    Δt_i = 1/Σ_j (max(|v_i·c_ij|, |v_j·c_ij|) + max(a_i, a_j) |c_ij|), velocities in the node's
    frame.
    """
    least = math.inf
    for row in range(first, last):
        i = np.uintp(rows[row])
        fx = fy = fz = 0.0
        if frame is not None:
            fx, fy, fz = frame[i, 0], frame[i, 1], frame[i, 2]
        u, v, w = primitive[i, 1] - fx, primitive[i, 2] - fy, primitive[i, 3] - fz
        summed = 0.0
        for k in range(neighbours.shape[1]):
            j = np.uintp(neighbours[i, k])
            x, y, z = coefficients[i, k, 0], coefficients[i, k, 1], coefficients[i, k, 2]
            carried = abs(u * x + v * y + w * z)
            other = abs(
                (primitive[j, 1] - fx) * x + (primitive[j, 2] - fy) * y + (primitive[j, 3] - fz) * z
            )
            size = math.sqrt(x * x + y * y + z * z)
            summed += max(carried, other) + max(sound[i], sound[j]) * size
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
        r0 = old * start[i, 0] + new * (conservative[i, 0] + dt * residual[i, 0])
        r1 = old * start[i, 1] + new * (conservative[i, 1] + dt * residual[i, 1])
        r2 = old * start[i, 2] + new * (conservative[i, 2] + dt * residual[i, 2])
        r3 = old * start[i, 3] + new * (conservative[i, 3] + dt * residual[i, 3])
        r4 = old * start[i, 4] + new * (conservative[i, 4] + dt * residual[i, 4])
        conservative[i, 0], conservative[i, 1], conservative[i, 2] = r0, r1, r2
        conservative[i, 3], conservative[i, 4] = r3, r4
        u, v, w = r1 / r0, r2 / r0, r3 / r0
        p = (gamma - 1.0) * (r4 - 0.5 * (r1 * u + r2 * v + r3 * w))
        primitive[i, 0], primitive[i, 1], primitive[i, 2] = r0, u, v
        primitive[i, 3], primitive[i, 4] = w, p
        if not (r0 > 0.0 and p > 0.0 and p < math.inf and r0 < math.inf):
            wrong = row
    return wrong


@njit(**EXACT)
def write_changes(
    first: int, last: int, rows: Any, residual: Any, bounds: Any, conservative: Any, changes: Any
) -> None:
    """Write the squares (m,) of relative changes of densities in the stable steps of nodes."""
    for row in range(first, last):
        i = rows[row]
        rate = residual[i, 0] * bounds[i] / conservative[i, 0]
        changes[row] = rate * rate


@njit(**EXACT)
def write_conservative(primitive: Any, gamma: float, conservative: Any) -> None:
    """Write density, momentum and energy of primitive states (n, 5)."""
    for i in range(primitive.shape[0]):
        r, u, v, w = primitive[i, 0], primitive[i, 1], primitive[i, 2], primitive[i, 3]
        conservative[i, 0], conservative[i, 1] = r, r * u
        conservative[i, 2], conservative[i, 3] = r * v, r * w
        energy = primitive[i, 4] / (gamma - 1.0) + 0.5 * r * (u * u + v * v + w * w)
        conservative[i, 4] = energy
