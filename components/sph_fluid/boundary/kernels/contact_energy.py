"""The loop that sums the energy of the contact potential."""

import numpy as np
from numba import njit

from quintet.components.shared.numba_options import FAST
from quintet.components.shared.search.neighbours import Lists
from quintet.components.shared.smoothing.smoothing import kernel
from quintet.components.sph_fluid.laws import Constants, WallRepulsion
from quintet.components.sph_fluid.state import Array


@njit(**FAST)
def stored_energy(
    first: int, last: int, position: Array, stiff: Array, lists: Lists, inverse: float,
    exponent: int, per_volume: float, repulsion: WallRepulsion, constants: Constants, energy: Array,
) -> None:  # fmt: skip
    """Write the energy over m² of fluid rows [first, last) with their boundary neighbours."""
    _, middle, end, neighbour = lists
    for i in range(first, last):
        total = 0.0
        for k in range(np.uint64(middle[i]), np.uint64(end[i])):
            j = np.uint64(neighbour[k])
            x, y = position[i, 0] - position[j, 0], position[i, 1] - position[j, 1]
            z = position[i, 2] - position[j, 2]
            r2 = x * x + y * y + z * z
            total += stiff[j] * per_volume * (kernel(r2, constants.smoothing) * inverse) ** exponent
            close = max(1.0 - r2 / repulsion.reach2, 0.0)
            total += 0.25 * repulsion.stiffness * repulsion.reach2 * close * close
        energy[i] = total
