"""Points of a lattice on an OpenCL device, in the place of `ranks/one.py` or `ranks/several.py`.

The host's points make the start and the neighbour lists, and compute outputs. An array is copied
into their state when it is first read after a step. While stepping, only the largest displacement
and speed are copied back. On several ranks each has a device, or a part of one; copies of other
ranks' points are brought up to date in each stage.
"""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

from quintet.components.particle_dynamics.build import Built
from quintet.components.particle_dynamics.kernels.motion import EARLY
from quintet.components.particle_dynamics.opencl.device_points import ON_DEVICE, DevicePoints
from quintet.components.particle_dynamics.opencl.other_ranks import OtherRanks
from quintet.components.particle_dynamics.opencl.programs import (
    LANES_OF_PROCESSORS,
    lattice_program,
)
from quintet.components.particle_dynamics.opencl.stages import Stages
from quintet.components.particle_dynamics.state import TIME, State, Whole
from quintet.components.shared.opencl.cells import Cells
from quintet.components.shared.opencl.devices import build, require_doubles
from quintet.components.shared.opencl.ranks import device_and_queue
from quintet.components.shared.search.verlet_list import slack
from quintet.interfaces.component import Array, Fields, Resources

if TYPE_CHECKING:
    from quintet.components.particle_dynamics.ranks.one import OneRank
    from quintet.components.particle_dynamics.ranks.several import SeveralRanks

MOST_AT_ONCE = 50  # steps without a look at how far points have moved


