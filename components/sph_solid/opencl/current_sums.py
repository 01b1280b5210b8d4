"""Sums over particles that are near now, on a device."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from quintet.components.shared.opencl.arrays import DeviceArray, run
from quintet.components.sph_solid.opencl.device_state import DeviceState
from quintet.components.sph_solid.state import Array, State


class DeviceCurrentSums:
    """Sums over pairs that are near now, or over azimuthal images of rings.

    Parameters
    ----------
    queue : pyopencl.CommandQueue
    kernels : pyopencl.Program
        Of `programs.source`.
    law : (1,) array
        Bytes of the law of pairs.
    """

    def __init__(self, queue: Any, kernels: Any, law: NDArray[Any]) -> None:
        self.queue, self._law = queue, law
        self._gradients, self._accelerations = kernels.velocity_gradients, kernels.accelerations

    def make(self, rows: DeviceState, state: State) -> None:
        """Nothing to do: `rows` has the lists."""

    def listed(self, rows: DeviceState) -> DeviceArray:
        """Places (n, 3) m from which a step measures displacements."""
        return rows.reference

    def is_unstable(self, low: Array, high: Array) -> bool:
        """Nothing to tell: a search finds out."""
        return False

    def may_miss(self, low: Array, high: Array) -> bool:
        """Lists may lack a pair where displacements (3,) m are large."""
        return True

    def write_gradients(self, rows: DeviceState) -> None:
        """Write gradients of velocity."""
        run(
            self.queue, self._gradients, rows.count, np.int32(rows.count), rows.place, rows.motion,
            *self._near(rows), rows.gradient, rows.correction,
        )  # fmt: skip

    def write_accelerations(self, rows: DeviceState) -> None:
        """Write accelerations, heating, and minus the stable steps in `rows.extremes`."""
        rows.images.write_stresses(rows.stress, rows.count)
        run(
            self.queue, self._accelerations, rows.count, np.int32(rows.count), rows.place,
            rows.motion, rows.stress, *self._near(rows), rows.arrays["acceleration"],
            rows.arrays["heating"], rows.extremes,
        )  # fmt: skip

    def forces(self, rows: DeviceState) -> tuple[DeviceArray, ...]:
        """None beside the accelerations of `rows`."""
        return ()

    def _near(self, rows: DeviceState) -> tuple[Any, ...]:
        lists = rows.lists
        strides = lists.row_stride, lists.item_stride
        return lists.near, lists.end, *strides, rows.turn, rows.turns, self._law
