"""What symmetry about an axis adds to the flow of a half plane."""

from typing import Any

import numpy as np
from numba import njit

from quintet.components.shared.numba_options import FAST


@njit(**FAST)
def add_axis(
    first: int, last: int, rows: Any, positions: Any, primitive: Any, gamma: float, residual: Any
) -> None:
    """Add -(ρw, ρuw, ρw², (E + p)w)/r: circles of nodes grow with their radius r = z.

    Nodes lie on neither side of the axis, whose image is beyond it, so r is never 0.
    """
    for row in range(first, last):
        i = np.uintp(rows[row])
        r, u, w, p = primitive[i, 0], primitive[i, 1], primitive[i, 3], primitive[i, 4]
        rate = r * w / positions[i, 2]
        residual[i, 0] -= rate
        residual[i, 1] -= rate * u
        residual[i, 3] -= rate * w
        residual[i, 4] -= rate * (gamma / (gamma - 1.0) * p / r + 0.5 * (u * u + w * w))
