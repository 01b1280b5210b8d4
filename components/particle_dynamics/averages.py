"""Means over time of quantities known by their integrals, with standard errors by blocks."""

import math

import numpy as np

from quintet.interfaces.component import Array


class BlockMeans:
    """Mean rates of integrals from a time on, and their scatter between blocks.

    Parameters
    ----------
    count : int
        Number of integrals.
    begin : float, s
    block : float, s
    """

    def __init__(self, count: int, begin: float, block: float) -> None:
        self.count, self.begin, self.block = count, begin, block
        # A row for each: integral at the start, at the block's start, sum and squares of means.
        # The last row: times of both, number of blocks, and whether the start has passed.
        self.sums: Array = np.zeros((count + 1, 4))

    def needs(self, time: float) -> bool:
        """Whether the integrals at a time [s] begin or end a block."""
        _, since, _, has_begun = self.sums[-1].tolist()
        if has_begun:
            return bool(time - since >= self.block * (1.0 - 1e-9))
        return time >= self.begin * (1.0 - 1e-12)

    def add(self, time: float, integrals: Array) -> None:
        """Take the integrals (count,) at a time [s], where they are needed."""
        if not self.needs(time):
            return
        rows, (first, since, blocks, has_begun) = self.sums[:-1], self.sums[-1].tolist()
        if not has_begun:
            rows[:, 0] = rows[:, 1] = integrals
            self.sums[-1] = (time, time, 0.0, 1.0)
        else:
            rate = (integrals - rows[:, 1]) / (time - since)
            rows[:, 1] = integrals
            rows[:, 2] += rate
            rows[:, 3] += rate * rate
            self.sums[-1] = (first, time, blocks + 1.0, 1.0)

    def means(self, time: float, integrals: Array) -> Array:
        """Mean rates (count,) from the start until a time [s]; 0 before."""
        first, _, _, has_begun = self.sums[-1].tolist()
        if not has_begun or time <= first:
            return np.zeros(self.count)
        return np.asarray((integrals - self.sums[:-1, 0]) / (time - first))

    def errors(self) -> Array:
        """Standard errors (count,) of the means of whole blocks; 0 until there are two."""
        blocks = float(self.sums[-1, 2])
        if blocks < 2.0:
            return np.zeros(self.count)
        mean = self.sums[:-1, 2] / blocks
        variance = np.maximum(self.sums[:-1, 3] / blocks - mean * mean, 0.0)
        return np.asarray(np.sqrt(variance) / math.sqrt(blocks - 1.0))
