"""Sums over the neighbours of the start on a device (total Lagrangian); only where a scene asks."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from quintet.components.shared.opencl.arrays import DeviceArray, run
from quintet.components.sph_solid.neighbours import SolidLists
from quintet.components.sph_solid.opencl.device_state import DeviceState
from quintet.components.sph_solid.opencl.touching import DeviceTouching
from quintet.components.sph_solid.reference_sums import ReferenceSums
from quintet.components.sph_solid.state import Array, State


class DeviceReferenceSums:
    """Sums over pairs that are neighbours for good.

    Parameters
    ----------
    queue : pyopencl.CommandQueue
    kernels : pyopencl.Program
        Of `programs.source`.
    law : (1,) array
        Bytes of the law of pairs.
    host : ReferenceSums
    lists : SolidLists
    """

    def __init__(
        self, queue: Any, kernels: Any, law: NDArray[Any], host: ReferenceSums, lists: SolidLists
    ) -> None:
        self.queue, self._law, self._lists = queue, law, lists
        self._penalty = np.float64(host.penalty)
        self._part, self._gradients = kernels.part_bodies, kernels.reference_gradients
        self._nominal = kernels.nominal_stresses
        self._accelerations = kernels.reference_accelerations
        self.touching = DeviceTouching(queue, kernels, host.touching.spacing, lists)

    def make(self, rows: DeviceState, state: State) -> None:
        """Take lists of where particles were at the start; `rows.place` has these places."""
        self.start = DeviceArray(self.queue, rows.place.shape)
        self.start.copy_from(rows.place)
        self.deformed = DeviceArray(self.queue, rows.stress.shape)
        self.forced, self.heats = (DeviceArray(self.queue, (rows.count, 3)) for _ in range(2))
        if self._lists.joined.any():
            near, end, *strides = self._near(rows)
            count = np.int32(rows.count)
            run(self.queue, self._part, rows.count, count, self.start, end, *strides, near)
        self.touching.make(rows, self.start, state)

    def listed(self, rows: DeviceState) -> DeviceArray:
        """Places (n, 3) m from which a step measures displacements."""
        return self.touching.listed

    def is_unstable(self, low: Array, high: Array) -> bool:
        """Whether no stable step leads to displacements (3,) m from where contact was listed."""
        return self._lists.is_unstable(float(np.linalg.norm(high - low)))

    def may_miss(self, low: Array, high: Array) -> bool:
        """Lists of neighbours hold for good; those of contact follow displacements (3,) m."""
        self.touching.follow(low, high)
        return False

    def write_gradients(self, rows: DeviceState) -> None:
        """Write gradients of velocity."""
        run(
            self.queue, self._gradients, rows.count, np.int32(rows.count), self.start, rows.place,
            rows.motion, *self._near(rows), self._law, rows.gradient,
        )  # fmt: skip

    def write_accelerations(self, rows: DeviceState) -> None:
        """Write accelerations, heating, and minus the stable steps in `rows.extremes`."""
        count, near = np.int32(rows.count), self._near(rows)
        run(
            self.queue, self._nominal, rows.count, count, self.start, rows.place, *near, self._law,
            rows.stress, self.deformed,
        )  # fmt: skip
        for tensors in (rows.stress, self.deformed):
            rows.images.write_stresses(tensors, rows.count)
        heating = rows.arrays["heating"]
        run(
            self.queue, self._accelerations, rows.count, count, self._penalty, self.start,
            rows.place, rows.motion, rows.stress, self.deformed, *near, self._law, self.forced,
            self.heats, heating, rows.extremes,
        )  # fmt: skip
        self.touching.add(rows, self.heats)

    def forces(self, rows: DeviceState) -> tuple[DeviceArray, ...]:
        """Accelerations (n, 3) m/s2 by stresses, and by the forces that heat."""
        return self.forced, self.heats

    def _near(self, rows: DeviceState) -> tuple[Any, ...]:
        lists = rows.lists
        return lists.near, lists.end, lists.row_stride, lists.item_stride
