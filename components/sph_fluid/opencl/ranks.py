"""Copies of other ranks' rows on a device; imported only by a fluid of several ranks."""

from typing import Any

from quintet.components.shared.opencl.arrays import DeviceArray
from quintet.components.shared.opencl.halo import DeviceHalo
from quintet.components.shared.search.neighbours import Around
from quintet.components.sph_fluid.boundary.method import BoundaryMethod
from quintet.components.sph_fluid.opencl.images import DeviceImages
from quintet.components.sph_fluid.ranks.halo import HaloAndImages
from quintet.components.sph_fluid.state import State


class DeviceCopies:
    """Copies behind the rows of one rank, then images of all.

    Parameters
    ----------
    communicator : mpi4py communicator
    halo : HaloAndImages
        Copies and images of the host's fluid, which finds them.
    queue : pyopencl.CommandQueue
    kernels : pyopencl.Program
        Built from a text that has `shared/opencl/halo.cl` and `images.cl`.
    """

    are_there = True

    def __init__(self, communicator: Any, halo: HaloAndImages, queue: Any, kernels: Any) -> None:
        self._host, self._halo = halo, DeviceHalo(communicator, queue, kernels)
        self._images = DeviceImages(queue, kernels, halo.images)
        self.reflect_crossed = self._images.reflect_crossed

    @property
    def count(self) -> int:
        """Rows that are copies, and images."""
        return self._halo.count + self._images.count

    def around(self, state: State, reach: float, boundary: BoundaryMethod) -> Around | None:
        """Make room for copies in a state with lists, and find what may be near.

        Before the fluid is shared out, each rank has all, and no lists.
        """
        rows = state.particles
        if not len(state.reference):
            self._halo.clear()
            self._images.clear()
            return None
        around = self._host.around(state, reach, boundary.query_points(state)[0])
        self._halo.follow(*self._host.rows)
        self._images.follow(rows + self._halo.count)
        return around

    def write(self, position: DeviceArray, velocity: DeviceArray) -> None:
        """Bring those of positions and velocities (n + count, 4) up to date."""
        self._halo.exchange(position, velocity)
        self._images.write(position, velocity)

    def write_apparent(self, apparent: DeviceArray) -> None:
        """Bring those of velocities that viscosity sees (n + count, 4) up to date."""
        self._halo.exchange(apparent)
        self._images.write_apparent(apparent)
