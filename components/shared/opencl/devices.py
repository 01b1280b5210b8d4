"""OpenCL devices of this machine, by the names that scenes give them.

pyopencl is loaded where a device is first asked for, and by nothing else.
"""

import importlib
import re
import time
import warnings
from dataclasses import dataclass
from typing import Any

import numpy as np

from quintet.components.shared.opencl.prelude import Precision
from quintet.interfaces.errors import SceneError
from quintet.interfaces.libraries import is_installed, require

NO_DEVICE = (
    "no OpenCL device was found. Install the driver of your device (its .icd file belongs into "
    "/etc/OpenCL/vendors), or PoCL, which computes on the processor: pip install 'quintet[opencl]'."
)
NAME = re.compile(r"opencl(?::(\d{1,4}))?")
COPIED = 1 << 26  # floats in the test of bandwidth, 268 MB; fewer where memory is short
ROUNDS = 5
COPY = """
__kernel void copy(__global const float *from, __global float *to) {
    const size_t i = get_global_id(0);
    to[i] = from[i];
}
"""


def opencl() -> Any:
    """Load pyopencl, or raise a `SceneError` that says how to install it."""
    require("pyopencl", "an OpenCL device")
    return importlib.import_module("pyopencl")


@dataclass(frozen=True, slots=True)
class Device:
    """One OpenCL device.

    Parameters
    ----------
    number : int
        In ``opencl:number``.
    handle : pyopencl.Device
    """

    number: int
    handle: Any

    @property
    def name(self) -> str:
        """Name of the device, and of its platform with the version, as the driver states them."""
        platform = self.handle.platform
        return f"{self.handle.name.strip()} ({platform.name.strip()}, {platform.version.strip()})"

    @property
    def memory(self) -> int:
        """Its memory [bytes]."""
        return int(self.handle.global_mem_size)

    @property
    def units(self) -> int:
        """Compute units, of a processor its cores."""
        return int(self.handle.max_compute_units)

    @property
    def has_doubles(self) -> bool:
        """Whether it computes in double precision."""
        return "cl_khr_fp64" in self.handle.extensions.split()

    @property
    def is_processor(self) -> bool:
        """Whether it is the processor that this program runs on."""
        return bool(self.handle.type & opencl().device_type.CPU)

    def queue(self, threads: int = 0, place: int = 0) -> Any:
        """Make a queue of commands, in a context of its own.

        `threads` is how many cores of a processor it may use; 0: all. The processor is divided into
        parts of so many cores, of which it takes that of a number, `place`, modulo their number.
        Other devices are used whole.
        """
        cl, handle = opencl(), self.handle
        if threads and self.is_processor and threads < self.units:
            parts = self.units // threads
            partition = cl.device_partition_property
            counts = [partition.BY_COUNTS, *[threads] * parts, partition.BY_COUNTS_LIST_END]
            handle = handle.create_sub_devices(counts)[place % parts]
        return cl.CommandQueue(cl.Context([handle]))


def devices() -> list[Device]:
    """All devices, processors last, in the order of their platforms; none without a platform."""
    cl = opencl()
    try:
        platforms = cl.get_platforms()
    except cl.LogicError:  # the loader knows no driver
        return []
    handles = [handle for platform in platforms for handle in platform.get_devices()]
    handles.sort(key=lambda handle: bool(handle.type & cl.device_type.CPU))
    return [Device(number, handle) for number, handle in enumerate(handles)]


def is_any_there() -> bool:
    """Whether this machine has pyopencl, and its first device double precision."""
    return is_installed("pyopencl") and any(device.has_doubles for device in devices()[:1])


def is_accelerator_there() -> bool:
    """Whether the first device has double precision, and is not the processor."""
    return is_any_there() and not devices()[0].is_processor


def device_of(name: str) -> Device:
    """Return the device that a scene names, ``opencl`` or ``opencl:number``.

    Raises
    ------
    SceneError
        If the name has another form, pyopencl is not installed, or there is no such device.
    """
    form = NAME.fullmatch(name)
    if not form:
        raise SceneError(
            f"device must be cpu, opencl, or opencl:0 and so on; found {name!r}. "
            "`quintet devices` lists the devices of this machine."
        )
    number, all_devices = int(form[1] or 0), devices()
    if not all_devices:
        raise SceneError(f"device {name}: {NO_DEVICE}")
    if number >= len(all_devices):
        raise SceneError(
            f"device {name}: there must be one of this number; found {len(all_devices)}, "
            "from opencl:0 on. `quintet devices` lists them."
        )
    return all_devices[number]


def require_doubles(device: Device, name: str) -> None:
    """Refuse a device, which a scene names so, that does not compute in double precision."""
    if not device.has_doubles:
        raise SceneError(
            f"device {name}: it must compute in double precision, in which states are kept; "
            f"{device.name} does not. Choose another of those that `quintet devices` lists."
        )


def build(queue: Any, text: str, precision: Precision = "double") -> Any:
    """Compile a program for the device of a queue; quotients and roots are rounded correctly."""
    cl, (device,) = opencl(), queue.context.devices
    options = ["-cl-std=CL1.2"]
    exact = cl.device_fp_config.CORRECTLY_ROUNDED_DIVIDE_SQRT
    if precision == "single" and device.single_fp_config & exact:
        options.append("-cl-fp32-correctly-rounded-divide-sqrt")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", cl.CompilerWarning)  # drivers tell that they compiled
        return cl.Program(queue.context, text).build(options)


def bandwidth(device: Device) -> float:
    """Bytes that a device reads and writes per second [1/s], copying: the best of some rounds."""
    cl, queue = opencl(), device.queue()
    count = min(COPIED, device.memory // 16, int(device.handle.max_mem_alloc_size) // 4)
    flags = cl.mem_flags.READ_WRITE
    source, target = (cl.Buffer(queue.context, flags, size=4 * count) for _ in range(2))
    zero = np.zeros(1, np.float32)
    for buffer in (source, target):  # memory is there once it was written
        cl.enqueue_fill_buffer(queue, buffer, zero, 0, 4 * count)
    kernel, best = build(queue, COPY).copy, 0.0
    queue.finish()
    for _ in range(ROUNDS):
        start = time.perf_counter()
        kernel(queue, (count,), None, source, target)
        queue.finish()
        best = max(best, 8 * count / (time.perf_counter() - start))
    return best
