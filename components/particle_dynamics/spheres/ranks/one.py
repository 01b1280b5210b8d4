"""All spheres on one rank."""

from collections.abc import Sequence

import numpy as np

from quintet.components.particle_dynamics.spheres.state import Spheres, State
from quintet.components.shared.exact_sums import bounds, sum_parts, total
from quintet.interfaces.component import Array, Fields


class OneRank:
    """Spheres whose state is all there is.

    Parameters
    ----------
    spheres : Spheres
    state : State
    """

    def __init__(self, spheres: Spheres, state: State) -> None:
        self.spheres, self.state, self.count = spheres, state, len(spheres.mass)
        self.ids = np.arange(self.count)

    def greatest(self, number: float) -> float:
        """Return the number."""
        return number

    def added(self, numbers: Array) -> Array:
        """Return the numbers."""
        return numbers

    def sums(self, columns: Sequence[Array]) -> Array:
        """Sums (k,) of columns (n,), exact before they are rounded."""
        return total(sum_parts(columns, bounds(columns), self.count))

    def not_finite(self, rows: Array) -> int:
        """Lowest number of a sphere whose row (n, 3) is not finite; their count if all are."""
        finite = np.isfinite(rows)
        return self.count if finite.all() else int(np.argmin(finite.all(axis=1)))

    def here(self, rows: Array) -> Array:
        """Return the rows."""
        return rows

    def whole(self, rows: Array) -> Array:
        """Copy of the rows."""
        return rows.copy()

    def give(self, rows: Sequence[Array]) -> Sequence[Array]:
        """Copies of the rows."""
        return [array.copy() for array in rows]

    def load(self, state: Fields) -> None:
        """Restore a state."""
        for name, array in self.state._asdict().items():
            array[:] = state[name]
