"""Devices of a component of several ranks: the one that each rank takes, and its cores of it."""

import os
import re
from typing import Any

from quintet.components.shared.opencl.devices import Device, device_of
from quintet.interfaces.component import Resources
from quintet.interfaces.errors import SceneError

NAMES = re.compile(r"opencl(?::(\d{1,4}(?:,\d{1,4})*))?")
# How many threads PoCL starts on a processor: versions to 3, later ones. Sub-devices of version 3.0
# use all of them.
THREADS_OF_POCL = ("POCL_MAX_PTHREAD_COUNT", "POCL_CPU_MAX_CU_COUNT")


def device_and_queue(resources: Resources) -> tuple[Device, Any]:
    """Return the device of a component, or of this rank of it, and a queue of commands for it.

    On several ranks it must be called before any other use of OpenCL in the process: PoCL starts
    its threads once.

    Raises
    ------
    SceneError
        As of `name_of_rank` and `device_of`.
    """
    communicator, threads = resources.communicator, resources.threads
    if communicator is None or communicator.size == 1:
        device = device_of(name_of_rank(resources.device, 0, 1))
        return device, device.queue(threads)
    name = name_of_rank(resources.device, communicator.rank, communicator.size)
    for variable in THREADS_OF_POCL:
        os.environ.setdefault(variable, str(threads))
    device = device_of(name)
    return device, device.queue(threads, _place(communicator, device.number))


def name_of_rank(name: str, rank: int, ranks: int) -> str:
    """Name of the device of a rank: of ``opencl:0,1`` rank 1 takes ``opencl:1``.

    Raises
    ------
    SceneError
        If the name has several numbers, but not one for each rank.
    """
    form = NAMES.fullmatch(name)
    if not form or not form[1]:
        return name  # a name of another form is refused where it is resolved
    numbers = form[1].split(",")
    if len(numbers) not in (1, ranks):
        raise SceneError(
            f"device {name}: it must have one number, or one for each rank; found {len(numbers)} "
            f"numbers and ranks = {ranks}. Change one of them."
        )
    return f"opencl:{numbers[rank % len(numbers)]}"


def _place(communicator: Any, number: int) -> int:
    """How many lower ranks of this host share the device of a number."""
    # Only a component of several ranks loads mpi4py.
    from mpi4py import MPI

    on_host = communicator.Split_type(MPI.COMM_TYPE_SHARED)
    numbers = on_host.allgather(number)
    place = numbers[: on_host.rank].count(number)
    on_host.Free()
    return place
