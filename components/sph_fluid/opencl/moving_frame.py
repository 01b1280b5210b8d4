"""The frame of a moving tank on a device; imported only by a scene that asks for one.

Its clock, its forces and its work are those of `motion/moving_frame.py`, on the host.
"""

from typing import Any

import numpy as np

from quintet.components.shared.opencl.arrays import DeviceArray, run
from quintet.components.shared.opencl.types import bytes_of
from quintet.components.sph_fluid.motion.moving_frame import MovingFrame
from quintet.components.sph_fluid.opencl.device_state import DeviceState


class DeviceFrame:
    """Accelerations of the frame of one fluid."""

    def __init__(self, frame: MovingFrame, kernels: Any, rows: DeviceState) -> None:
        self.frame, self.rows, self._accelerate = frame, rows, kernels.accelerate

    def resize(self) -> None:
        """Make room for a state that was copied to the device."""
        self._power = DeviceArray(self.rows.queue, (self.rows.split,))

    def accelerate(self, rate: DeviceArray) -> None:
        """Add the frame's own accelerations to the rates (n, 4)."""
        rows, forces = self.rows, bytes_of(self.frame.forces, np.float64)
        places = (rows.position, rows.velocity, rate, self._power, rows.extremes)
        run(rows.queue, self._accelerate, rows.split, np.int32(rows.split), forces, *places)

    def read_power(self) -> None:
        """Let the frame count the work of the forces of the last pass."""
        self.frame.power = self._power.get()
