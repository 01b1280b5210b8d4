"""The states of a gas in the memory of a device, and the kernels that compute them."""

from typing import Any

import numpy as np

from quintet.components.meshless_gas.build import Domain
from quintet.components.meshless_gas.kernels.motion import STAGES
from quintet.components.meshless_gas.laws.limiters import limiter_of
from quintet.components.meshless_gas.opencl.device_cloud import DeviceCloud
from quintet.components.meshless_gas.opencl.programs import Physics, gas_program
from quintet.components.meshless_gas.params import MeshlessGasParams
from quintet.components.shared.opencl.arrays import GROUP, DeviceArray
from quintet.components.shared.opencl.devices import Device, build
from quintet.components.shared.opencl.launches import Kernel
from quintet.components.shared.opencl.tables import Tables
from quintet.interfaces.component import Array

LANES_OF_PROCESSORS = 4  # doubles in one of its vectors; other devices make lanes of rows


class DeviceState:
    """States of one gas, and what a step computes of them.

    Parameters
    ----------
    params : MeshlessGasParams
    device : Device
    queue : pyopencl.CommandQueue
    domain : Domain
        That this rank computes.
    physics : Physics
        For which the program is printed.
    """

    def __init__(
        self, params: MeshlessGasParams, device: Device, queue: Any, domain: Domain,
        physics: Physics,
    ) -> None:  # fmt: skip
        self.queue = queue
        self.tables = Tables(self.queue, device.is_processor)
        self.lanes = LANES_OF_PROCESSORS if device.is_processor else 1
        limiter = limiter_of(params.limiter, params.limiter_threshold)
        text = gas_program(limiter, physics, self.lanes, self.tables.by_rows)
        # A kernel is made once: pyopencl makes another at each look.
        kernels = build(self.queue, text).all_kernels()
        self._kernels = {kernel.function_name: Kernel(self.queue, kernel) for kernel in kernels}
        self.cloud = cloud = DeviceCloud(domain, self.tables)
        empty, whole, nodes = self.tables.empty, cloud.whole, cloud.nodes
        self.primitive = empty(whole, 5)  # kg/m3, m/s, Pa
        self.gradients = empty(whole, 15)  # of these, over m
        # kg/m3, kg/(m2 s), J/m3; residuals are these over s
        self.conservative, self.start, self.residual = (empty(nodes, 5) for _ in range(3))
        self.gradients.clear()  # covered nodes and those of other ranks have none
        # Pa, m/s, s
        self.lowest, self.sound, self.bounds = (
            DeviceArray(self.queue, (count,)) for count in (whole, whole, nodes)
        )
        self.lowest.clear()
        # m/s, of nodes; there where some move. Kernels that need it take it as one more argument.
        self.frame = [empty(whole, 3)] if params.moving is not None else []
        for frame in self.frame:
            frame.clear()
        self.wrong = DeviceArray(self.queue, (len(STAGES),), np.int32)  # see stages.cl

    def run(self, name: str, rows: int, *arguments: Any) -> None:
        """Run a kernel for so many rows; work items beyond them must return at once."""
        self._kernels[name].run(rows, *arguments)

    def has_failed(self) -> bool:
        """Whether a stage of this step has failed."""
        return bool((self.wrong.get() >= 0).any())

    def put(self, primitive: Array, conservative: Array) -> None:
        """Copy states (m, 5) of nodes and ghosts and (n, 5) of nodes; clear rates and failures."""
        self.tables.put(self.primitive, primitive)
        self.tables.put(self.conservative, conservative)
        self.tables.put(self.residual, np.zeros(self.residual.shape))
        self.wrong.put(np.full(len(STAGES), -1, np.int32))

    def get(self, primitive: Array, conservative: Array) -> None:
        """Copy the states into arrays of the host."""
        primitive[:] = self.tables.get(self.primitive)
        conservative[:] = self.tables.get(self.conservative)


def groups(rows: int) -> int:
    """How many groups of work items a kernel over so many rows has."""
    return -(-rows // GROUP)
