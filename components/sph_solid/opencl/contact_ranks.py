"""Copies of what a rank's particles may touch, on a device; only of a solid of several ranks."""

import numpy as np

from quintet.components.shared.opencl.arrays import DeviceArray
from quintet.components.shared.opencl.halo import DeviceHalo
from quintet.components.sph_solid.opencl.contact import Moving, Particles
from quintet.components.sph_solid.ranks.contact import ContactCopies


class DeviceContactCopies:
    """Copies behind own particles, of others that come near them.

    Parameters
    ----------
    contact : ContactCopies
        Of the host, which finds copies.
    halo : DeviceHalo
    """

    def __init__(self, contact: ContactCopies, halo: DeviceHalo) -> None:
        self._contact, self._halo = contact, halo

    @property
    def others(self) -> int:
        """Rows that are copies."""
        return self._halo.count

    def find(self, rows: Moving, count: int, particles: Particles, reach: float) -> Particles:
        """Own particles, of which there are `count`, and copies within a reach [m] of them."""
        places = np.ascontiguousarray(rows.place.get()[:count, :3])
        points, row = self._contact.find(places, reach)
        self._halo.follow(*self._contact.rows)
        start = self._with_room(particles.start, count)
        self._halo.exchange(start)
        order = np.empty(len(row), np.int32)
        order[row] = np.arange(len(row))
        self._rows = Moving(*(self._with_room(array, count) for array in rows))
        low, high = points.min(axis=0, initial=np.inf), points.max(axis=0, initial=-np.inf)
        return Particles(low, high, start, DeviceArray.of(start.queue, order))

    def extend(self, rows: Moving, count: int) -> Moving:
        """Rows of own particles and copies, brought up to date."""
        for target, source in zip(self._rows, rows, strict=True):
            target.copy_first(count, source)
        self._halo.exchange(*self._rows)
        return self._rows

    def _with_room(self, array: DeviceArray, count: int) -> DeviceArray:
        """The first rows of an array, with room for copies."""
        target = DeviceArray(array.queue, (count + self.others, *array.shape[1:]))
        target.copy_first(count, array)
        return target
