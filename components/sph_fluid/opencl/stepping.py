"""Steps of a fluid on a device: its rows, passes over pairs, a scheme in time."""

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from quintet.components.shared.opencl.devices import build
from quintet.components.shared.opencl.prelude import Precision
from quintet.components.sph_fluid.constants import pair_law
from quintet.components.sph_fluid.motion.frame import Frame
from quintet.components.sph_fluid.open_boundaries.method import NoOpenBoundaries, OpenBoundaries
from quintet.components.sph_fluid.opencl.copies import CopiesOnDevice
from quintet.components.sph_fluid.opencl.device_state import DeviceState
from quintet.components.sph_fluid.opencl.passes import Passes
from quintet.components.sph_fluid.opencl.programs import rows_program
from quintet.components.sph_fluid.opencl.schemes import scheme
from quintet.components.sph_fluid.params import SphFluidParams
from quintet.components.sph_fluid.ranks.method import Ranks
from quintet.components.sph_fluid.state import State
from quintet.components.sph_fluid.waves.no_damping import Damping, NoDamping

if TYPE_CHECKING:
    from quintet.components.sph_fluid.boundary.film_geometry import Faces, Films
    from quintet.components.sph_fluid.opencl.damping import DeviceDamping
    from quintet.components.sph_fluid.opencl.film_rows import DeviceFilmRows
    from quintet.components.sph_fluid.opencl.open_rows import DeviceFlow
    from quintet.components.sph_fluid.opencl.shepard_filter import DeviceFilter

LANES_OF_PROCESSORS = 4  # doubles in one of its vectors; other devices make lanes of rows


class Extremes(NamedTuple):
    """Greatest values over the fluid's particles, which a step returns."""

    acceleration: float  # m/s2, largest
    approach: float  # 1/s, largest
    moved: float  # m, furthest from where the lists were made
    speed: float  # m/s, with position Verlet; else 0
    failures: float  # 1 if a particle's step failed; else 0


class Stepping:
    """Steps of one fluid.

    Parameters
    ----------
    params : SphFluidParams
    queue : pyopencl.CommandQueue
    is_processor : bool
        Whether its device is a processor.
    reach : float, m
        Of the neighbour lists.
    frame : Frame
        In which the fluid is computed.
    damping : Damping
    copies : CopiesOnDevice
    open_boundaries : OpenBoundaries
        Of the host.
    """

    def __init__(
        self,
        params: SphFluidParams,
        queue: Any,
        is_processor: bool,
        reach: float,
        frame: Frame,
        damping: Damping,
        copies: CopiesOnDevice,
        open_boundaries: OpenBoundaries,
    ) -> None:
        self.params, self.queue = params, queue
        precision: Precision = "double" if params.precision == "float64" else "single"
        law, lanes = pair_law(params), LANES_OF_PROCESSORS if is_processor else 1
        damps = not isinstance(damping, NoDamping)
        kernel_sources = copies.source + open_source(open_boundaries)
        text = rows_program(law, precision, lanes, frame.forces, damps, kernel_sources)
        kernels = build(self.queue, text)
        self._of_films = kernels.film_sides, kernels.fluid_share
        behind = copies.make(self.queue, kernels)
        self.rows = DeviceState(self.queue, kernels, params, reach, is_processor, behind)
        self._open_rows = open_rows(open_boundaries, kernels, self.rows)
        parts = (self.rows, precision, frame, self._open_rows)
        self.passes = Passes(params, lanes, kernels, *parts)
        self._scheme = scheme(params, kernels, self.rows, self.passes)
        self.damping = damping_zones(damping, kernels, self.rows)
        self.filter = shepard_filter(params, kernels, self.rows)

    def step(self, state: State, dt: float, apply_forces: Callable[[], None]) -> Extremes:
        """Advance the rows by dt [s]; `state` has the length of the last step.

        `apply_forces` is called once per step, as soon as the forces of the step are known.
        """
        rows = self.rows
        self._scheme.step(dt, state.last_dt, apply_forces)
        square, approach, shift2, speed2 = rows.cells.greatest(rows.extremes, rows.split)
        acceleration, moved, speed = map(math.sqrt, (square, shift2, speed2))
        return Extremes(acceleration, float(approach), moved, speed, float(np.isinf(speed2)))

    def renew(self, state: State) -> bool:
        """Add and remove particles at inflows and outflows; return whether rows were written.

        Where there are inflows and outflows, rows near them are always written.
        """
        if self._open_rows is None:
            return False
        if self._open_rows.renew(state):
            self.passes.resize()
        return True

    def damp(self, state: State, dt: float, speed: float) -> float:
        """Damp the fluid in zones at the end of a step; return its greatest speed [m/s] then."""
        if isinstance(self.damping, NoDamping):
            return speed
        self.damping.apply(state, dt)
        # As a fluid that goes on from a snapshot finds it.
        return math.sqrt(self.rows.cells.greatest(self.rows.extremes, self.rows.split)[3])

    def make_film_rows(self, films: "Films", faces: "Faces", ranks: Ranks) -> "DeviceFilmRows":
        """Rows that films lie between."""
        # Left out of scenes without films.
        from quintet.components.sph_fluid.opencl.film_rows import DeviceFilmRows

        return DeviceFilmRows(self._of_films, self.rows, films, faces, ranks)


def shepard_filter(
    params: SphFluidParams, kernels: Any, rows: DeviceState
) -> "DeviceFilter | None":
    """A filter of the density."""
    if not params.shepard_every:
        return None
    # Left out of scenes without a filter.
    from quintet.components.sph_fluid.opencl.shepard_filter import DeviceFilter

    return DeviceFilter(params, kernels, rows)


def open_source(open_boundaries: OpenBoundaries) -> str:
    """Kernels of inflows and outflows."""
    if isinstance(open_boundaries, NoOpenBoundaries):
        return ""
    # Left out of scenes whose fluid neither comes nor goes.
    from quintet.components.sph_fluid.opencl.open_rows import SOURCE

    return SOURCE.read_text()


def open_rows(
    open_boundaries: OpenBoundaries, kernels: Any, rows: DeviceState
) -> "DeviceFlow | None":
    """Inflows and outflows."""
    if isinstance(open_boundaries, NoOpenBoundaries):
        return None
    # Left out of scenes whose fluid neither comes nor goes.
    from quintet.components.sph_fluid.open_boundaries.flow import Flow
    from quintet.components.sph_fluid.opencl.open_rows import DeviceFlow

    assert isinstance(open_boundaries, Flow)
    return DeviceFlow(open_boundaries, kernels, rows)


def damping_zones(damping: Damping, kernels: Any, rows: DeviceState) -> "NoDamping | DeviceDamping":
    """Zones in which the fluid's motion is damped."""
    if isinstance(damping, NoDamping):
        return damping
    # Left out of scenes without damping zones.
    from quintet.components.sph_fluid.opencl.damping import DeviceDamping
    from quintet.components.sph_fluid.waves.damping import DampingZones

    assert isinstance(damping, DampingZones)
    return DeviceDamping(damping, kernels, rows)
