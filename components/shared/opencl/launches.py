"""Kernels that run repeatedly with nearly the same arguments."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from quintet.components.shared.opencl.arrays import GROUP, DeviceArray, run
from quintet.components.shared.opencl.devices import opencl


class Launch:
    """A kernel that keeps its last arguments: setting one takes as long as computing many rows.

    Parameters
    ----------
    queue : pyopencl.CommandQueue
    kernel : pyopencl.Kernel
        Used here alone.
    rows : int
        Work items beyond them must return at once.
    *fixed : DeviceArray, number or array of one struct
        Its last arguments, the same in each run until `fix` replaces them.
    """

    def __init__(self, queue: Any, kernel: Any, rows: int, *fixed: Any) -> None:
        self._queue, self._kernel, self._rows = queue, kernel, rows
        self._items, self._enqueue = -(-rows // GROUP) * GROUP, opencl().enqueue_nd_range_kernel
        self.fix(*fixed)

    def fix(self, *fixed: Any) -> None:
        """Replace the last arguments."""
        self._fixed = fixed
        self._last: list[bytes] | None = None  # the first arguments of the last run

    def run(self, *varying: np.generic | NDArray[Any]) -> None:
        """Run the kernel; its first arguments are numbers, vectors and structs."""
        values = [argument.tobytes() for argument in varying]
        if self._last is None:
            run(self._queue, self._kernel, self._rows, *varying, *self._fixed)
        elif self._rows:
            for place, argument in enumerate(varying):
                if values[place] != self._last[place]:
                    self._kernel.set_arg(place, argument)
            self._enqueue(self._queue, self._kernel, (self._items,), (GROUP,))
        self._last = values


class Kernel:
    """A kernel of which all arguments, and the number of rows, may change from run to run.

    Parameters
    ----------
    queue : pyopencl.CommandQueue
    kernel : pyopencl.Kernel
        Used here alone.
    """

    def __init__(self, queue: Any, kernel: Any) -> None:
        self._queue, self._kernel = queue, kernel
        self._enqueue = opencl().enqueue_nd_range_kernel
        self._last: list[Any] = []  # arguments of the last run: memory, or bytes of numbers

    def run(self, rows: int, *arguments: Any) -> None:
        """Run the kernel for so many rows; set those of its arguments that have changed."""
        if not rows:
            return
        values = [
            argument.memory if isinstance(argument, DeviceArray) else argument.tobytes()
            for argument in arguments
        ]
        if not self._last:
            run(self._queue, self._kernel, rows, *arguments)
        else:
            for place, (value, last) in enumerate(zip(values, self._last, strict=True)):
                if value != last:
                    is_number = isinstance(value, bytes)
                    self._kernel.set_arg(place, arguments[place] if is_number else value)
            self._enqueue(self._queue, self._kernel, (-(-rows // GROUP) * GROUP,), (GROUP,))
        self._last = values
