"""Images in planes of symmetry on a device; imported only by a fluid that may have some."""

from pathlib import Path
from typing import Any

import numpy as np

from quintet.components.shared.opencl.arrays import DeviceArray, run
from quintet.components.shared.search.neighbours import Around
from quintet.components.shared.symmetry import SymmetryImages
from quintet.components.sph_fluid.boundary.method import BoundaryMethod
from quintet.components.sph_fluid.boundary.symmetry import Symmetry
from quintet.components.sph_fluid.state import State

SOURCE = Path(__file__).with_name("images.cl")


class DeviceImages:
    """Images behind the rows of one rank, and copies of other ranks' rows.

    Parameters
    ----------
    queue : pyopencl.CommandQueue
    kernels : pyopencl.Program
        Built from a text that has `SOURCE`.
    images : SymmetryImages
        Of the host, which finds them.
    """

    def __init__(self, queue: Any, kernels: Any, images: SymmetryImages) -> None:
        self.queue, self._images, self.count = queue, images, 0
        self._positions, self._velocities = kernels.image_positions, kernels.image_velocities
        self._apparent, self._reflect = kernels.image_apparent, kernels.reflect_crossed
        self._numbers: list[tuple[Any, ...]] = []  # of each plane

    def follow(self, rows: int) -> None:
        """Follow new images, which stand behind so many rows."""
        self._numbers, first = [], rows
        for plane, origin in zip(self._images.planes, self._images.origin, strict=True):
            row = DeviceArray.of(self.queue, origin.astype(np.int32))
            self._numbers.append((row, *map(np.int32, (len(origin), first, plane.axis))))
            first += len(origin)
        self.count = first - rows

    def clear(self) -> None:
        """Drop the images, in a state without lists."""
        self._numbers, self.count = [], 0

    def write(self, position: DeviceArray, velocity: DeviceArray) -> None:
        """Write the images of positions (n, 4) and velocities (n, 4)."""
        for plane, numbers in zip(self._images.planes, self._numbers, strict=True):
            twice = np.float64(2.0 * plane.position)
            run(self.queue, self._positions, int(numbers[1]), *numbers, twice, position)
            run(self.queue, self._velocities, int(numbers[1]), *numbers, velocity)

    def write_apparent(self, apparent: DeviceArray) -> None:
        """Write the images of velocities (n, 4), in the precision of pairs."""
        for numbers in self._numbers:
            run(self.queue, self._apparent, int(numbers[1]), *numbers, apparent)

    def reflect_crossed(self, split: int, *arrays: DeviceArray | None) -> None:
        """Let fluid that passed a plane change places with its image."""
        for plane in self._images.planes:
            numbers = np.int32(split), np.int32(plane.axis)
            place = np.float64(plane.position), np.float64(plane.inward)
            run(self.queue, self._reflect, split, *numbers, *place, *arrays)


class ImagesOfOneRank:
    """Images as all that stands behind the rows of a fluid on one rank.

    Parameters
    ----------
    symmetry : Symmetry
        Of the host, which finds them.
    queue, kernels
        As of `DeviceImages`.
    """

    are_there = True

    def __init__(self, symmetry: Symmetry, queue: Any, kernels: Any) -> None:
        self._host, self._images = symmetry, DeviceImages(queue, kernels, symmetry.images)
        self.write, self.write_apparent = self._images.write, self._images.write_apparent
        self.reflect_crossed = self._images.reflect_crossed

    @property
    def count(self) -> int:
        """How many there are."""
        return self._images.count

    def around(self, state: State, reach: float, boundary: BoundaryMethod) -> Around | None:
        """Make room for images in a state with lists, and find what may be near; else drop them."""
        if not len(state.reference):
            self._images.clear()
            return None
        around = self._host.around(state, reach, boundary.query_points(state)[0])
        self._images.follow(state.particles)
        return around
