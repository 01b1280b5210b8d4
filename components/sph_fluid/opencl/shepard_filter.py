"""The Shepard filter on a device, as `pairs/shepard_filter.py`; only for a scene that asks."""

from typing import Any

import numpy as np

from quintet.components.shared.opencl.arrays import DeviceArray, run
from quintet.components.shared.opencl.types import bytes_of
from quintet.components.sph_fluid.constants import constants
from quintet.components.sph_fluid.opencl.device_state import DeviceState
from quintet.components.sph_fluid.params import SphFluidParams


class DeviceFilter:
    """A filter of the density."""

    def __init__(self, params: SphFluidParams, kernels: Any, rows: DeviceState) -> None:
        self.rows, self._constants = rows, bytes_of(constants(params), np.float64)
        self._filter, self._take = kernels.filter_density, kernels.take_density

    def apply(self) -> None:
        """Filter the fluid's density, and compute pressures again."""
        rows, lists, split = self.rows, self.rows.lists, np.int32(self.rows.split)
        rows.copies.write(rows.position, rows.velocity)
        density = DeviceArray(rows.queue, (rows.split,))
        run(
            rows.queue, self._filter, rows.split, split, rows.position, lists.near, lists.middle,
            lists.row_stride, lists.item_stride, self._constants, density,
        )  # fmt: skip
        places = (rows.role, rows.position, rows.velocity)
        run(rows.queue, self._take, rows.split, split, density, *places, self._constants)
