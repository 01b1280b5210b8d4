"""All rows on an OpenCL device, in the place of `ranks/one.py`.

The host builds the rows and computes outputs, from rows copied back first. A step copies back only
its sums and extremes. If the device is the processor, the host sorts rows and lists pairs; other
devices do it themselves, in the same order.
"""

import math
from collections.abc import Sequence

import numpy as np

from quintet.components.dem_bodies.contact.lists import ContactLists
from quintet.components.dem_bodies.kernels.geometry import FAR
from quintet.components.dem_bodies.opencl import programs
from quintet.components.dem_bodies.opencl.device_pairs import DevicePairs, pairs_of_host
from quintet.components.dem_bodies.opencl.device_rows import DeviceRows
from quintet.components.dem_bodies.opencl.search import Search
from quintet.components.dem_bodies.opencl.stages import Reduced, Stages
from quintet.components.dem_bodies.ranks.one import OneRank
from quintet.components.dem_bodies.state import (
    CONTACT_WORK,
    DEEPEST,
    DEEPEST_PAIR,
    ELASTIC_ENERGY,
    LARGEST_ACCELERATION,
    LARGEST_SPEED,
    LOAD_WORK,
    SMALLEST_GAP,
    STIFFEST,
    TOUCHING,
    TRAVEL,
    BallPairs,
    Model,
    Numbers,
    State,
)
from quintet.components.shared.opencl.devices import build, device_of, require_doubles
from quintet.components.shared.search.verlet_list import slack
from quintet.interfaces.component import Fields, Resources
from quintet.interfaces.errors import SceneError, StepError

# Pairs that a work item of a processor computes together (SIMD lanes); 1 on other devices.
LANES_OF_PROCESSORS = 4


class DeviceLists(ContactLists):
    """Pair lists on the host; history, and after a device search newer lists, are on the device."""

    pairs: DevicePairs  # of the device
    are_of_device = False  # whether the device has listed pairs since the host read them
    touching = 0  # most contacts of a row, as the device counts them

    def count_contacts(self, listed: bool = False) -> int:
        """Most contacts of any row; with `listed` as if all listed pairs touched."""
        return super().count_contacts(listed) if listed else self.touching

    def note_contacts(self) -> None:
        """Count the contacts of pairs whose history is on the host."""
        self.touching = super().count_contacts()

    def follow(self, pairs: DevicePairs, most_contacts: int) -> None:
        """Follow pairs that the device has listed, and the most that a row has."""
        self.pairs, self.are_of_device, self.most_contacts = pairs, True, most_contacts

    def read(self) -> None:
        """Copy pairs with their history and forces to the host; rows have been copied."""
        if self.are_of_device:
            self.balls = self.pairs.on_host(self.model, self.records_forces)
            self.are_of_device = False
        if self.balls is not None:
            self.pairs.get(self.balls)


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
        device = device_of(resources.device)
        require_doubles(device, resources.device)
        super().__init__(state, lists, threads=1)
        balls = lists.balls
        assert balls is not None
        self._lanes = LANES_OF_PROCESSORS if device.is_processor else 1
        queue = device.queue(resources.threads)
        rolls = balls.rolling_moment is not None
        kernels = build(queue, programs.source(rolls, self._lanes))
        self.rows = DeviceRows(queue, kernels, self.model, state)
        self._search: Search | None = None
        if not device.is_processor:  # which lists pairs faster without a device's sort
            self._search = Search(kernels, self.rows, self.model, lists.skin, rolls)
        self.stages = Stages(kernels, self.rows, self.model, self._lanes)
        self._put()

    def _put(self) -> None:
        """Copy the host's rows and lists to the device."""
        lists, balls = self.lists, self.lists.balls
        assert balls is not None
        self.rows.put()
        lists.pairs = pairs_of_host(self.rows.queue, self.model, balls, self._lanes)
        lists.are_of_device = False
        lists.note_contacts()
        self.stages.follow(lists.pairs)
        self._has_rows = self._has_pairs = True
        self._is_finite = False  # not known before a step

    def _read_rows(self) -> None:
        """Copy rows to the host, unless they are there."""
        if not self._has_rows:
            self.rows.get()
            self._has_rows = True

    def _read(self) -> None:
        """Copy rows and pairs to the host, unless they are there."""
        self._read_rows()
        if not self._has_pairs:
            self.lists.read()
            self._has_pairs = True

    def advance(self, state: State, dt: float, loaded: bool) -> bool:
        """Advance by dt [s]; return False where a position is not finite."""
        self.rows.put_planes()
        self._has_rows = self._has_pairs = False
        travel = self.stages.drift(dt, loaded)
        if not slack(self.lists.skin, root(travel)) >= 0.0:
            try:
                if not self._renew(travel):
                    return False
            except SceneError as error:  # lists have outgrown the memory
                raise StepError(str(error)) from error
            travel = 0.0
        reduced = self.stages.touch_and_kick(dt, loaded)
        self._has_rows = self._has_pairs = False
        self._report(reduced, travel)
        return True

    def _renew(self, travel: float) -> bool:
        """Sort rows and list pairs; return False where a position is not finite.

        `travel` [m²] is infinite where none have been listed.
        """
        if self._search is not None and math.isfinite(travel):
            pairs, most_contacts = self._search.renew(self.lists.pairs)
            self.lists.follow(pairs, most_contacts)
            self.stages.follow(pairs)
            return True
        self._read()
        if not np.isfinite(self.state.position).all():
            return False
        self.lists.renew(self.state)
        self._put()
        return True

    def _report(self, reduced: Reduced, travel: float) -> None:
        """Write the report of a step."""
        report, pairs, kick = self.state.report, reduced.of_pairs, reduced.of_kick
        g = self.model.gravity
        report[SMALLEST_GAP] = min(FAR, -pairs["OVERLAP"])
        report[STIFFEST], report[DEEPEST] = pairs["STIFFNESS"], pairs["RELATIVE"]
        report[DEEPEST_PAIR] = 0.0 if pairs["RELATIVE"] > 0.0 else -1.0
        report[ELASTIC_ENERGY] = pairs["ENERGY"] + reduced.rolling_energy
        report[CONTACT_WORK] = reduced.of_drift["WORK"] + kick["WORK"]
        report[LOAD_WORK] = reduced.of_drift["LOAD_WORK"] + kick["LOAD_WORK"]
        report[TRAVEL], report[TOUCHING] = max(travel, 0.0), 0.0
        report[LARGEST_SPEED] = root(kick["VELOCITY2"]) + root(kick["ROTATION2"])
        acceleration2 = max(g[0] * g[0] + g[1] * g[1] + g[2] * g[2], kick["ACCELERATION2"])
        report[LARGEST_ACCELERATION] = (
            root(acceleration2) + root(kick["SPIN_UP2"]) + max(kick["CENTRIPETAL"], 0.0)
        )
        self.state.contact_load[self.rows.count] = reduced.on_ground
        self.lists.touching = int(kick["CONTACTS"])
        self._is_finite = reduced.of_drift["BROKEN"] == 0.0
        if self.rows.count == 1:
            self._read_rows()  # its clearance limits the step

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
            self._read_rows()
        else:
            self._read()
        return self.model, self.state

    def pairs_of_all(self) -> BallPairs | None:
        """Pairs of balls of all rows, copied from the device."""
        self._read()
        return self.lists.balls

    def load(self, saved: Fields) -> None:
        """Restore a saved state, of a processor or of a device."""
        super().load(saved)
        self._put()


def root(square: float) -> float:
    """Root of a maximum of squares; 0 if all were NaN."""
    return math.sqrt(max(square, 0.0))
