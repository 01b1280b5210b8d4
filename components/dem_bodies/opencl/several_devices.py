"""Rows shared out among ranks, each with a device or a part of one.

The host lists pairs and moves rows between ranks, as `ranks/several.py` does, from rows that are
copied back first. In a step each device gets the motion of later rows that its pairs need, and
sends the loads of these pairs to the ranks of those rows. Sums of groups of rows are added up in
the order in which one device adds them, so no bit depends on the ranks.
"""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from quintet.components.dem_bodies.opencl import programs
from quintet.components.dem_bodies.opencl.device_lists import HostCopy
from quintet.components.dem_bodies.opencl.device_pairs import pairs_of_host
from quintet.components.dem_bodies.opencl.device_rows import DeviceRows
from quintet.components.dem_bodies.opencl.report import root, write_report
from quintet.components.dem_bodies.opencl.shared_lists import SharedDeviceLists
from quintet.components.dem_bodies.opencl.stages import IS_SUM, Reduced, Stages, reduced_of
from quintet.components.dem_bodies.ranks.rows import RowsOfRank
from quintet.components.dem_bodies.ranks.several import SeveralRanks
from quintet.components.dem_bodies.state import BLOCK, BallPairs, Model, Numbers, State
from quintet.components.shared.domain.extremes import greatest
from quintet.components.shared.opencl import halo
from quintet.components.shared.opencl.arrays import GROUP
from quintet.components.shared.opencl.devices import build, require_doubles
from quintet.components.shared.opencl.ranks import device_and_queue
from quintet.components.shared.search.verlet_list import slack
from quintet.interfaces.component import Fields, Resources
from quintet.interfaces.errors import SceneError, StepError

GROUPS = BLOCK // GROUP  # of rows, in a block
OF_DRIFT = slice(0, programs.DRIFT_SUMS)  # columns of the sums of groups
OF_KICK = slice(programs.DRIFT_SUMS, programs.DRIFT_SUMS + programs.KICK_SUMS)


