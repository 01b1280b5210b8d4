"""Damping zones on a device; imported only by a scene that has some."""

from typing import Any

import numpy as np

from quintet.components.shared.opencl.arrays import DeviceArray, run
from quintet.components.sph_fluid.opencl.device_state import DeviceState
from quintet.components.sph_fluid.state import State
from quintet.components.sph_fluid.waves.damping import DampingZones


class DeviceDamping:
    """The zones of one fluid, whose work is counted on the host."""

    def __init__(self, zones: DampingZones, kernels: Any, rows: DeviceState) -> None:
        self.zones, self.rows, self._damp = zones, rows, kernels.damp

    def apply(self, state: State, dt: float) -> None:
        """Damp velocities at the end of a step [s]."""
        rows = self.rows
        speed2_loss = DeviceArray.of(rows.queue, np.zeros(rows.split))
        for zone in self.zones.zones:
            low, high = np.full(4, -np.inf), np.full(4, np.inf)
            for axis in self.zones.axes:
                low[axis], high[axis] = zone.bounds[0][axis], zone.bounds[1][axis]
            side = np.int32("xyz".index(zone.towards[0])), np.int32(zone.towards[1] == "-")
            numbers = (*side, np.float64(zone.rate), np.float64(dt))
            run(
                rows.queue, self._damp, rows.split, np.int32(rows.split), low, high, *numbers,
                rows.role, rows.position, rows.velocity, speed2_loss, rows.extremes,
            )  # fmt: skip
        self.zones.count_work(state, speed2_loss.get())
