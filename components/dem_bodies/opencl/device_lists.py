"""Pair lists of the host, with pairs and history in the memory of a device."""

from quintet.components.dem_bodies.contact.lists import ContactLists
from quintet.components.dem_bodies.opencl.device_pairs import DevicePairs
from quintet.components.dem_bodies.opencl.device_rows import READ, DeviceRows


class DeviceLists(ContactLists):
    """Pair lists on the host; history, and after a device search newer lists, are on the device."""

    device_pairs: DevicePairs
    are_of_device = False  # whether the device has listed pairs since the host read them
    touching = 0  # most contacts of a row, as the device counts them

    def count_contacts(self, listed: bool = False) -> int:
        """Most contacts of any row; with `listed` as if all listed pairs touched."""
        return ContactLists.count_contacts(self, listed) if listed else self.touching

    def note_contacts(self) -> None:
        """Count the contacts of pairs whose history is on the host."""
        self.touching = ContactLists.count_contacts(self)

    def take(self, pairs: DevicePairs) -> None:
        """Take pairs that were copied to the device."""
        self.device_pairs, self.are_of_device = pairs, False

    def release(self) -> None:
        """Let go of pairs on the device, so that their memory can be freed."""
        vars(self).pop("device_pairs", None)

    def follow(self, pairs: DevicePairs, most_contacts: int) -> None:
        """Follow pairs that the device has listed, and the most that a row has."""
        self.device_pairs, self.are_of_device, self.most_contacts = pairs, True, most_contacts

    def read(self) -> None:
        """Copy pairs with their history and forces to the host; rows have been copied."""
        if self.are_of_device:
            self.balls = self.device_pairs.on_host(self.model, self.records_forces)
            self.are_of_device = False
        if self.balls is not None:
            self.device_pairs.get(self.balls)


class HostCopy:
    """Tracks which rows and pairs on the host are up to date.

    Parameters
    ----------
    rows : DeviceRows or None
        None while a device has none: those of the host are up to date.
    lists : DeviceLists
    """

    def __init__(self, rows: DeviceRows | None, lists: DeviceLists) -> None:
        self._rows, self._lists = rows, lists
        self._current, self._has_pairs = set(READ), True  # arrays of rows, and whether pairs are

    def outdate(self) -> None:
        """Note that the device has newer rows and pairs."""
        self._current.clear()
        self._has_pairs = False

    def read_rows(self, *names: str) -> None:
        """Copy arrays of rows to the host, by default all, unless they are up to date."""
        outdated = [name for name in READ if name in (names or READ) and name not in self._current]
        if outdated:
            assert self._rows is not None
            self._rows.get(outdated)
            self._current.update(outdated)

    def read(self) -> None:
        """Copy rows and pairs to the host, unless they are there."""
        self.read_rows()
        if not self._has_pairs:
            self._lists.read()
            self._has_pairs = True
