"""Images of particles in planes of symmetry, on a device; see shared/symmetry.py.

An image of an image has the same root. The host finds which particles have images, from the places
where they are listed.
"""

from collections.abc import Callable
from typing import Any

import numpy as np

from quintet.components.shared.opencl.arrays import DeviceArray, run
from quintet.components.shared.opencl.cells import Cells
from quintet.components.shared.search.cells import Grid
from quintet.components.shared.symmetry import Plane, mirrored
from quintet.components.sph_solid.state import Array, Whole


class DeviceImages:
    """Images of the particles of one solid.

    Parameters
    ----------
    planes, mirrors : list of Plane
        Planes that particles have images in, and those that none may pass, the axis of rings too.
    kernels : pyopencl.Program
        Of `programs.source`.
    take_rows
        Copies rows in the order of keys; see `DeviceState.take_rows`.
    """

    def __init__(
        self,
        planes: list[Plane],
        mirrors: list[Plane],
        kernels: Any,
        take_rows: Callable[..., DeviceArray],
    ) -> None:
        self.planes, self.mirrors = planes, mirrors
        self._reflect, self._take_rows = kernels.reflect, take_rows
        self._mirror_rows, self._mirror_stress = kernels.mirror_rows, kernels.mirror_stress
        self.number = 0

    def reflect(self, queue: Any, count: int, arrays: dict[str, DeviceArray]) -> None:
        """Let particles that have passed a plane change places with their images."""
        vectors = (arrays[name] for name in ("position", "velocity", "acceleration", "deviator"))
        rows = tuple(vectors)
        for plane in self.mirrors:
            numbers = np.float64(plane.position), np.float64(plane.inward)
            run(queue, self._reflect, count, np.int32(count), np.int32(plane.axis), *numbers, *rows)

    def find(self, queue: Any, points: Array, reach: float) -> int:
        """Find what is nearer to a plane than a reach [m], of points (n, 3) m; return how many."""
        return len(self.find_of(queue, points, reach)) if self.planes else 0

    def find_of(self, queue: Any, points: Array, reach: float, row: Whole | None = None) -> Array:
        """Find images as `find`; return where they are (k, 3) m.

        Points have the rows `row` (n,), or those of their order.
        """
        root, sign, shift = np.zeros(0, np.int64), np.zeros((0, 4)), np.zeros((0, 4))
        images = np.zeros((0, 3))
        for plane in self.planes:
            # Points, and then images in other planes that have images in this one.
            first, again = (
                np.flatnonzero(plane.inward * (rows[:, plane.axis] - plane.position) < reach)
                for rows in (points, images)
            )
            near = np.concatenate([points[first], images[again]])
            images = np.concatenate([images, mirrored(near, plane)])
            signs = np.concatenate([np.ones((len(first), 4)), sign[again]])
            signs[:, plane.axis] *= -1.0
            shifts = np.concatenate([np.zeros((len(first), 4)), shift[again]])
            root = np.concatenate([root, first, root[again]])
            sign = np.concatenate([sign, signs])
            shift = np.concatenate([shift, mirrored(shifts, plane)])
        self.number, places = len(root), sign[:, :3] * points[root] + shift[:, :3]
        root = root if row is None else row[root]
        self._arrays = [DeviceArray.of(queue, array) for array in (root, sign, shift)]
        return places

    def of_all(self, values: Array) -> Array:
        """Values (n,) of particles, and then of their images (n + images,)."""
        if not self.number:
            return values
        return np.concatenate([values, values[self._arrays[0].get()]])

    def with_room(self, rows: DeviceArray, count: int, others: int) -> DeviceArray:
        """Rows (n, 4) with room for so many behind the first `count`."""
        target = DeviceArray(rows.queue, (count + others, 4))
        target.copy_first(count, rows)
        return target

    def sort(
        self, cells: Cells, place: DeviceArray, motion: DeviceArray, count: int, grid: Grid
    ) -> DeviceArray:
        """Bring images that are near into near rows; return where each cell of them starts."""
        queue = place.queue
        self.write_rows(place, motion, count)
        key = cells.sorted_keys(place, count, self.number, grid)
        self._arrays = [
            self._take_rows(key, array, DeviceArray(queue, array.shape, array.dtype), count)
            for array in self._arrays
        ]
        self.write_rows(place, motion, count)
        return cells.starts(key, count, self.number, grid)

    def write_rows(self, place: DeviceArray, motion: DeviceArray, count: int) -> None:
        """Write places and motion of the images, behind those of `count` particles."""
        numbers = np.int32(count), np.int32(self.number)
        rows = (*self._arrays, place, motion) if self.number else ()
        run(place.queue, self._mirror_rows, self.number, *numbers, *rows)

    def write_stresses(self, stress: DeviceArray, count: int) -> None:
        """Write rows of stress of the images."""
        numbers = np.int32(count), np.int32(self.number)
        rows = (*self._arrays[:2], stress) if self.number else ()
        run(stress.queue, self._mirror_stress, self.number, *numbers, *rows)
