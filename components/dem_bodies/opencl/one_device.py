"""All rows on an OpenCL device, in the place of `ranks/one.py`.

The host builds the rows and computes outputs, from rows copied back first. A step copies back only
its sums and extremes. If the device is the processor, the host sorts rows and lists pairs; other
devices do it themselves, in the same order.
"""

import math
from collections.abc import Sequence

import numpy as np

from quintet.components.dem_bodies.opencl import programs
from quintet.components.dem_bodies.opencl.device_lists import DeviceLists, HostCopy
from quintet.components.dem_bodies.opencl.device_pairs import all_pairs, pairs_of_host
from quintet.components.dem_bodies.opencl.device_rows import DeviceRows
from quintet.components.dem_bodies.opencl.report import root, write_report
from quintet.components.dem_bodies.opencl.search import Search
from quintet.components.dem_bodies.opencl.stages import Stages
from quintet.components.dem_bodies.ranks.one import OneRank
from quintet.components.dem_bodies.state import BallPairs, Model, Numbers, State
from quintet.components.shared.opencl.devices import build, require_doubles
from quintet.components.shared.opencl.ranks import device_and_queue
from quintet.components.shared.search.verlet_list import slack
from quintet.interfaces.component import Fields, Resources
from quintet.interfaces.errors import SceneError, StepError


class OneDevice(OneRank):
    """Steps all rows on a device.

    Parameters
    ----------
    state : State
        As it starts; all bodies are balls.
    lists : DeviceLists
    resources : Resources
    """

    lists: DeviceLists

    def __init__(self, state: State, lists: DeviceLists, resources: Resources) -> None:
        device, queue = device_and_queue(resources)
        require_doubles(device, resources.device)
        super().__init__(state, lists, threads=1)
        balls = lists.balls
        assert balls is not None
        lanes = programs.LANES_OF_PROCESSORS if device.is_processor else 1
        rolls = balls.rolling_moment is not None
        kernels = build(queue, programs.source(rolls, lanes))
        self.rows = DeviceRows(queue, kernels, self.model, state, slice(0, len(balls.begin) - 1))
        self._search: Search | None = None
        if not device.is_processor:  # which lists pairs faster without a device's sort
            self._search = Search(kernels, self.rows, self.model, lists.skin, rolls)
        self.stages = Stages(kernels, self.rows, self.model, lanes)
        self._put()

    def _put(self) -> None:
        """Copy the host's rows and lists to the device."""
        balls = self.lists.balls
        assert balls is not None
        self.rows.put()
        if self._search is not None:
            self._search.put()
        self.lists.take(pairs_of_host(self.rows.queue, self.model, balls, all_pairs(balls)))
        self.lists.note_contacts()
        self.stages.follow(self.lists.device_pairs)
        self._host = HostCopy(self.rows, self.lists)
        self._is_finite = False  # not known before a step

    def advance(self, state: State, dt: float, loaded: bool) -> bool:
        """Advance by dt [s]; return False where a position is not finite."""
        self.rows.put_planes()
        self._host.outdate()
        travel = self.stages.drift(dt, loaded)
        if not slack(self.lists.skin, root(travel)) >= 0.0:
            try:
                if not self._renew(travel):
                    return False
            except SceneError as error:  # lists have outgrown the memory
                raise StepError(str(error)) from error
            travel = 0.0
        self.stages.touch(dt)
        self.stages.kick(dt, loaded)
        self._host.outdate()
        reduced = self.stages.reduced()
        write_report(self.state, self.model.gravity, reduced, travel)
        self.lists.touching = int(reduced.of_kick["CONTACTS"])
        self._is_finite = reduced.of_drift["BROKEN"] == 0.0
        if self.rows.count == 1:
            self._host.read_rows()  # its clearance limits the step
        return True

    def _renew(self, travel: float) -> bool:
        """Sort rows and list pairs; return False where a position is not finite.

        `travel` [m²] is infinite where none have been listed.
        """
        if self._search is not None and math.isfinite(travel):
            pairs, most_contacts = self._search.renew(self.lists.device_pairs)
            self.lists.follow(pairs, most_contacts)
            self.stages.follow(pairs)
            return True
        self._host.read()
        if not np.isfinite(self.state.position).all():
            return False
        self.lists.renew(self.state)
        self._put()
        return True

    def is_finite(self) -> bool:
        """Whether orientations after the last drift were finite; False before a step."""
        return self._is_finite

    def set_loads(self, load: Numbers) -> None:
        """Set the loads (m, 6) [N, N m] on all bodies."""
        self.rows.sort_host()
        super().set_loads(load)
        self.rows.put_loads()

    def keep_contact_loads(self) -> None:
        """Keep the loads of contacts as those of the coming step's beginning."""
        self.rows.keep_loads()

    def motion(self) -> Sequence[Numbers]:
        """Position, velocity, orientation and angular velocity of all bodies."""
        return self.rows.motion()

    def whole(self, *names: str) -> tuple[Model, State]:
        """Model and state of all rows, copied from the device; pairs too if no array is named.

        Pairs cost more: after a search on the device the host indexes all of them.
        """
        if names:
            self._host.read_rows(*names)
        else:
            self._host.read()
        return self.model, self.state

    def pairs_of_all(self) -> BallPairs | None:
        """Pairs of balls of all rows, copied from the device."""
        self._host.read()
        return self.lists.balls

    def load(self, saved: Fields) -> None:
        """Restore a saved state, of a processor or of a device."""
        super().load(saved)
        self._put()
