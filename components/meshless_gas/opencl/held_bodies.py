"""Walls of bodies that hold the gas, on a device; only for scenes with friction."""

import numpy as np

from quintet.components.meshless_gas.moving.no_slip import NoSlipBodies
from quintet.components.meshless_gas.opencl.device_cloud import INDEX
from quintet.components.meshless_gas.opencl.device_state import DeviceState
from quintet.components.shared.opencl.arrays import DeviceArray


class HeldWalls:
    """Walls of bodies that hold the gas.

    Parameters
    ----------
    friction : NoSlipBodies
        Friction of the host's bodies.
    state : DeviceState
    """

    def __init__(self, friction: NoSlipBodies, state: DeviceState) -> None:
        self.numbers = DeviceArray.of(state.queue, friction.held.astype(INDEX))
        self.temperature = DeviceArray.of(state.queue, friction.temperature)
        self.gas_constant = np.float64(friction.law.gas_constant)
