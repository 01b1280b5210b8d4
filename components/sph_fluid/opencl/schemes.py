"""Schemes in time of a fluid on a device, as those of `integration/`."""

from collections.abc import Callable
from typing import Any, Protocol

import numpy as np

from quintet.components.shared.opencl.arrays import run
from quintet.components.shared.opencl.types import bytes_of
from quintet.components.sph_fluid.constants import constants
from quintet.components.sph_fluid.integration.extrapolated import AHEAD
from quintet.components.sph_fluid.opencl.device_state import DeviceState
from quintet.components.sph_fluid.opencl.passes import Passes
from quintet.components.sph_fluid.params import SphFluidParams


class Scheme(Protocol):
    """Steps in time of the rows of a device."""

    def step(self, dt: float, last: float, apply_forces: Callable[[], None]) -> None:
        """Advance the rows by dt [s], after a step of `last` [s]; write `extremes`."""


def scheme(params: SphFluidParams, kernels: Any, rows: DeviceState, passes: Passes) -> Scheme:
    """Scheme that a scene asks for; kernels are those of `steps.cl`."""
    scheme_class = (
        DevicePositionVerlet if params.integration == "symplectic" else DeviceExtrapolated
    )
    return scheme_class(params, kernels, rows, passes)


class DeviceExtrapolated:
    """One pass over pairs in a step: see `integration/extrapolated.py`."""

    def __init__(
        self, params: SphFluidParams, kernels: Any, rows: DeviceState, passes: Passes
    ) -> None:
        self.rows, self.passes, self.furthest = rows, passes, params.spacing
        self._constants, self._advance = bytes_of(constants(params), np.float64), kernels.advance

    def step(self, dt: float, last: float, apply_forces: Callable[[], None]) -> None:
        """Advance the rows by a step."""
        rows, passes = self.rows, self.passes
        passes.compute(0.5 * dt)
        apply_forces()
        ahead = AHEAD * min(dt / last, 2.0) if last > 0.0 else 0.0
        numbers = map(np.float64, (dt, ahead, self.furthest))
        run(
            rows.queue, self._advance, passes.moving, np.int32(rows.split),
            np.int32(passes.moving), *numbers, self._constants, rows.position, rows.velocity,
            passes.rate, rows.arrays["previous_density_rate"], rows.reference, rows.extremes,
        )  # fmt: skip


class DevicePositionVerlet:
    """Two passes over pairs in a step: see `integration/position_verlet.py`."""

    def __init__(
        self, params: SphFluidParams, kernels: Any, rows: DeviceState, passes: Passes
    ) -> None:
        self.rows, self.passes, self.furthest = rows, passes, np.float64(params.spacing)
        self._constants = bytes_of(constants(params), np.float64)
        self._begin, self._half_step = kernels.begin, kernels.half_step
        self._kick, self._finish = kernels.kick, kernels.finish

    def step(self, dt: float, last: float, apply_forces: Callable[[], None]) -> None:
        """Advance the rows by a step."""
        rows, passes, moving, duration = self.rows, self.passes, self.passes.moving, np.float64(dt)
        queue, split, count = rows.queue, np.int32(rows.split), np.int32(moving)
        places = rows.position, rows.velocity
        previous = rows.arrays["previous_density_rate"]
        if rows.make_acceleration():
            passes.compute(0.0)
            acceleration = rows.arrays["acceleration"]
            run(queue, self._begin, moving, split, count, passes.rate, previous, acceleration)
        acceleration = rows.arrays["acceleration"]
        numbers = (split, count, duration)
        rates = (*places, passes.rate)
        run(
            queue, self._half_step, moving, *numbers, self._constants, *places, previous,
            acceleration,
        )  # fmt: skip
        passes.compute(0.5 * dt)
        apply_forces()
        run(queue, self._kick, rows.split, split, duration, *rates, acceleration)
        passes.compute(dt)
        run(
            queue, self._finish, moving, *numbers, self.furthest, self._constants, *rates,
            previous, acceleration, rows.reference, rows.extremes,
        )  # fmt: skip
