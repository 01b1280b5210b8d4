"""Copies of what a rank's particles may touch, on a device; only of a solid of several ranks."""

import numpy as np

from quintet.components.shared.opencl.arrays import DeviceArray
from quintet.components.shared.opencl.halo import DeviceHalo
from quintet.components.sph_solid.opencl.contact import Found, Touched
from quintet.components.sph_solid.opencl.device_state import DeviceState
from quintet.components.sph_solid.ranks.contact import ContactCopies
from quintet.components.sph_solid.ranks.several import SeveralRanks


class DeviceContactCopies:
    """Copies behind own particles, of others that come near them.

    Parameters
    ----------
    ranks : SeveralRanks
    contact : ContactCopies
        Of the host, which finds copies.
    halo : DeviceHalo
    """

    def __init__(self, ranks: SeveralRanks, contact: ContactCopies, halo: DeviceHalo) -> None:
        self._ranks, self._contact, self._halo = ranks, contact, halo

    @property
    def others(self) -> int:
        """Rows that are copies."""
        return self._halo.count

    def find(self, rows: DeviceState, start: DeviceArray, reach: float) -> Found | None:
        """Own particles and copies within a reach [m]; None where one of any rank has no place."""
        places = np.ascontiguousarray(rows.place.get()[: rows.count, :3])
        wrong = float(not np.isfinite(places).all())
        if self._ranks.greatest(np.array([wrong]))[0]:
            return None
        points, row = self._contact.find(places, reach)
        self._halo.follow(*self._contact.rows, rows.count)
        of_all = self._with_room(start, rows.count)
        self._halo.exchange(of_all)
        order = np.empty(len(row), np.int32)
        order[row] = np.arange(len(row))
        low, high = points.min(axis=0, initial=np.inf), points.max(axis=0, initial=-np.inf)
        self._touched = [
            self._with_room(array, rows.count) for array in (rows.place, rows.motion, rows.stress)
        ]
        return Found(low, high, of_all, DeviceArray.of(start.queue, order))

    def touched(self, rows: DeviceState) -> Touched:
        """Rows of own particles and copies, brought up to date."""
        for target, source in zip(
            self._touched, (rows.place, rows.motion, rows.stress), strict=True
        ):
            target.copy_first(rows.count, source)
        self._halo.exchange(*self._touched)
        return Touched(*self._touched)

    def _with_room(self, array: DeviceArray, count: int) -> DeviceArray:
        """The first rows of an array, with room for copies."""
        target = DeviceArray(array.queue, (count + self.others, *array.shape[1:]))
        target.copy_first(count, array)
        return target
