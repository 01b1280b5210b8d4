"""Sums over rows of a device in a fixed order: the bits do not depend on the number of threads."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from quintet.components.shared.opencl.arrays import DeviceArray, run

PARTS, MANY_PARTS = 256, 1 << 16  # work items of a processor, and of other devices before these


class Sums:
    """Sums on one device.

    Parameters
    ----------
    queue : pyopencl.CommandQueue
    kernels : pyopencl.Program
        Built from a program that has ``sums.cl``.
    is_processor : bool
        Whether few work items sum many rows each.
    """

    def __init__(self, queue: Any, kernels: Any, is_processor: bool) -> None:
        self.queue, self._sum_parts = queue, kernels.sum_parts
        sizes = (PARTS,) if is_processor else (MANY_PARTS, PARTS)
        self._parts = [DeviceArray(queue, (size, 4)) for size in sizes]

    def of(self, rows: DeviceArray, count: int) -> NDArray[np.float64]:
        """Sums (4,) of the columns of `count` rows (n, 4)."""
        for parts in self._parts:
            run(self.queue, self._sum_parts, parts.shape[0], rows, np.int32(count), parts)
            rows, count = parts, parts.shape[0]
        sums: NDArray[np.float64] = rows.get().sum(axis=0)
        return sums
