"""The order of all walls and samples, which every rank keeps: it knows where they are.

Rows that are near no fluid share one cell in which they keep their order, however they are spread
over the ranks; so the order cannot be found from a rank's own rows.
"""

import numpy as np

from quintet.components.shared.search.cells import Grid, sorted_into
from quintet.components.sph_fluid.state import Array, Whole


class BoundaryOrder:
    """Places of all boundary rows, and the order in which one rank would have them.

    Parameters
    ----------
    position : (n, 3 or more) float array, m
        In the order in which they are; from here on their places in it are their numbers.
    sample : (n,) int array
        Which sample each is; -1 for walls.
    """

    def __init__(self, position: Array, sample: Whole) -> None:
        self._position = position[:, :3].copy()
        self._order = np.arange(len(position))
        samples = np.flatnonzero(sample >= 0)
        self._number = samples[np.argsort(sample[samples])]  # (samples,) of each sample

    def __len__(self) -> int:
        return len(self._order)

    def follow(self, position: Array, first: int = 0) -> None:
        """Note where samples (k, 3) m are, from the first one on."""
        self._position[self._number[first : first + len(position)]] = position

    def sort(self, grid: Grid) -> Whole:
        """Sort all by cell; return the place (n,) of each in the order, by number."""
        _, _, order = sorted_into(self._position.take(self._order, axis=0), grid)
        self._order = self._order[order]
        place = np.empty_like(self._order)
        place[self._order] = np.arange(len(place))
        return place
