"""Copies in single precision of what pairs need; imported only by a scene that asks.

A state stays double. Positions are copied relative to the middle of the particles, and other
numbers to their usual value, so that what is rounded away is 6e-8 of what is left.
"""

from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

from quintet.components.shared.numba_options import FAST
from quintet.components.shared.threads import Team
from quintet.interfaces.component import Array

Singles = NDArray[np.float32]


def rounded(numbers: Any) -> Any:
    """Round numbers and arrays to single precision, in (nested) named tuples too.

    None and True, which say what is compiled, stay as they are.
    """
    if numbers is None or numbers is True:
        return numbers
    if isinstance(numbers, tuple):
        return type(numbers)(*map(rounded, numbers))
    return np.asarray(numbers, np.float32)[()]


@njit(**FAST)
def copy_rows(
    first: int, last: int, origin: tuple[float, ...], source: Array, target: Singles
) -> None:
    """Write rows [first, last) of `source` (n, width) less the origin, a number for each column."""
    for i in range(first, last):
        for d in range(len(origin)):
            target[i, d] = source[i, d] - origin[d]


class SingleCopy:
    """A copy in single precision of an array (n, width), less an origin."""

    def __init__(self, shape: tuple[int, ...], origin: tuple[float, ...]) -> None:
        self.origin = origin
        self.array: Singles = np.empty(shape, np.float32)

    def of(self, source: Array, team: Team) -> Singles:
        """Copy the array as it is now."""
        team.run(copy_rows, len(source), self.origin, source, self.array)
        return self.array
