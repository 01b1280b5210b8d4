"""Copies in single precision of what pairs need; imported only by a scene that asks.

The state stays double. Places are copied relative to the middle of the fluid and densities to ρ₀,
so that what is rounded away is 6e-8 of the fluid's extent and of its compression.
"""

from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

from quintet.components.shared.cells import corners
from quintet.components.shared.neighbours import FAST
from quintet.components.shared.team import Team
from quintet.components.sph_fluid.laws import Fluid
from quintet.components.sph_fluid.state import Array, State

Singles = NDArray[np.float32]
Origin = tuple[float, float, float, float]


def rounded(numbers: Any) -> Any:
    """Round the numbers of a law to single precision, and its arrays; None stays None."""
    if numbers is None:
        return None
    if isinstance(numbers, Fluid):
        numbers = numbers._replace(base=numbers.density)
    return type(numbers)(
        *(one if one is None else np.asarray(one, np.float32)[()] for one in numbers)
    )


@njit(**FAST)
def copy(
    first: int, last: int, origin: Origin, place: Array, motion: Array, near: Singles,
    moving: Singles,
) -> None:  # fmt: skip
    """Write rows [first, last) of `place` less the origin, and of `motion`."""
    for i in range(first, last):
        for d in range(4):
            near[i, d] = place[i, d] - origin[d]
            moving[i, d] = motion[i, d]


class Single:
    """Room for the copies of one fluid's state, from one list of neighbours to the next."""

    def __init__(self, state: State, density: float) -> None:
        low, high = corners(state.reference[: state.fluid])
        x, y, z = (0.5 * (low + high)).tolist()
        self.origin: Origin = (x, y, z, density)
        self.place: Singles = np.empty(state.place.shape, np.float32)  # (n, 4) as in the state
        self.motion: Singles = np.empty(state.motion.shape, np.float32)  # (n, 4)

    def of(self, state: State, team: Team) -> tuple[Singles, Singles]:
        """Copy the state as it is now."""
        rows = len(state.place)
        team.run(copy, rows, self.origin, state.place, state.motion, self.place, self.motion)
        return self.place, self.motion
