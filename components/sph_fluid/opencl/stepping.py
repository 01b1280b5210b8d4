"""A step of a fluid on a device: walls, pairs, rows."""

import math
from typing import Any, NamedTuple

import numpy as np

from quintet.components.shared.opencl.arrays import DeviceArray, run
from quintet.components.shared.opencl.devices import Device, build
from quintet.components.shared.opencl.prelude import Precision
from quintet.components.shared.opencl.types import bytes_of
from quintet.components.shared.single_precision import rounded
from quintet.components.sph_fluid.constants import pair_law
from quintet.components.sph_fluid.integration.extrapolated import AHEAD
from quintet.components.sph_fluid.opencl.device_state import DeviceState
from quintet.components.sph_fluid.opencl.programs import pairs_program, rows_program
from quintet.components.sph_fluid.pairs.interaction import relative_wall_volume
from quintet.components.sph_fluid.params import SphFluidParams
from quintet.components.sph_fluid.state import State

LANES_OF_PROCESSORS = 4  # doubles in one of its vectors; other devices make lanes of rows


class Extremes(NamedTuple):
    """Greatest values over the fluid's particles, which a step returns."""

    acceleration: float  # m/s2, largest
    approach: float  # 1/s, largest
    moved: float  # m, furthest from where the lists were made
    failed: bool


class Stepping:
    """Steps of one fluid.

    Parameters
    ----------
    params : SphFluidParams
    device : Device
    threads : int
        Of the processor, where it is the device.
    reach : float, m
        Of the neighbour lists.
    """

    def __init__(self, params: SphFluidParams, device: Device, threads: int, reach: float) -> None:
        self.params, self.queue = params, device.queue(threads)
        self.precision: Precision = "double" if params.precision == "float64" else "single"
        law = pair_law(params)
        rows = build(self.queue, rows_program(law, self.precision))
        lanes = LANES_OF_PROCESSORS if device.is_processor else 1
        text = pairs_program(law, self.precision, lanes, relative_wall_volume(params))
        pairs = build(self.queue, text, self.precision)
        self._rates, self._advance, self._narrow = pairs.rates, rows.advance, rows.narrow
        self._extrapolate = rows.extrapolate_density
        self.rows = DeviceState(self.queue, rows, params, reach, device.is_processor)
        self._constants = bytes_of(law.constants, np.float64)
        real = np.float64 if self.precision == "double" else np.float32
        if self.precision == "single":
            # Densities are counted from that at no pressure, as `SinglePrecision` counts them.
            constants = law.constants._replace(base=law.constants.density)
            law = rounded(law._replace(constants=constants))
        self._law = tuple(bytes_of(each, real) for each in (law.constants, law.fluid, law.boundary))
        self._gravity = np.array([*params.gravity, 0.0], real)
        gravity = math.hypot(*params.hydrostatic_gravity)
        self._rest_gradient = np.float64(params.density * gravity / params.sound_speed**2)

    def resize(self) -> None:
        """Make room for a state that was copied to the device."""
        shape, real = (self.rows.count, 4), self._gravity.dtype
        self.rate = DeviceArray(self.queue, shape, real)
        if self.precision == "single":
            self._copies = [DeviceArray(self.queue, shape, real) for _ in range(2)]

    def centre(self, low: Any, high: Any) -> None:
        """Count single positions from the middle of the fluid, between two corners (3,) m."""
        self._origin = np.array([*(0.5 * (high + low)), self.params.density])

    def step(self, state: State, dt: float) -> Extremes:
        """Advance the rows by dt [s]; `state` tells of the last step."""
        rows, last = self.rows, state.last_dt
        strides = (rows.lists.row_stride, rows.lists.item_stride)
        split, count = np.int32(rows.split), np.int32(rows.count)
        if self.params.mirrored:
            run(
                self.queue, self._extrapolate, rows.count - rows.split, split, count, rows.mirror,
                rows.position, rows.velocity, rows.lists.near, rows.lists.end, *strides,
                self._rest_gradient, self._constants,
            )  # fmt: skip
        moving = np.int32(rows.split if self.params.mirrored else rows.count)
        run(
            self.queue, self._rates, int(moving), split, moving, *self._particles(),
            rows.lists.near, rows.lists.middle, rows.lists.end, *strides, *self._law,
            self._gravity, self.rate, rows.extremes,
        )  # fmt: skip
        # As integration/extrapolated.py has it.
        ahead = AHEAD * min(dt / last, 2.0) if last > 0.0 else 0.0
        numbers = map(np.float64, (dt, ahead, self.params.spacing))
        run(
            self.queue, self._advance, int(moving), split, moving, *numbers, self._constants,
            rows.position, rows.velocity, self.rate, rows.previous, rows.reference, rows.extremes,
        )  # fmt: skip
        square, approach, shift2, failed = rows.cells.greatest(rows.extremes, rows.split)
        return Extremes(math.sqrt(square), float(approach), math.sqrt(shift2), bool(failed > 0.0))

    def _particles(self) -> tuple[DeviceArray, DeviceArray]:
        """Positions and velocities in the precision of pairs."""
        rows = self.rows
        if self.precision == "double":
            return rows.position, rows.velocity
        position, velocity = self._copies
        for source, origin, copy in (
            (rows.position, self._origin, position),
            (rows.velocity, np.zeros(4), velocity),
        ):
            run(self.queue, self._narrow, rows.count, source, np.int32(rows.count), origin, copy)
        return position, velocity
