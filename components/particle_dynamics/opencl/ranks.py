"""Exchange of points on devices among ranks; imported only by a lattice of several ranks."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from quintet.components.particle_dynamics.opencl.device_points import DevicePoints
from quintet.components.particle_dynamics.ranks.several import SeveralRanks
from quintet.components.shared.domain.extremes import greatest
from quintet.components.shared.opencl import halo
from quintet.components.shared.opencl.arrays import DeviceArray


class OtherDevices:
    """Other ranks, each with a device: exchange through the hosts.

    Parameters
    ----------
    communicator : mpi4py communicator
    host : SeveralRanks
        Points of the host, which finds the copies.
    """

    are_there = True

    def __init__(self, communicator: Any, host: SeveralRanks) -> None:
        self._communicator, self._host, self.source = communicator, host, halo.source()

    def connect(self, queue: Any, kernels: Any) -> None:
        """Take a queue, and kernels built from a text that has `source`."""
        self._halo = halo.DeviceHalo(self._communicator, queue, kernels)

    def release(self) -> None:
        """Forget rows, so that their memory can be freed."""
        self._arrays: tuple[DeviceArray, ...] = ()
        self._halo.release()

    def follow(self, points: DevicePoints) -> None:
        """Follow new rows."""
        self._halo.follow(*self._host.exchanged)
        is_damped = self._host.terms.damping is not None
        self._arrays = (points.arrays["position"], points.predicted)[: 1 + is_damped]

    def exchange(self) -> None:
        """Bring places, and velocities that damping takes, up to date."""
        self._halo.exchange(*self._arrays)

    def greatest(self, *numbers: float) -> Sequence[float]:
        """Greatest of all ranks of each number."""
        of_all: list[float] = greatest(self._communicator, np.array(numbers)).tolist()
        return of_all
