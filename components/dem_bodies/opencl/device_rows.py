"""The rows of balls in the memory of a device, and their motion as ports have it."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from quintet.components.dem_bodies.state import MOVED, Model, Numbers, State, Whole, sort_rows
from quintet.components.shared.opencl.arrays import DeviceArray, run
from quintet.components.shared.opencl.devices import opencl

# Arrays of `State` that a device changes; the ground, behind all balls, has them on the host.
READ = ("motion", "orientation", "contact_load", "previous_contact_load")
NO_ROWS: Whole = np.zeros(0, np.int64)


class DeviceRows:
    """Rows of balls, in the order of the host's: those of a rank, and copies of other ranks' rows.

    Behind them is the ground.

    Parameters
    ----------
    queue : pyopencl.CommandQueue
    kernels : pyopencl.Program
        Of `programs.source`.
    model, state
        Of the host; all bodies are balls.
    owned : slice
        The host's rows of this rank.
    copied : (k,) int array
        Rows of other ranks, by the host's numbers, that this rank has copies of.
    """

    def __init__(
        self, queue: Any, kernels: Any, model: Model, state: State, owned: slice,
        copied: Whole = NO_ROWS,
    ) -> None:  # fmt: skip
        self.queue, self._model, self._state = queue, model, state
        self._owned, self._copied = owned, copied
        self.count, self.copies = owned.stop - owned.start, len(copied)
        self._pack = opencl().Kernel(kernels, "pack_motion")
        self.arrays = {
            name: DeviceArray(queue, (self.count + self.copies + 1, MOVED[name]))
            for name in (*READ, "load")
        }
        self.listed = DeviceArray(queue, (self.count, 3))
        self.inverse = DeviceArray(queue, (self.count, 2))
        self.body = DeviceArray(queue, (self.count,), np.int64)
        self._spare: dict[int, DeviceArray] = {}  # buffers for sorting, by their number of words
        self.is_sorted_apart = False  # whether the host's rows have another order
        self._packed: DeviceArray | None = None
        self.plane, self._planes = DeviceArray(queue, model.plane.shape), np.zeros((0, 4))
        self.put_planes()

    def put(self) -> None:
        """Copy the host's rows to the device."""
        model, state, owned = self._model, self._state, self._owned
        for name, array in self.arrays.items():
            array.put(self._rows_of(name))
        self.listed.put(state.listed_centre[owned])
        inverses = model.inverse_mass[owned], model.inverse_moment[owned]
        self.inverse.put(np.column_stack(inverses))
        self.body.put(state.body[owned])
        self.is_sorted_apart = False

    def _rows_of(self, name: str) -> Numbers:
        """Rows of an array of the host's state: own ones, copies and the ground."""
        array: Numbers = getattr(self._state, name)
        return np.concatenate([array[self._owned], array[self._copied], array[-1:]])

    def put_planes(self) -> None:
        """Copy the planes to the device if any has vanished or come back."""
        planes = self._model.plane
        if not np.array_equal(planes, self._planes):
            self._planes = planes.copy()
            self.plane.put(planes)

    def put_loads(self) -> None:
        """Copy the loads on all balls to the device."""
        self.arrays["load"].put(self._rows_of("load"))

    def sorted_arrays(self) -> list[DeviceArray]:
        """Arrays that have a row for each ball."""
        return [*self.arrays.values(), self.inverse, self.body]

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

    def get(self, names: Sequence[str]) -> None:
        """Copy rows of some arrays of `READ` into the host's state."""
        self.sort_host()
        for name in names:
            getattr(self._state, name)[self._owned] = self.arrays[name].get(0, self.count)

    def keep_loads(self) -> None:
        """Keep the loads of contacts as those of the last step's beginning."""
        state, arrays = self._state, self.arrays
        state.previous_contact_load[-1:] = state.contact_load[-1:]
        arrays["previous_contact_load"].copy_from(arrays["contact_load"])

    def motion(self) -> Sequence[Numbers]:
        """Position, velocity, orientation and angular velocity, in the order of the bodies."""
        arrays, count = self.arrays, self.count
        if self._packed is None:
            self._packed = DeviceArray(self.queue, (13 * count,))
        run(
            self.queue, self._pack, count, np.int32(count), self.body, arrays["motion"],
            arrays["orientation"], self._packed,
        )  # fmt: skip
        parts = np.split(self._packed.get(), [3 * count, 6 * count, 10 * count])
        widths = (3, 3, 4, 3)
        return [part.reshape(count, width) for part, width in zip(parts, widths, strict=True)]
