"""Tables of several numbers for each of many rows, as devices read them fastest.

Processors read the numbers of a row together. On other devices work items side by side compute
rows side by side: tables are stored by columns there, so that these read neighbouring words.
"""

from typing import Any

import numpy as np
from numpy.typing import DTypeLike, NDArray

from quintet.components.shared.opencl.arrays import DeviceArray


class Tables:
    """Makes tables in the memory of one device.

    Parameters
    ----------
    queue : pyopencl.CommandQueue
    by_rows : bool
        Whether the numbers of a row stand together; else those of a column.
    """

    def __init__(self, queue: Any, by_rows: bool) -> None:
        self.queue, self.by_rows = queue, by_rows

    def empty(self, rows: int, width: int, dtype: DTypeLike = np.float64) -> DeviceArray:
        """Make room for a table."""
        return DeviceArray(self.queue, (rows, width), dtype)

    def of(self, array: NDArray[Any], dtype: DTypeLike = np.float64) -> DeviceArray:
        """Copy an array (n, ...) to a table of n rows."""
        rows = len(array)
        table = self.empty(rows, int(np.prod(array.shape[1:])), dtype)
        self.put(table, array)
        return table

    def put(self, table: DeviceArray, array: NDArray[Any]) -> None:
        """Write an array (n, ...) into its table."""
        flat = array.reshape(table.shape)
        table.put(flat if self.by_rows else flat.T)

    def get(self, table: DeviceArray) -> NDArray[Any]:
        """Read a table (n, width)."""
        words = table.get()
        return words if self.by_rows else words.reshape(table.shape[::-1]).T
