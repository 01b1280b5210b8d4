"""Passes over the pairs of a fluid on a device, and what walls and samples have before them."""

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from quintet.components.shared.opencl.arrays import DeviceArray, run
from quintet.components.shared.opencl.devices import build
from quintet.components.shared.opencl.prelude import Precision
from quintet.components.shared.opencl.types import bytes_of
from quintet.components.shared.single_precision import rounded
from quintet.components.sph_fluid.boundary.method import BoundaryMethod
from quintet.components.sph_fluid.constants import pair_law
from quintet.components.sph_fluid.laws import ContactPotential, PairLaw
from quintet.components.sph_fluid.motion.frame import Frame, StillFrame
from quintet.components.sph_fluid.opencl.device_state import DeviceState
from quintet.components.sph_fluid.opencl.programs import pairs_program
from quintet.components.sph_fluid.params import SphFluidParams
from quintet.components.sph_fluid.state import Array

if TYPE_CHECKING:
    from quintet.components.sph_fluid.opencl.damper import DeviceDamper
    from quintet.components.sph_fluid.opencl.moving_frame import DeviceFrame
    from quintet.components.sph_fluid.opencl.open_rows import DeviceFlow


class Passes:
    """Passes over the pairs of one fluid.

    Parameters
    ----------
    params : SphFluidParams
    lanes : int
        Neighbours that are summed at once.
    kernels : pyopencl.Program
        Of `programs.rows_program`.
    rows : DeviceState
    precision : "double" or "single"
        Of pairs.
    frame : Frame
    open_rows : DeviceFlow or None
        Of inflows and outflows.
    """

    def __init__(
        self, params: SphFluidParams, lanes: int, kernels: Any, rows: DeviceState,
        precision: Precision, frame: Frame, open_rows: "DeviceFlow | None" = None,
    ) -> None:  # fmt: skip
        self.params, self.rows, self.precision, self.frame = params, rows, precision, frame
        self.queue, self.lanes = rows.queue, lanes
        self._extrapolate, self._narrow = kernels.extrapolate_density, kernels.narrow
        self._mirror_velocity = kernels.mirror_velocity
        rubs = params.viscosity.kinematic > 0.0 and params.boundary.wall_viscosity_factor > 0.0
        self._has_apparent = params.mirrored and rubs
        self._apparent: DeviceArray | None = None
        self._drift: DeviceArray | None = None
        self._move_by, self._drifts = kernels.move_by, params.xsph > 0.0
        self._damper = damper(params, kernels, rows)
        self._moving_frame, self._open_rows = moving_frame(frame, kernels, rows), open_rows
        self._real = np.float64 if precision == "double" else np.float32
        self._constants = bytes_of(pair_law(params).constants, np.float64)
        self._gravity = np.array([*params.gravity, 0.0], self._real)
        # Contact potential and whether rows have volumes, for which the sums were compiled; the
        # first lists say which.
        self._built_for: tuple[ContactPotential, bool] | None = None

    def _build(self, contact: ContactPotential, own_volume: bool) -> None:
        """Compile the sums over pairs, with or without volumes of boundary particles."""
        law = pair_law(self.params, contact, own_volume or None)
        text = pairs_program(law, self.precision, self.lanes, self._has_apparent)
        program = build(self.queue, text, self.precision)
        self._rates, self._sample_forces = program.rates, program.sample_forces
        self._built_for = contact, own_volume
        if self.precision == "single":
            # Densities are counted from that at no pressure, as `SinglePrecision` counts them.
            constants = law.constants._replace(base=law.constants.density)
            law = rounded(law._replace(constants=constants))
        self._law, self._structs = law, self._structs_of(law)

    def _structs_of(self, law: PairLaw) -> tuple[Any, ...]:
        """Numbers of a pair law as structs: constants, terms of the fluid and the boundary."""
        terms = (law.constants, law.fluid, law.boundary)
        return tuple(bytes_of(term, self._real) for term in terms)

    def resize(self) -> None:
        """Make room for a state that was copied to the device."""
        copies = self.rows.copies.count
        shape, with_copies = (self.rows.count, 4), (self.rows.count + copies, 4)
        self.rate = DeviceArray(self.queue, shape, self._real)
        self.force = DeviceArray(self.queue, (self.rows.samples, 4))
        if self._has_apparent:
            # Lanes behind the end of a list read rows of the fluid: they must be finite.
            self._apparent = DeviceArray.of(self.queue, np.zeros(with_copies, self._real))
        if self._moving_frame:
            self._moving_frame.resize()
        if self._drifts:
            self._drift = DeviceArray(self.queue, (self.rows.split, 3))
        if self.precision == "single":
            self._narrowed = [DeviceArray(self.queue, with_copies, self._real) for _ in range(2)]

    def follow(self, volume: Array, boundary: BoundaryMethod) -> None:
        """Follow new lists, with volumes (n,) of all rows, (0,) if all are alike.

        They are over that of a particle of the fluid; `boundary` is that of the host.
        """
        arrays = (volume.astype(self._real), boundary.mask.astype(self._real))
        self._volume, self._mask = (DeviceArray.of(self.queue, array) for array in arrays)
        needed = boundary.contact, bool(len(volume))
        if needed != self._built_for:
            self._build(*needed)

    def centre(self, low: Any, high: Any) -> None:
        """Count single positions from the middle of the fluid, between two corners (3,) m."""
        self._origin = np.array([*(0.5 * (high + low)), self.params.density])

    @property
    def moving(self) -> int:
        """Rows whose density obeys the equation of continuity, from the first on."""
        is_dynamic = self.params.boundary.method == "dbc"
        return self.rows.count if is_dynamic else self.rows.split

    def compute(self, later: float) -> None:
        """Write accelerations and rates of density, of the state as it is.

        Outer forces are those at a time [s] after the begin of the step.
        """
        self.frame.set_time(later)
        self._write_boundary()
        self.rows.copies.write(self.rows.position, self.rows.velocity)
        rows, lists, law = self.rows, self.rows.lists, self.frame.law(self._law)
        structs = self._structs if law is self._law else self._structs_of(law)
        self._particles = self._in_precision()
        run(
            self.queue, self._rates, self.moving, np.int32(rows.split), np.int32(self.moving),
            *self._particles, lists.near, lists.middle, lists.end, lists.row_stride,
            lists.item_stride, *structs, self._gravity, self._volume, self._mask, self._apparent,
            self.rate, self._drift, rows.arrays["minus_rho_div_u"], rows.extremes,
        )  # fmt: skip
        if self._moving_frame:
            self._moving_frame.accelerate(self.rate)
        if self._open_rows:
            self._open_rows.hold(self.rate, self._drift)

    def _write_boundary(self) -> None:
        """Write pressures, and velocities that viscosity sees, before a pass over pairs."""
        rows, lists = self.rows, self.rows.lists
        strides = (lists.row_stride, lists.item_stride)
        split, count = np.int32(rows.split), np.int32(rows.count)
        if self.params.mirrored:
            rows.copies.write(rows.position, rows.velocity)
            gravity = math.hypot(*self.frame.rest_acceleration)
            rest_gradient = self.params.density * gravity / self.params.sound_speed**2
            run(
                self.queue, self._extrapolate, rows.count - rows.split, split, count, rows.mirror,
                rows.numbers, rows.position, rows.velocity, lists.near, lists.end, *strides,
                np.float64(rest_gradient), self._constants,
            )  # fmt: skip
        if self._damper:
            self._damper.write_pressure(self.moving)
        if self._has_apparent:
            run(
                self.queue, self._mirror_velocity, rows.count - rows.split, split, count,
                rows.mirror, rows.position, rows.velocity, lists.near, lists.end, *strides,
                self._constants, self._apparent,
            )  # fmt: skip
            assert self._apparent is not None
            rows.copies.write_apparent(self._apparent)

    def push_samples(self) -> Array:
        """Forces (samples, 3) N on samples: minus those of the last pass on the fluid."""
        rows, lists = self.rows, self.rows.lists
        constants, _, boundary = self._structs
        numbers = (np.int32(rows.samples), rows.row, np.int32(rows.first_listed))
        run(
            self.queue, self._sample_forces, rows.samples, *numbers, *self._particles,
            lists.near, lists.end, lists.row_stride, lists.item_stride, constants, boundary,
            self._volume, self._mask, self._apparent, self.force,
        )  # fmt: skip
        return np.asarray(self.force.get()[:, :3])

    def read_power(self) -> None:
        """Let a frame that moves count its work in the last pass."""
        if self._moving_frame:
            self._moving_frame.read_power()

    def move_with_neighbours(self, dt: float) -> None:
        """XSPH: move with the neighbours' mean velocity in a step of dt [s]."""
        if self._drifts:
            split, time = self.rows.split, np.float64(self.params.xsph * dt)
            position = self.rows.position
            run(self.queue, self._move_by, split, np.int32(split), time, self._drift, position)

    def _in_precision(self) -> tuple[DeviceArray, DeviceArray]:
        """Positions and velocities in the precision of pairs."""
        rows = self.rows
        if self.precision == "double":
            return rows.position, rows.velocity
        position, velocity = self._narrowed
        count = rows.count + rows.copies.count
        for source, origin, narrowed in (
            (rows.position, self._origin, position),
            (rows.velocity, np.zeros(4), velocity),
        ):
            run(self.queue, self._narrow, count, source, np.int32(count), origin, narrowed)
        return position, velocity


def damper(params: SphFluidParams, kernels: Any, rows: DeviceState) -> "DeviceDamper | None":
    """A damper of sound."""
    if params.acoustic_damper == 0.0:
        return None
    # Left out of scenes without a damper.
    from quintet.components.sph_fluid.opencl.damper import DeviceDamper

    return DeviceDamper(params, kernels, rows)


def moving_frame(frame: Frame, kernels: Any, rows: DeviceState) -> "DeviceFrame | None":
    """The frame of a tank that moves."""
    if isinstance(frame, StillFrame):
        return None
    # Left out of scenes whose tank stands still.
    from quintet.components.sph_fluid.motion.moving_frame import MovingFrame
    from quintet.components.sph_fluid.opencl.moving_frame import DeviceFrame

    assert isinstance(frame, MovingFrame)
    return DeviceFrame(frame, kernels, rows)
