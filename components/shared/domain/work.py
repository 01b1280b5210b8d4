"""How much work the rows of a rank are, by the time that their steps took."""

import time

import numpy as np
from numpy.typing import NDArray

from quintet.interfaces.waited import WAITED

Whole = NDArray[np.int64]
PER_SECOND = 1e10  # unit of weights: 0.1 ns of a step
MOST = 1 << 20  # weight of a row, a hundred microseconds


class Work:
    """Measures steps of this rank without what it waits for others."""

    def __init__(self) -> None:
        self._began, self._seconds, self._steps = 0.0, 0.0, 0

    def begin(self) -> None:
        """Begin a step, or what is done after it."""
        self._began = time.perf_counter() - WAITED.seconds

    def end(self, steps: int = 1) -> None:
        """End it: a step, or none where its time belongs to the last one."""
        self._seconds += time.perf_counter() - WAITED.seconds - self._began
        self._steps += steps

    def weights(self, rows: int) -> Whole:
        """Weight (rows,) of each row, by the steps since the last call; alike at the start."""
        weight = 1
        if self._steps and rows:
            weight = round(PER_SECOND * self._seconds / self._steps / rows)
        self._seconds, self._steps = 0.0, 0
        return np.full(rows, min(max(weight, 1), MOST))
