"""The rows of balls in the memory of a device, and their motion as ports have it."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from quintet.components.dem_bodies.state import Model, Numbers, State, sort_rows
from quintet.components.shared.opencl.arrays import DeviceArray, run

# Arrays of `State` that a device changes; the ground, behind all balls, has them on the host.
READ = ("motion", "orientation", "contact_load", "previous_contact_load")


class DeviceRows:
    """Rows of balls, in the order of the host's.

    Parameters
    ----------
    queue : pyopencl.CommandQueue
    kernels : pyopencl.Program
        Of `programs.source`.
    model, state
        Of the host; all bodies are balls.
    """

    def __init__(self, queue: Any, kernels: Any, model: Model, state: State) -> None:
        self.queue, self._model, self._state = queue, model, state
        self.count = int(np.count_nonzero(model.ball))
        self._pack = kernels.pack
        self.arrays = {
            name: DeviceArray(queue, getattr(state, name).shape) for name in (*READ, "load")
        }
        self.listed = DeviceArray(queue, state.listed_centre.shape)
        self.inverse = DeviceArray(queue, (self.count, 2))
        self.body, self.material = (DeviceArray(queue, (self.count,), np.int64) for _ in range(2))
        self._spare: dict[int, DeviceArray] = {}  # buffers for sorting, by their number of words
        self.is_sorted_apart = False  # whether the host's rows have another order
        self._packed = DeviceArray(queue, (13 * self.count,))
        self.plane, self._planes = DeviceArray(queue, model.plane.shape), np.zeros((0, 4))
        self.put_planes()

    def put(self) -> None:
        """Copy the host's rows to the device."""
        model, state = self._model, self._state
        for name, array in self.arrays.items():
            array.put(getattr(state, name))
        self.listed.put(state.listed_centre)
        inverses = np.column_stack([model.inverse_mass, model.inverse_moment])
        self.inverse.put(inverses[: self.count])
        self.body.put(state.body[: self.count])
        self.material.put(model.material[: self.count])
        self.is_sorted_apart = False

    def put_planes(self) -> None:
        """Copy the planes to the device if any has vanished or come back."""
        planes = self._model.plane
        if not np.array_equal(planes, self._planes):
            self._planes = planes.copy()
            self.plane.put(planes)

    def put_loads(self) -> None:
        """Copy the loads on all balls to the device."""
        self.arrays["load"].put(self._state.load)

    def sorted_arrays(self) -> list[DeviceArray]:
        """Arrays that have a row for each ball."""
        return [*self.arrays.values(), self.inverse, self.body, self.material]

    def spare_of(self, array: DeviceArray) -> DeviceArray:
        """Room for a copy of an array."""
        words = int(np.prod(array.shape))
        if words not in self._spare:
            self._spare[words] = DeviceArray(self.queue, array.shape)
        return self._spare[words]

    def sort_host(self) -> None:
        """Bring the host's rows into the order of the device's."""
        if self.is_sorted_apart:
            state = self._state
            sort_rows(self._model, state, state.row[self.body.get()])
            state.listed_centre[:] = self.listed.get()
            self.is_sorted_apart = False

    def get(self) -> None:
        """Copy the rows of balls into the host's state."""
        self.sort_host()
        for name in READ:
            getattr(self._state, name)[: self.count] = self.arrays[name].get()[: self.count]

    def keep_loads(self) -> None:
        """Keep the loads of contacts as those of the last step's beginning."""
        state, arrays = self._state, self.arrays
        state.previous_contact_load[self.count :] = state.contact_load[self.count :]
        arrays["previous_contact_load"].copy_from(arrays["contact_load"])

    def motion(self) -> Sequence[Numbers]:
        """Position, velocity, orientation and angular velocity, in the order of the bodies."""
        arrays, count = self.arrays, self.count
        run(
            self.queue, self._pack, count, np.int32(count), self.body, arrays["motion"],
            arrays["orientation"], self._packed,
        )  # fmt: skip
        parts = np.split(self._packed.get(), [3 * count, 6 * count, 10 * count])
        widths = (3, 3, 4, 3)
        return [part.reshape(count, width) for part, width in zip(parts, widths, strict=True)]
