"""Sidedness of stencils."""

from typing import Any

import numpy as np
from numba import njit

from quintet.components.shared.numba_options import EXACT


@njit(**EXACT)
def write_sidedness(
    first: int,
    last: int,
    rows: Any,
    positions: Any,
    neighbours: Any,
    coefficients: Any,
    along: Any,
    sided: Any,
) -> None:
    """Write the sidedness of nodes, in coordinates over their greatest reach along each axis.

    Parameters
    ----------
    along : (a, 3) 1
        Unit vectors.
    sided : (m,) 1
        Written.
    """
    reach = np.empty(3)
    for row in range(first, last):
        i = rows[row]
        reach[:] = 1e-300
        for k in range(neighbours.shape[1]):
            for d in range(3):
                reach[d] = max(reach[d], abs(positions[neighbours[i, k], d] - positions[i, d]))
        worst = 0.0
        for a in range(along.shape[0]):
            upstream = 0.0
            for k in range(neighbours.shape[1]):
                j = neighbours[i, k]
                flux = arm = 0.0
                for d in range(3):
                    flux += along[a, d] * coefficients[i, k, d] * reach[d]
                    arm += along[a, d] * (positions[j, d] - positions[i, d]) / reach[d]
                if flux < 0.0:
                    upstream += 2.0 * flux * arm
            worst = max(worst, abs(upstream - 1.0))
        sided[row] = worst