class SeveralDevices(SeveralRanks):
    """Steps the rows of one rank on its device.

    Parameters
    ----------
    rows : RowsOfRank
        All bodies are balls.
    lists : SharedDeviceLists
    resources : Resources
    """

    lists: SharedDeviceLists

    def __init__(self, rows: RowsOfRank, lists: SharedDeviceLists, resources: Resources) -> None:
        device, queue = device_and_queue(resources)
        require_doubles(device, resources.device)
        super().__init__(rows, lists, threads=1)
        self._queue = queue
        self._lanes = programs.LANES_OF_PROCESSORS if device.is_processor else 1
        rolls = lists.balls.rolling_moment is not None
        self._kernels = build(queue, programs.source(rolls, self._lanes) + halo.source())
        parts = self.shares.communicator, queue, self._kernels
        self._motion_halo, self._load_halo = halo.DeviceHalo(*parts), halo.DeviceHalo(*parts)
        self.sums = np.zeros((self.shares.blocks, GROUPS * OF_KICK.stop))
        lists.link_ranks()
        self._put()

    def _put(self) -> None:
        """Copy own rows, copies and pairs of the host to the device."""
        lists, owned = self.lists, self.rows.owned_balls
        self._release()
        self.device_rows = DeviceRows(
            self._queue, self._kernels, self.model, self.state, owned, lists.copied
        )
        self.device_rows.put()
        lists.take(pairs_of_host(self._queue, self.model, lists.balls, lists.numbered()))
        self.stages = Stages(self._kernels, self.device_rows, self.model, self._lanes)
        self.stages.follow(lists.device_pairs)
        count = self.device_rows.count
        ends = np.cumsum([count, *map(len, lists.needed)])
        places = [np.arange(first, last) for first, last in pairwise(ends.tolist())]
        self._motion_halo.follow([asked - owned.start for asked in lists.asked], places)
        self._load_halo.follow(lists.loads.sent, lists.loads.arrived)
        self._host = HostCopy(self.device_rows, lists)

    def _release(self) -> None:
        """Free the rows and pairs on the device before it gets others; the host has them."""
        self._motion_halo.release()
        self._load_halo.release()
        self.lists.release()
        self._host = HostCopy(None, self.lists)
        for name in ("stages", "device_rows"):
            vars(self).pop(name, None)

    def advance(self, state: State, dt: float, loaded: bool) -> bool:
        """Advance by dt [s]; return False where a position is not finite."""
        shares = self.shares
        shares.work.begin()
        self.device_rows.put_planes()
        self._host.outdate()
        furthest = np.array([self.stages.drift(dt, loaded)])
        self._write_sums(OF_DRIFT, self.stages.sums_of_drift())
        travel = float(greatest(shares.communicator, furthest)[0])
        holds = slack(self.lists.skin, root(travel)) >= 0.0
        if holds:
            self._motion_halo.exchange(self.device_rows.arrays["motion"])
        elif not self._renew(state):
            return False
        self.stages.touch(dt)
        pairs = self.lists.device_pairs
        self._load_halo.exchange(pairs.push, *([] if pairs.moment is None else [pairs.moment]))
        self.stages.kick(dt, loaded)
        self._host.outdate()
        reduced = self._reduced()
        write_report(state, self.model.gravity, reduced, travel if holds else 0.0)
        self.lists.touching = int(reduced.of_kick["CONTACTS"])
        shares.work.end()
        return True

    def _renew(self, state: State) -> bool:
        """List pairs again on the host; return False if a position is not finite."""
        self._host.read()
        try:
            if not self._list_pairs(state):
                return False
            self._put()
        except SceneError as error:  # lists have outgrown the memory
            raise StepError(str(error)) from error
        return True

    def _write_sums(self, columns: slice, sums: Numbers) -> None:
        """Write sums (columns, groups) of own groups of rows."""
        of_groups = self.sums.reshape(-1, OF_KICK.stop)
        owned = of_groups[GROUPS * self.shares.first : GROUPS * self.shares.last, columns]
        owned[:] = 0.0
        owned[: sums.shape[1]] = sums.T

    def _reduced(self) -> Reduced:
        """What the step reduced over the rows and pairs of all ranks."""
        numbers = self.stages.numbers()
        self._write_sums(OF_KICK, self.stages.sums_of_kick())
        self.shares.blocks_everywhere(self.sums)
        numbers[IS_SUM] = total_of(self.sums.reshape(-1, OF_KICK.stop))
        numbers[~IS_SUM] = greatest(self.shares.communicator, numbers[~IS_SUM])
        return reduced_of(numbers)

    def keep_contact_loads(self) -> None:
        """Keep the loads of contacts as those of the coming step's beginning."""
        self.device_rows.keep_loads()

    def set_loads(self, load: Numbers) -> None:
        """Set the loads (m, 6) [N, N m] on own bodies, of those on all."""
        super().set_loads(load)
        self.device_rows.put_loads()

    def motion(self) -> Sequence[Numbers]:
        """Position, velocity, orientation and angular velocity of all bodies, on rank 0."""
        self._host.read_rows("motion", "orientation")
        return super().motion()

    def whole(self, *names: str) -> tuple[Model, State]:
        """Model and some arrays of the state, or all with the pairs, of all rows on rank 0."""
        if names:
            self._host.read_rows(*names)
        else:
            self._host.read()
        return super().whole(*names)

    def pairs_of_all(self) -> BallPairs:
        """Pairs of balls of all rows."""
        self._host.read()
        return super().pairs_of_all()

    def load(self, saved: Fields) -> None:
        """Restore own rows of a state that was saved on processors or devices."""
        super().load(saved)
        self.lists.note_contacts()
        self._put()


def total_of(sums: Numbers) -> Numbers:
    """Sums (columns,) of groups (groups, columns), in the order in which `tallies.cl` adds them."""
    of_items = np.zeros((GROUP, sums.shape[1]))
    for first in range(0, len(sums), GROUP):
        groups = sums[first : first + GROUP]
        of_items[: len(groups)] += groups
    total: Numbers = np.cumsum(of_items, axis=0)[-1]
    return total
