"""Images a period away on a device; imported only by a fluid whose tank repeats."""

from pathlib import Path
from typing import Any

import numpy as np

from quintet.components.shared.opencl.arrays import DeviceArray, run
from quintet.components.shared.search.neighbours import Around
from quintet.components.sph_fluid.boundary.method import BoundaryMethod
from quintet.components.sph_fluid.open_boundaries.periodic import PeriodicImages
from quintet.components.sph_fluid.state import State

SOURCE = Path(__file__).with_name("periods.cl")


class DevicePeriods:
    """Images behind the rows of a fluid on one rank.

    Parameters
    ----------
    periodic : PeriodicImages
        Of the host, which finds them.
    queue : pyopencl.CommandQueue
    kernels : pyopencl.Program
        Built from a text that has `SOURCE`.
    """

    are_there = True

    def __init__(self, periodic: PeriodicImages, queue: Any, kernels: Any) -> None:
        self.queue, self._host, self.count = queue, periodic, 0
        self._positions, self._velocities = kernels.shift_positions, kernels.repeat_velocities
        self._apparent = kernels.repeat_apparent
        self._numbers: list[tuple[Any, ...]] = []  # of each shift: origins, count, first image

    def around(self, state: State, reach: float, boundary: BoundaryMethod) -> Around | None:
        """Make room for images in a state with lists, and find what may be near; else drop them."""
        self._numbers, self.count = [], 0
        if not len(state.reference):
            return None
        around = self._host.around(state, reach, boundary.query_points(state)[0])
        for shift in self._host.shifts:
            row = DeviceArray.of(self.queue, shift.origin.astype(np.int32))
            numbers = map(np.int32, (len(shift.origin), shift.images.start))
            self._numbers.append((row, *numbers))
        self.count = len(around.points) - state.particles
        return around

    def write(self, position: DeviceArray, velocity: DeviceArray) -> None:
        """Write the images of positions (n, 4) and velocities (n, 4)."""
        for shift, numbers in zip(self._host.shifts, self._numbers, strict=True):
            count, step = int(numbers[1]), (np.int32(shift.axis), np.float64(shift.distance))
            run(self.queue, self._positions, count, *numbers, *step, position)
            run(self.queue, self._velocities, count, *numbers, velocity)

    def write_apparent(self, apparent: DeviceArray) -> None:
        """Write the images of velocities (n, 4), in the precision of pairs."""
        for numbers in self._numbers:
            run(self.queue, self._apparent, int(numbers[1]), *numbers, apparent)

    def reflect_crossed(self, split: int, *arrays: DeviceArray | None) -> None:
        """Nothing to do: what passed a face has images until lists are made again."""