class DeviceRows:
    """Steps points on a device, all or those of a rank, and answers what holds for all of them.

    Parameters
    ----------
    resources : Resources
    host : OneRank or SeveralRanks
        The same points on the host.
    other_ranks : OtherRanks
        From which it gets copies of points.
    """

    def __init__(
        self, resources: Resources, host: "OneRank | SeveralRanks", other_ranks: OtherRanks
    ) -> None:
        device, self._queue = device_and_queue(resources)
        require_doubles(device, resources.device)
        self._host, self._other_ranks = host, other_ranks
        self.bathed, self.ids, self.skin = host.bathed, host.ids, host.skin
        self._by_rows = device.is_processor
        lanes = LANES_OF_PROCESSORS if device.is_processor else 1
        program = lattice_program(host.terms, host.model, lanes)
        self._kernels = build(self._queue, program + other_ranks.source)
        self._cells = Cells(self._queue, self._kernels, device.is_processor)
        other_ranks.connect(self._queue, self._kernels)
        driven = host.model.driven
        speed = abs(driven.amplitude * driven.frequency)
        self._drive: float = other_ranks.greatest(speed)[0]  # m/s
        self._put()

    @property
    def state(self) -> State:
        """State of the host, with arrays of an earlier time that have not been read since."""
        return self._host.state

    @property
    def owned(self) -> Whole | slice:
        """Rows of this rank's points."""
        return self._host.owned

    def _put(self) -> None:
        """Copy the host's state and lists to the device, after freeing those that it has."""
        host = self._host
        self._other_ranks.release()
        for name in ("_stages", "points"):
            vars(self).pop(name, None)
        self.points = DevicePoints(self._queue, host.state, host.model, host.copies, self._by_rows)
        self._stages = Stages(self._kernels, self.points, host.model, host.terms, self._other_ranks)
        self._other_ranks.follow(self.points)
        self._list()

    def _list(self) -> None:
        """Follow the host's lists."""
        self.points.list_pairs(self._host.pairs)
        self._stages.follow(self.points)
        self._moved = 0.0  # m, furthest that a point of any rank is from where it was listed
        self._speed = math.inf  # m/s, of the fastest point; not known yet

    def read(self, *names: str) -> State:
        """State with some arrays as they are now, by default all."""
        for name in names or ON_DEVICE:
            self.points.get(name)
        return self.state

    def reduced(self, built: Built) -> Built:
        """What the lattice was built of, as far as this rank needs it."""
        return self._host.reduced(built)

    def advance(self, steps: int, dt: float) -> int:
        """Advance until all steps are done or lists must be made; -1 if points moved too far."""
        points, has_baths = self.points, len(self.bathed) > 0  # of this rank
        if has_baths:
            points.temperature.put(self.state.temperature)
        points.forget()
        done = self._advance(steps, dt)
        if has_baths:
            points.get("heat")
        return done

    def _advance(self, steps: int, dt: float) -> int:
        """Advance; that points moved too far is noticed up to MOST_AT_ONCE steps later."""
        done = 0
        while done < steps:
            ahead = min(self._unchecked_steps(dt), steps - done)
            for _ in range(ahead):
                self._step(dt)
            done += ahead
            square, speed2 = self._cells.greatest(self.points.extremes, self.points.count)[:2]
            self.points.extremes.clear()
            self._moved, self._speed = self._other_ranks.greatest(
                math.sqrt(square), math.sqrt(speed2)
            )
            if not slack(self.skin, self._moved) > 0.0:
                return -1
            if self.needs_lists():
                break
        return done

    def _unchecked_steps(self, dt: float) -> int:
        """Steps that may be made at once: lists hold even if the fastest point gets twice as fast.

        A driven point gets faster than that from where it turns: its greatest speed counts.

        What a step brings back is waited for, which takes as long as the steps of some thousand
        points.
        """
        left = 0.5 * EARLY * self.skin - self._moved  # m, as `slack` has it
        way = 2.0 * max(self._speed, self._drive) * dt
        return max(int(min(left / way, MOST_AT_ONCE)), 1) if way > 0.0 else MOST_AT_ONCE

    def _step(self, dt: float) -> None:
        energies, host = self.state.energies, self._host
        stages = (host.model.stages * dt).tolist()
        for number, h in enumerate(stages):
            energies[TIME] += h
            end = float(energies[TIME])
            weight = dt if end > host.terms.averaged_from else 0.0
            self._stages.make(h, end, weight, number == len(stages) - 1)

    def average_from(self, time: float) -> None:
        """Average kinetic energies from a time [s] on."""
        self._host.average_from(time)

    def needs_lists(self) -> bool:
        """Whether points that are not listed may interact soon."""
        return bool(slack(EARLY * self.skin, self._moved) < 0.0)

    def make_lists(self) -> None:
        """List the pairs of the points where they are now."""
        if self._other_ranks.are_there:  # points have new rows then
            self.read()
            self._host.make_lists()
            self._put()
            return
        self.points.get("position")
        self._host.make_lists()
        self.points.put("listed")
        self._list()

    def all(self, name: str) -> Array:
        """Rows of all ranks of an array of the state, on rank 0; not to be changed."""
        self.points.get(name)
        return self._host.all(name)

    def give(self, *names: str) -> Sequence[Array]:
        """Copies of the rows of all points, on rank 0, of some arrays of the state."""
        self.read(*names)
        return self._host.give(*names)

    def pair_energies(self) -> Array:
        """Potential energy (n,) J of the pairs that are listed for each point."""
        self.points.get("position")
        return self._host.pair_energies()

    def tether_energies(self) -> Array:
        """Twice the potential energy (b,) J of the tether of each bathed point."""
        self.points.get("position")
        return self._host.tether_energies()

    def least_near(self) -> tuple[int, int]:
        """Fewest points within the cut-off of a point, and the first point that has so few."""
        self.points.get("position")
        return self._host.least_near()

    def intact(self) -> float:
        """Share of the bonds between nearest points that have 0.8 to 1.2 spacings."""
        self.points.get("position")
        return self._host.intact()

    def furthest(self) -> int:
        """The point that has moved furthest since lists were made, or is nowhere."""
        self.points.get("position")
        return self._host.furthest()

    def save(self) -> dict[str, Array]:
        """Copy out all arrays of the state."""
        self.read()
        return self._host.save()

    def load(self, state: Fields) -> None:
        """Restore what was saved, here or on the processor."""
        self._host.load(state)
        self._put()
