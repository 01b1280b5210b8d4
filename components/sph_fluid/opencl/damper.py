"""A damper of sound on a device, as `pairs/acoustic_damper.py`; only for a scene that asks."""

from typing import Any

import numpy as np

from quintet.components.shared.opencl.arrays import run
from quintet.components.shared.opencl.types import bytes_of
from quintet.components.sph_fluid.constants import constants
from quintet.components.sph_fluid.opencl.device_state import DeviceState
from quintet.components.sph_fluid.params import SphFluidParams


class DeviceDamper:
    """The damper of the fluid, and of its boundary."""

    def __init__(self, params: SphFluidParams, kernels: Any, rows: DeviceState) -> None:
        self.rows, self._constants = rows, bytes_of(constants(params), np.float64)
        self._damp, self._mirror = kernels.damp_pressure, kernels.mirror_damping
        sound = params.sound_speed * params.smoothing_length
        self._strength = np.float64(params.acoustic_damper * sound)

    def write_pressure(self, moving: int) -> None:
        """Write p/ρ² with the damper's part, of rows that obey the equation of continuity."""
        rows, lists = self.rows, self.rows.lists
        run(
            rows.queue, self._damp, moving, np.int32(moving), self._strength,
            rows.arrays["minus_rho_div_u"], rows.position, rows.velocity, self._constants,
        )  # fmt: skip
        if rows.mirrored:
            rows.copies.write(rows.position, rows.velocity)
            numbers = map(np.int32, (rows.split, rows.count))
            run(
                rows.queue, self._mirror, rows.count - rows.split, *numbers, rows.mirror,
                rows.numbers, rows.position, rows.velocity, lists.near, lists.end, lists.row_stride,
                lists.item_stride, self._constants,
            )  # fmt: skip
