"""Arrays in the memory of a device, and runs of kernels over rows of them."""

from typing import Any

import numpy as np
from numpy.typing import DTypeLike, NDArray

from quintet.components.shared.opencl.devices import opencl
from quintet.interfaces.errors import SceneError, StepError

GROUP = 64  # work items that a device runs together
CHOICES = (
    "Choose fewer or larger items (a larger spacing, fewer spheres), another device, or "
    'device = "cpu".'
)


class DeviceArray:
    """An array (n, ...) in a device's memory.

    Parameters
    ----------
    queue : pyopencl.CommandQueue
    shape : tuple of int
    dtype : numpy dtype
    """

    def __init__(self, queue: Any, shape: tuple[int, ...], dtype: DTypeLike = np.float64) -> None:
        self.queue, self.shape, self.dtype = queue, shape, np.dtype(dtype)
        cl = opencl()
        size = max(int(np.prod(shape)) * self.dtype.itemsize, self.dtype.itemsize)
        largest = int(queue.device.max_mem_alloc_size)
        if size > largest:
            raise SceneError(too_large(queue.device, size, largest))
        try:
            self.memory = cl.Buffer(queue.context, cl.mem_flags.READ_WRITE, size=size)
        except (cl.MemoryError, cl.RuntimeError) as error:
            raise SceneError(too_large(queue.device, size, largest)) from error

    @classmethod
    def of(cls, queue: Any, array: NDArray[Any]) -> "DeviceArray":
        """Copy an array to the device."""
        copy = cls(queue, array.shape, array.dtype)
        copy.put(array)
        return copy

    @property
    def row_size(self) -> int:
        """Bytes of a row."""
        return int(np.prod(self.shape[1:])) * self.dtype.itemsize

    def put(self, array: NDArray[Any], first: int = 0) -> None:
        """Write an array into as many rows, from row `first` on."""
        if array.size:
            contiguous, offset = np.ascontiguousarray(array, self.dtype), first * self.row_size
            opencl().enqueue_copy(
                self.queue, self.memory, contiguous, dst_offset=offset, is_blocking=True
            )

    def copy_from(self, source: "DeviceArray", start: int = 0, first: int = 0) -> None:
        """Copy the rows of an array from row `start` on to rows from `first` on, on the device."""
        width = source.row_size
        size = (source.shape[0] - start) * width
        if size:
            offsets = {"src_offset": start * width, "dst_offset": first * width}
            opencl().enqueue_copy(
                self.queue, self.memory, source.memory, byte_count=size, **offsets
            )

    def copy_first(self, rows: int, source: "DeviceArray") -> None:
        """Copy so many rows of an array whose rows are as long, on the device."""
        size = rows * int(np.prod(self.shape[1:])) * self.dtype.itemsize
        if size:
            opencl().enqueue_copy(self.queue, self.memory, source.memory, byte_count=size)

    def clear(self) -> None:
        """Write 0 everywhere."""
        size = int(np.prod(self.shape)) * self.dtype.itemsize
        if size:
            zero = np.zeros(1, self.dtype)
            opencl().enqueue_fill_buffer(self.queue, self.memory, zero, 0, size)

    def get(self, first: int = 0, end: int | None = None) -> NDArray[Any]:
        """Read the rows of the array from row `first` on, to before row `end` if it is given."""
        count = (self.shape[0] if end is None else end) - first
        array: NDArray[Any] = np.empty((count, *self.shape[1:]), self.dtype)
        if array.size:
            opencl().enqueue_copy(
                self.queue, array, self.memory, src_offset=first * self.row_size, is_blocking=True
            )
        return array


def too_large(device: Any, size: int, largest: int) -> str:
    """Sentence about an array of so many bytes, of which a device has no room."""
    return (
        f"device {device.name.strip()}: an array must have at most {largest} bytes, and all of "
        f"them {device.global_mem_size}; found one of {size} bytes that has no room. {CHOICES}"
    )


def run(queue: Any, kernel: Any, rows: int, *arguments: Any) -> None:
    """Run a kernel for at least so many rows; it must pass over those beyond them."""
    if rows:
        items = -(-rows // GROUP) * GROUP
        try:
            kernel(queue, (items,), (GROUP,), *(_plain(argument) for argument in arguments))
        except opencl().MemoryError as error:  # drivers may make room when it is first used
            sizes = (
                argument.memory.size for argument in arguments if isinstance(argument, DeviceArray)
            )
            raise StepError(
                f"device {queue.device.name.strip()}: what it computes with must fit into its "
                f"memory of {queue.device.global_mem_size} bytes; found no room for "
                f"{sum(sizes)} bytes beside the rest. {CHOICES}"
            ) from error


def _plain(argument: Any) -> Any:
    return argument.memory if isinstance(argument, DeviceArray) else argument
