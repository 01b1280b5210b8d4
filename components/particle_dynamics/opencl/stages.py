"""Stages of the steps of a lattice on a device, as `kernels/motion.py` has them."""

from functools import partial
from typing import Any

import numpy as np

from quintet.components.particle_dynamics.kernels.motion import DRAWN
from quintet.components.particle_dynamics.laws import prescribed_motion
from quintet.components.particle_dynamics.opencl.device_points import DevicePoints
from quintet.components.particle_dynamics.opencl.other_ranks import OtherRanks
from quintet.components.particle_dynamics.opencl.programs import pair_terms
from quintet.components.particle_dynamics.ranks.terms import Terms
from quintet.components.particle_dynamics.state import Model
from quintet.components.shared.opencl.arrays import GROUP
from quintet.components.shared.opencl.devices import opencl
from quintet.components.shared.opencl.launches import Launch
from quintet.components.shared.opencl.types import bytes_of


class Stages:
    """Stages of one lattice.

    Parameters
    ----------
    kernels : pyopencl.Program
        Of `programs.lattice_program`.
    points : DevicePoints
    model : Model
    terms : Terms
    other_ranks : OtherRanks
        From which it gets copies.
    """

    def __init__(
        self,
        kernels: Any,
        points: DevicePoints,
        model: Model,
        terms: Terms,
        other_ranks: OtherRanks,
    ) -> None:
        self._model, arrays, queue = model, points.arrays, points.queue
        self._other_ranks, kernel = other_ranks, partial(opencl().Kernel, kernels)
        self._is_driven = model.driven.first >= 0
        count, mass = np.int32(points.count), np.float64(model.mass)
        driven, laws = (
            bytes_of(struct, np.float64) for struct in (model.driven, pair_terms(terms, model))
        )
        places = (arrays["position"], arrays["velocity"], arrays["acceleration"])
        powers, measured = (
            (arrays["lost"], arrays["dissipated"]),
            (arrays["kinetic"], points.extremes),
        )
        self._open = Launch(
            queue, kernel("open_stage"), points.count, count, driven, *places, points.predicted,
            *powers, arrays["energies"],
        )  # fmt: skip
        self._place = Launch(
            queue, kernel("place"), points.count, count, driven, *places, points.predicted
        )
        self._close = Launch(queue, kernel("close_stage"), points.count)
        self._closed = (
            mass, count, driven, laws, points.role, points.tether, points.rest, arrays["listed"],
            arrays["position"], points.predicted, arrays["velocity"], arrays["acceleration"],
            *powers, *measured,
        )  # fmt: skip
        self._close_drive = Launch(
            queue, kernel("close_drive"), GROUP, mass, driven, arrays["listed"], *places,
            arrays["energies"], *measured,
        )  # fmt: skip
        if model.is_random:
            self._add_random(kernel, points, terms.boltzmann)

    def _add_random(self, kernel: Any, points: DevicePoints, boltzmann: float) -> None:
        """Add baths and collisions."""
        model, arrays, bathed = self._model, points.arrays, len(self._model.bathed.point)
        numbers = map(np.float64, (model.mass, boltzmann))
        self._exchange = Launch(
            points.queue, kernel("exchange"), bathed, np.int32(bathed), *numbers, np.int32(DRAWN),
            points.number, points.point, points.rate, points.temperature, arrays["generator"],
            arrays["velocity"], arrays["heat"],
        )  # fmt: skip
        self._collide = Launch(
            points.queue, kernel("collide"), GROUP, np.int64(DRAWN * points.bathed),
            np.int32(len(model.bonds)), points.bonds, arrays["generator"], arrays["velocity"],
        )  # fmt: skip

    def follow(self, points: DevicePoints) -> None:
        """Follow new lists of the points."""
        self._close.fix(*self._closed, *points.lists)

    def make(self, h: float, end: float, weight: float, is_last: bool) -> None:
        """Make a stage of a length h [s] that ends at a time [s].

        After the last one of a step kinetic energies are averaged with a weight [s].
        """
        model, half, motion = self._model, np.float64(0.5 * h), np.zeros(4)
        if self._is_driven:
            # With the processor's sine, so that both have the same bits.
            motion[:3] = prescribed_motion.py_func(model.driven, end)
        self._open.run(half, np.float64(h), motion)
        if model.is_random:
            self._exchange.run(np.float64(h))
            self._collide.run(np.float64(model.collision_rate * h * len(model.bonds)))
            self._place.run(half, motion)
        self._other_ranks.exchange()
        step = (half, np.int32(is_last), np.float64(weight))
        self._close.run(*step)
        if self._is_driven:
            self._close_drive.run(*step, motion)
