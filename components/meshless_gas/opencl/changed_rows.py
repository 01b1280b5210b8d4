"""Some rows of tables on a device, written from the host."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from quintet.components.meshless_gas.opencl.device_cloud import INDEX
from quintet.components.meshless_gas.opencl.device_state import DeviceState
from quintet.components.shared.opencl.arrays import DeviceArray


class ChangedRows:
    """Copies rows that the host has changed; the room for them is kept, and grows.

    Parameters
    ----------
    state : DeviceState
    """

    def __init__(self, state: DeviceState) -> None:
        self.state = state
        self._staged: dict[np.dtype[Any], DeviceArray] = {}
        self._rows = DeviceArray(state.queue, (0,), INDEX)

    def put(self, table: DeviceArray, rows: NDArray[Any], values: NDArray[Any]) -> None:
        """Write values (m, ...) into rows (m,) of a table of numbers, or of numbers of nodes."""
        if not len(rows):
            return
        whole, width = table.shape
        words = len(rows) * width
        staged = self._staged.get(table.dtype)
        if staged is None or staged.shape[0] < words:
            staged = self._staged[table.dtype] = DeviceArray(
                self.state.queue, (2 * words,), table.dtype
            )
        if self._rows.shape[0] < len(rows):
            self._rows = DeviceArray(self.state.queue, (2 * len(rows),), INDEX)
        self._rows.put(rows)
        staged.put(values)
        name = "write_rows_of_nodes" if table.dtype == INDEX else "write_rows"
        sizes = map(np.int32, (len(rows), width, whole))
        self.state.run(name, words, *sizes, self._rows, staged, table)
