"""Copies of other ranks' particles on a device; imported only by a solid of several ranks."""

from typing import Any

import numpy as np

from quintet.components.shared.domain.sorting import grid_of_all
from quintet.components.shared.opencl.arrays import DeviceArray
from quintet.components.shared.opencl.cells import Cells, NearLists
from quintet.components.shared.opencl.halo import DeviceHalo
from quintet.components.shared.search.cells import sorted_into
from quintet.components.sph_solid.opencl.contact_ranks import DeviceContactCopies
from quintet.components.sph_solid.opencl.images import DeviceImages
from quintet.components.sph_solid.ranks.several import SeveralRanks
from quintet.components.sph_solid.state import State


class DeviceCopies:
    """Copies behind the rows of one rank, then images of all.

    Lists have the order that they have on one rank: so have the sums of pairs.

    Parameters
    ----------
    communicator : mpi4py communicator
    ranks : SeveralRanks
        Of the host, which finds copies.
    images : DeviceImages
    queue : pyopencl.CommandQueue
    kernels : pyopencl.Program
        Of `programs.source`, with `shared/opencl/halo.cl`.
    """

    def __init__(
        self, communicator: Any, ranks: SeveralRanks, images: DeviceImages, queue: Any, kernels: Any
    ) -> None:
        self._communicator, self._ranks, self._images = communicator, ranks, images
        self._kernels = kernels
        self._halo = DeviceHalo(communicator, queue, kernels)
        self.mirrors, self.with_room = images.mirrors, images.with_room

    def contact(self, queue: Any) -> DeviceContactCopies:
        """Copies of what own particles may touch, in the order that they have now."""
        halo = DeviceHalo(self._communicator, queue, self._kernels)
        return DeviceContactCopies(self._ranks.contact(), halo)

    @property
    def number(self) -> int:
        """Rows that are copies, and images."""
        return self._halo.count + self._images.number

    def find(self, queue: Any, state: State) -> None:
        """Find copies of what is near own particles, as they are sorted, and images of all."""
        self._extended = self._ranks.copy(state)
        copies = self._ranks.images
        self._halo.follow(copies.sent, copies.received)
        points, row = self._extended
        self._image_points = self._images.find_of(queue, points, state.reach, row)

    def lists(
        self, cells: Cells, state: State, extremes: DeviceArray, places: DeviceArray
    ) -> NearLists:
        """List what is near particles, of places (n, 3) m, among all, copies and images."""
        points, row = self._extended
        grid = grid_of_all(self._communicator, state.reference, state.reach)
        _, start, order = sorted_into(points, grid)
        _, start_of_images, order_of_images = sorted_into(self._image_points, grid)
        rows = np.zeros((len(points) + len(self._image_points), 4))
        rows[:, :3] = np.concatenate([points[order], self._image_points[order_of_images]])
        names = np.concatenate([row[order], len(points) + order_of_images]).astype(np.int32)
        queue, count = places.queue, state.particles
        starts = (start, len(points) + start_of_images)
        first, second = (DeviceArray.of(queue, part.astype(np.int32)) for part in starts)
        return cells.lists(
            DeviceArray.of(queue, rows), places, count, 0, grid, (first, second), state.reach,
            extremes, DeviceArray.of(queue, names),
        )  # fmt: skip

    def write_rows(self, place: DeviceArray, motion: DeviceArray, count: int) -> None:
        """Write copies and images of places and motion, behind those of `count` particles."""
        self._halo.exchange(place, motion)
        self._images.write_rows(place, motion, count + self._halo.count)

    def write_stresses(self, stress: DeviceArray, count: int) -> None:
        """Write rows of stress of copies and images."""
        self._halo.exchange(stress)
        self._images.write_stresses(stress, count + self._halo.count)
