"""Which particles are near to gauges."""

import numpy as np
from numpy.typing import NDArray

from quintet.components.sph_fluid.state import Array


def near_places(places: Array, reach: float, points: Array) -> NDArray[np.bool_]:
    """Whether points (n, 3 or more) m are near to one of some places (m, 2 or 3) m.

    Nearer than `reach` [m] along x, y and, if places have it, z.
    """
    near = np.zeros(len(points), bool)
    for place in places:
        beside = np.ones(len(points), bool)
        for axis in range(len(place)):
            beside &= np.abs(points[:, axis] - place[axis]) <= reach
        near |= beside
    return near
