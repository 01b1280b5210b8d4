"""Means over time with standard errors by blocks, of what is known by its integral."""

import math

import numpy as np

from quintet.interfaces.component import Array


class BlockMeans:
    """Mean rates of integrals from a time on, and how they scatter from block to block.

    Parameters
    ----------
    count : int
        How many integrals.
    begin : float, s
    block : float, s
    """

    def __init__(self, count: int, begin: float, block: float) -> None:
        self.count, self.begin, self.block = count, begin, block
        # Of each a row: integral at the start, at the block's start, sum and squares of means;
        # a last row has the times of both, the blocks, and whether the start has passed.
        self.kept: Array = np.zeros((count + 1, 4))

    def add(self, time: float, integrals: Array) -> None:
        """Take the integrals (count,) at a time [s]."""
        rows, (first, since, blocks, has_begun) = self.kept[:-1], self.kept[-1].tolist()
        if time < self.begin * (1.0 - 1e-12):
            return
        if not has_begun:
            rows[:, 0] = rows[:, 1] = integrals
            self.kept[-1] = (time, time, 0.0, 1.0)
        elif time - since >= self.block * (1.0 - 1e-9):
            rate = (integrals - rows[:, 1]) / (time - since)
            rows[:, 1] = integrals
            rows[:, 2] += rate
            rows[:, 3] += rate * rate
            self.kept[-1] = (first, time, blocks + 1.0, 1.0)

    def means(self, time: float, integrals: Array) -> Array:
        """Mean rates (count,) from the start until a time [s]; 0 before."""
        first, _, _, has_begun = self.kept[-1].tolist()
        if not has_begun or time <= first:
            return np.zeros(self.count)
        return np.asarray((integrals - self.kept[:-1, 0]) / (time - first))

    def errors(self) -> Array:
        """Standard errors (count,) of the means of whole blocks; 0 until there are two."""
        blocks = float(self.kept[-1, 2])
        if blocks < 2.0:
            return np.zeros(self.count)
        mean = self.kept[:-1, 2] / blocks
        variance = np.maximum(self.kept[:-1, 3] / blocks - mean * mean, 0.0)
        return np.asarray(np.sqrt(variance) / math.sqrt(blocks - 1.0))
