"""Lists of the azimuthal images of rings on a device; only for axisymmetric scenes.

See kernels/azimuthal_images.py. How many images each ring has is found on the host, by its
functions, from where the rings are listed.
"""

from typing import Any

import numpy as np

from quintet.components.shared.opencl.arrays import DeviceArray, run
from quintet.components.shared.opencl.cells import Cells, NearLists
from quintet.components.sph_solid.axisymmetric import ROOM
from quintet.components.sph_solid.kernels.azimuthal_images import (
    CLOSE,
    WHOLE,
    image_counts,
    turn_table,
)
from quintet.components.sph_solid.state import Array


class DeviceRings:
    """Images of the rings of one solid.

    Parameters
    ----------
    queue : pyopencl.CommandQueue
    kernels : pyopencl.Program
        Of `programs.source`.
    length : float, m
        Smoothing length.
    """

    def __init__(self, queue: Any, kernels: Any, length: float) -> None:
        self.queue, self.length, self._list_images = queue, length, kernels.list_images
        self.most, self.width = 0, ROOM  # images in the table, and near a ring
        self.turns = DeviceArray.of(queue, turn_table(0))

    def images(
        self, cells: Cells, near: NearLists, place: DeviceArray, radius: Array, count: int,
        reach: float, extremes: DeviceArray,
    ) -> tuple[NearLists, DeviceArray]:  # fmt: skip
        """List the images within a reach [m] of `count` rings, and the turn of each.

        Parameters
        ----------
        cells : Cells
        near : NearLists
            Rings that are near in the plane.
        place : (n + images, 4) array, m
        radius : (n + images,) array, m
        extremes : (n or more, 4) array
            Written.
        """
        numbers = image_counts(radius, self.length)
        most = int(numbers.max())
        if most > self.most:
            self.most = 2 * most
            self.turns = DeviceArray.of(self.queue, turn_table(self.most))
        of_all, all_of_few = DeviceArray.of(self.queue, numbers), 3 * (self.most + 1)
        assert self.turns.shape[0] == all_of_few + WHOLE * (WHOLE // 2 + 1)
        end = DeviceArray(self.queue, (count,), np.int32)
        while True:
            by_rows = (self.width, 1) if cells.by_rows else (1, count)
            strides = tuple(map(np.int64, by_rows))
            ring, turn = (
                DeviceArray(self.queue, (count * self.width,), np.int32) for _ in range(2)
            )
            run(
                self.queue, self._list_images, count, np.int32(count), place, of_all,
                np.float64(reach * reach), np.float64(CLOSE * self.length), self.turns,
                np.int32(all_of_few), near.near, near.end, near.row_stride, near.item_stride,
                np.int32(self.width), *strides, ring, turn, end, extremes,
            )  # fmt: skip
            longest = int(cells.greatest(extremes, count)[0])
            if longest <= self.width:
                return NearLists(ring, near.middle, end, *strides), turn
            self.width = longest + longest // 8
