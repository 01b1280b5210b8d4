"""The points of a lattice in the memory of a device, and the lists of their neighbours."""

from typing import Any, NamedTuple

import numpy as np

from quintet.components.particle_dynamics.kernels.forces import Pairs
from quintet.components.particle_dynamics.kernels.pair_lists import count_others, write_full_lists
from quintet.components.particle_dynamics.opencl.programs import COPY, FREE, FROZEN
from quintet.components.particle_dynamics.state import TIME, Model, State, Whole
from quintet.components.shared.opencl.arrays import DeviceArray
from quintet.interfaces.component import Array

PADDED = ("position", "velocity", "acceleration", "listed")  # with a fourth component of 0
# Arrays of `State` that have a copy on the device; the host alone changes `listed`.
ON_DEVICE = (
    "position", "velocity", "acceleration", "listed", "kinetic", "heat", "lost", "dissipated",
    "energies", "generator",
)  # fmt: skip


class FullLists(NamedTuple):
    """Neighbours of each point on a device: the k-th of point i at i row_stride + k item_stride."""

    near: DeviceArray
    first: DeviceArray  # (n,) end of the points of lower number that list this one
    second: DeviceArray  # (n,) end of the points that this one lists
    end: DeviceArray  # (n,) end of the points of higher number that list this one
    row_stride: np.int64
    item_stride: np.int64


class DevicePoints:
    """Arrays of one lattice.

    Parameters
    ----------
    queue : pyopencl.CommandQueue
    state : State
        Of the host.
    model : Model
    copies : (c,) int array
        Rows of other ranks' points.
    by_rows : bool
        Whether the neighbours of a point stand together, as processors read them.
    """

    def __init__(
        self, queue: Any, state: State, model: Model, copies: Whole, by_rows: bool
    ) -> None:
        self.queue, self.by_rows, self._host = queue, by_rows, state
        self.count = len(state.position)
        self._read = set(ON_DEVICE)  # arrays of the host's state that are as on the device
        bathed = model.bathed
        role = np.full(self.count, FREE, np.int32)
        role[bathed.point] = np.arange(len(bathed.point))
        role[model.frozen] = FROZEN
        role[copies] = COPY
        self.role, self.point = self._of(role), self._of(bathed.point.astype(np.int32))
        # Index of each bathed point among all ranks' bathed points; it selects the random numbers.
        number = np.cumsum(bathed.passed[:-1]) + np.arange(len(bathed.point))
        self.number, self.bathed = (
            self._of(number.astype(np.int32)),
            len(number) + bathed.passed.sum(),
        )
        self.rate, self.tether = self._of(bathed.rate), self._of(bathed.tether)
        self.rest, self.bonds = self._of(bathed.rest), self._of(model.bonds.astype(np.int32))
        self.temperature = self._of(state.temperature)
        is_damped = len(state.lost) > 0
        self.arrays = {name: self._of(self._on_host(name)) for name in ON_DEVICE}
        velocity = self.arrays["velocity"]
        self.predicted = DeviceArray(queue, velocity.shape) if is_damped else velocity
        self.extremes = DeviceArray(queue, (self.count, 4))
        self.extremes.clear()

    def _of(self, array: Array) -> DeviceArray:
        return DeviceArray.of(self.queue, array)

    def _on_host(self, name: str) -> Array:
        """Array of the host's state as the device has it."""
        array: Array = getattr(self._host, name)
        return np.pad(array, ((0, 0), (0, 1))) if name in PADDED else array

    def put(self, *names: str) -> None:
        """Copy arrays of the host's state to the device, by default all."""
        for name in names or ON_DEVICE:
            self.arrays[name].put(self._on_host(name))
            self._read.add(name)

    def forget(self) -> None:
        """Note that a step changed the points: the host's arrays are of an earlier time."""
        self._read.clear()

    def get(self, name: str) -> Array:
        """Array of the host's state, copied from the device unless it is there."""
        array: Array = getattr(self._host, name)
        if name in self.arrays and name not in self._read:
            first = TIME + 1 if name == "energies" else 0  # the time is the host's
            rows = self.arrays[name].get(first)
            array[first:] = rows[:, :3] if name in PADDED else rows
            self._read.add(name)
        return array

    def list_pairs(self, pairs: Pairs) -> None:
        """Make lists of all neighbours of each point from lists that have each pair once."""
        begin, neighbour = pairs
        first, others = (np.zeros(self.count, np.int64) for _ in range(2))
        count_others(begin, neighbour, first, others)
        second = first + np.diff(begin)
        end = others + np.diff(begin)
        width = max(int(end.max()), 1)
        row_stride, item_stride = (width, 1) if self.by_rows else (1, self.count)
        near = np.zeros(self.count * width, np.int32)
        write_full_lists(begin, neighbour, first, row_stride, item_stride, near)
        first_end, second_end, last_end = (
            self._of(place.astype(np.int32)) for place in (first, second, end)
        )
        strides = np.int64(row_stride), np.int64(item_stride)
        self.lists = FullLists(self._of(near), first_end, second_end, last_end, *strides)
