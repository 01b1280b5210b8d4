"""Pair lists of one rank of several with devices, by the numbers of its device's rows."""

import numpy as np

from quintet.components.dem_bodies.opencl.device_lists import DeviceLists
from quintet.components.dem_bodies.opencl.device_pairs import NumberedPairs, stride_of
from quintet.components.dem_bodies.ranks.lists import SharedLists
from quintet.components.dem_bodies.ranks.loads import link_loads
from quintet.components.dem_bodies.state import Whole


class SharedDeviceLists(DeviceLists, SharedLists):
    """Pairs of the balls that a rank owns, listed on the host; their history is on its device.

    A device numbers its own balls first, then copies of other ranks' rows, and the ground.
    """

    @property
    def copied(self) -> Whole:
        """Rows of other ranks that the device needs copies of, in ascending order."""
        return np.concatenate(self.needed)

    def count_contacts(self, listed: bool = False) -> int:
        """Most contacts of any row of all ranks; collective with `listed`."""
        return SharedLists.count_contacts(self, listed) if listed else self.touching

    def note_contacts(self) -> None:
        """Count the contacts of all ranks' pairs whose history is on the host; collective."""
        self.touching = SharedLists.count_contacts(self)

    def numbered(self) -> NumberedPairs:
        """Pairs by the numbers of the device's rows."""
        owned, copied, pairs = self.rows.owned_balls, self.copied, self.balls
        count, partner = owned.stop - owned.start, pairs.partner.astype(np.int64)
        of_copies = count + np.searchsorted(copied, partner)
        planes = partner - self.shares.rows + count + len(copied) + 1
        others = np.where(partner < self.shares.rows, of_copies, planes)
        return NumberedPairs(
            pairs.begin[owned.start : owned.stop + 1],
            pairs.row.astype(np.int64) - owned.start,
            np.where(partner < owned.stop, partner - owned.start, others),
            self.loads.incoming_begin,
            self.loads.incoming,
            sum(map(len, self.loads.arrived)),
        )

    def _make_slots(self) -> None:
        """Assign slots to loads received from other ranks, after those of own pairs."""
        partner, balls = self.balls.partner.astype(np.int64), self.rows.owned_balls
        of_balls = np.flatnonzero(partner < self.shares.rows)
        room = stride_of(len(partner))
        self.loads = link_loads(self.shares, balls, partner[of_balls], of_balls, room)
