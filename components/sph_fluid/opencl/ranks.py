"""Copies of other ranks' rows on a device; imported only by a fluid of several ranks."""

from typing import Any

from quintet.components.shared.opencl.arrays import DeviceArray
from quintet.components.shared.opencl.halo import DeviceHalo
from quintet.components.sph_fluid.boundary.method import BoundaryMethod
from quintet.components.sph_fluid.ranks.halo import Around, HaloAndImages
from quintet.components.sph_fluid.state import State


class DeviceCopies:
    """Copies of one rank.

    Parameters
    ----------
    communicator : mpi4py communicator
    halo : HaloAndImages
        Of the host, which finds the copies.
    queue : pyopencl.CommandQueue
    kernels : pyopencl.Program
        Built from a text that has `shared/opencl/halo.cl`.
    """

    are_there = True

    def __init__(self, communicator: Any, halo: HaloAndImages, queue: Any, kernels: Any) -> None:
        self._host, self._halo = halo, DeviceHalo(communicator, queue, kernels)

    @property
    def count(self) -> int:
        """Rows that are copies."""
        return self._halo.count

    def around(self, state: State, reach: float, boundary: BoundaryMethod) -> Around | None:
        """Make room for copies in a state with lists, and find what may be near.

        Before the fluid is shared out, each rank has all, and no lists.
        """
        if not len(state.reference):
            self._halo.follow([], [], state.particles)
            return None
        around = self._host.around(state, reach, boundary.query_points(state)[0])
        self._halo.follow(*self._host.rows, state.particles)
        return around

    def exchange(self, *arrays: DeviceArray) -> None:
        """Bring the copies in arrays (rows + copies, ...) up to date."""
        self._halo.exchange(*arrays)
