"""All points of a lattice on an OpenCL device, in the place of `ranks/one.py`.

The host's points make the start and the neighbour lists, and compute outputs. An array is copied
into their state when it is first read after a step. While stepping, only the largest displacement
and speed are copied back.
"""

import math
from collections.abc import Sequence

from quintet.components.particle_dynamics.build import Built
from quintet.components.particle_dynamics.kernels.motion import EARLY
from quintet.components.particle_dynamics.opencl.device_points import ON_DEVICE, DevicePoints
from quintet.components.particle_dynamics.opencl.programs import lattice_program
from quintet.components.particle_dynamics.opencl.refusal import refuse_what_needs_the_processor
from quintet.components.particle_dynamics.opencl.stages import Stages
from quintet.components.particle_dynamics.params import ParticleLatticeParams
from quintet.components.particle_dynamics.ranks.one import OneRank
from quintet.components.particle_dynamics.ranks.terms import Terms
from quintet.components.particle_dynamics.state import TIME, Model, State
from quintet.components.shared.opencl.cells import Cells
from quintet.components.shared.opencl.devices import build, device_of, require_doubles
from quintet.components.shared.search.verlet_list import slack
from quintet.interfaces.component import Array, Fields, Resources

MOST_AT_ONCE = 50  # steps without a look at how far points have moved
LANES_OF_PROCESSORS = 4  # doubles in one of its vectors; other devices make lanes of points


class DeviceRows:
    """Steps all points on a device, and answers what holds for all of them.

    Parameters
    ----------
    resources : Resources
    params : ParticleLatticeParams
    state : State
        As it starts.
    model : Model
    terms : Terms
    """

    def __init__(
        self,
        resources: Resources,
        params: ParticleLatticeParams,
        state: State,
        model: Model,
        terms: Terms,
    ) -> None:
        refuse_what_needs_the_processor(params, resources.device)
        device = device_of(resources.device)
        require_doubles(device, resources.device)
        self._host = host = OneRank(state, model, terms)
        self.state, self.model, self.terms = state, model, terms
        self.ids, self.owned, self.bathed, self.skin = host.ids, host.owned, host.bathed, host.skin
        queue, lanes = device.queue(resources.threads), 1
        if device.is_processor:
            lanes = LANES_OF_PROCESSORS
        kernels = build(queue, lattice_program(terms, model, lanes))
        self.points = DevicePoints(queue, state, model, device.is_processor)
        self._cells = Cells(queue, kernels, device.is_processor)
        self._stages = Stages(kernels, self.points, model, terms)
        self._put()

    def _put(self) -> None:
        """Copy the host's state and lists to the device."""
        self.points.put()
        self._list()

    def _list(self) -> None:
        """Follow the host's lists."""
        self.points.list_pairs(self._host.lists.pairs)
        self._stages.follow(self.points)
        self._moved = 0.0  # m, furthest that a point is from where it was listed
        self._speed = math.inf  # m/s, of the fastest point; not known yet

    def read(self, *names: str) -> State:
        """State with some arrays as they are now, by default all."""
        for name in names or ON_DEVICE:
            self.points.get(name)
        return self.state

    def reduced(self, built: Built) -> Built:
        """What the lattice was built of, as far as this rank needs it."""
        return built

    def advance(self, steps: int, dt: float) -> int:
        """Advance until all steps are done or lists must be made; -1 if points moved too far."""
        points, has_baths = self.points, len(self.bathed) > 0
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
            self._moved, self._speed = math.sqrt(square), math.sqrt(speed2)
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
        driven = self.model.driven
        way = 2.0 * max(self._speed, abs(driven.amplitude * driven.frequency)) * dt
        return max(int(min(left / way, MOST_AT_ONCE)), 1) if way > 0.0 else MOST_AT_ONCE

    def _step(self, dt: float) -> None:
        energies, stages = self.state.energies, (self.model.stages * dt).tolist()
        for number, h in enumerate(stages):
            energies[TIME] += h
            end = float(energies[TIME])
            weight = dt if end > self.terms.averaged_from else 0.0
            self._stages.make(h, end, weight, number == len(stages) - 1)

    def average_from(self, time: float) -> None:
        """Average kinetic energies from a time [s] on."""
        self.terms = self.terms._replace(averaged_from=time)

    def needs_lists(self) -> bool:
        """Whether points that are not listed may interact soon."""
        return bool(slack(EARLY * self.skin, self._moved) < 0.0)

    def make_lists(self) -> None:
        """List the pairs of the points where they are now."""
        self.points.get("position")
        self._host.make_lists()
        self.points.put("listed")
        self._list()

    def all(self, name: str) -> Array:
        """Array of the state as it is now; not to be changed."""
        return self.points.get(name)

    def give(self, *names: str) -> Sequence[Array]:
        """Copies of some arrays of the state."""
        return [self.all(name).copy() for name in names]

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
