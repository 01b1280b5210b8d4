"""Contact of particles that were no neighbours at the start, on a device; see ../touching.py."""

from typing import Any

import numpy as np

from quintet.components.shared.opencl.arrays import DeviceArray, run
from quintet.components.shared.opencl.types import bytes_of
from quintet.components.shared.search.cells import grid_between
from quintet.components.sph_solid.neighbours import SolidLists
from quintet.components.sph_solid.opencl.contact import Moving, OwnParticles, Particles
from quintet.components.sph_solid.opencl.device_state import DeviceState
from quintet.components.sph_solid.state import Array, State
from quintet.components.sph_solid.touching import SKIN

FEWEST = 8  # particles that lists have room for at first


class DeviceTouching:
    """Which particles may touch, listed on a device from where they are, and their forces.

    Parameters
    ----------
    queue : pyopencl.CommandQueue
    kernels : pyopencl.Program
        Of `programs.source`.
    spacing : float, m
    lists : SolidLists
        Planes of symmetry, and the support of pairs.
    """

    def __init__(self, queue: Any, kernels: Any, spacing: float, lists: SolidLists) -> None:
        self.queue, self.spacing, self._support = queue, spacing, lists.support
        self._ranks = lists.ranks
        self._list, self._touch = kernels.list_touching, kernels.touch
        planes = [(plane.axis, plane.position, plane.inward, 0.0) for plane in lists.images.planes]
        self._count_of_planes = len(planes)
        self._planes = DeviceArray.of(queue, np.array(planes).reshape(-1, 4))
        self._width = FEWEST

    def make(self, rows: DeviceState, start: DeviceArray, state: State) -> None:
        """Forget what is near: it is listed in the next step."""
        self.listed, self._start = DeviceArray.of(self.queue, state.position), start
        self._contact = rows.copies.contact(self.queue) if rows.copies else OwnParticles()
        self._near = DeviceArray(self.queue, (rows.count * self._width,), np.int32)
        self._end = DeviceArray(self.queue, (rows.count,), np.int32)
        self._end.clear()
        self._is_old, self._is_any_near = True, False

    def follow(self, low: Array, high: Array) -> None:
        """Note whether lists hold, of the least and greatest displacements (3,) m in them."""
        moved = float(np.linalg.norm(high - low))
        self._is_old |= not moved < SKIN * self.spacing

    def add(self, rows: DeviceState, heats: DeviceArray) -> None:
        """Add accelerations (n, 3) m/s2 of contact, and its power to the heating.

        `rows.stress` has rows of nominal stress.
        """
        if self._is_old:
            self._renew(rows)
        if not (self._is_any_near or self._count_of_planes):
            return
        numbers = np.int32(rows.count), np.float64(self.spacing), np.float64(self._support)
        particles = _moving(rows)
        if self._is_any_near:
            particles = self._contact.extend(particles, rows.count)
        run(
            self.queue, self._touch, rows.count, *numbers, self._start, *particles,
            np.int32(self._count_of_planes), self._planes, self._near, self._end,
            *self._strides(rows), heats, rows.arrays["heating"],
        )  # fmt: skip

    def _renew(self, rows: DeviceState) -> None:
        """List what may touch until particles have come nearer by the skin."""
        low, high, is_wrong = rows.extremes_of(rows.place)
        if self._ranks.greatest(np.array([float(is_wrong)]))[0]:  # the step will say so
            return
        moving, reach = _moving(rows), (1.0 + SKIN) * self.spacing
        particles = Particles(low, high, self._start, None)
        particles = self._contact.find(moving, rows.count, particles, reach)
        place = self._contact.extend(moving, rows.count).place
        most = self._list_near(rows, particles, place) if rows.count else 0
        rows.note_places(self.listed)
        most_of_all = self._ranks.greatest(np.array([float(most)]))[0]
        self._is_old, self._is_any_near = False, most_of_all > 0.0

    def _list_near(self, rows: DeviceState, particles: Particles, place: DeviceArray) -> int:
        """List what is near each particle, of places (all, 4); return the most of one."""
        cells, count, reach = rows.cells, rows.count, (1.0 + SKIN) * self.spacing
        grid = grid_between(particles.low, particles.high, reach)
        of_all = count + self._contact.others
        key = cells.sorted_keys(place, 0, of_all, grid)
        starts = cells.starts(key, 0, of_all, grid)
        numbers = np.float64(self._support**2), np.float64(reach * reach)
        while True:
            run(
                self.queue, self._list, count, np.int32(count), place, particles.start,
                particles.order, *numbers, key, bytes_of(grid, np.float64), starts,
                np.int32(self._width), *self._strides(rows), self._near, self._end, rows.most,
            )  # fmt: skip
            most = int(cells.greatest(rows.most, count)[0])
            if most <= self._width:
                return most
            self._width = most + most // 8
            self._near = DeviceArray(self.queue, (count * self._width,), np.int32)

    def _strides(self, rows: DeviceState) -> tuple[np.int64, np.int64]:
        by_rows = (self._width, 1) if rows.cells.by_rows else (1, rows.count)
        return np.int64(by_rows[0]), np.int64(by_rows[1])


def _moving(rows: DeviceState) -> Moving:
    """Rows of own particles."""
    return Moving(rows.place, rows.motion, rows.stress)
