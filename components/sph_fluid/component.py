"""The fluid as a component: what happens in a step, in order."""

import math
from typing import Any

import numpy as np

from quintet.components.shared.search.cells import grid_around, sorted_into
from quintet.components.shared.search.neighbours import NeighbourLists, neighbours_within
from quintet.components.shared.smoothing.cubic_spline import SUPPORT
from quintet.components.shared.threads import Team
from quintet.components.sph_fluid import build, lists
from quintet.components.sph_fluid.gauge_ports import gauge_ports
from quintet.components.sph_fluid.kernels import advance, interact, press, push_samples, shift
from quintet.components.sph_fluid.laws import AHEAD, constants
from quintet.components.sph_fluid.params import SphFluidParams
from quintet.components.sph_fluid.plane import in_plane, require_one_metre
from quintet.components.sph_fluid.state import Array, State, Whole
from quintet.components.sph_fluid.sums import failure, refuse_dense, totals, view
from quintet.components.sph_fluid.surface import chosen, surface
from quintet.components.sph_fluid.terms import bulk, damped, friction, mark, terms
from quintet.interfaces.component import (
    ONE_THREAD,
    Component,
    Fields,
    Keys,
    Port,
    Resources,
    Totals,
)
from quintet.interfaces.errors import OrderError, StepError
from quintet.interfaces.ports import SURFACE_LOAD

LOADS = frozenset({"surface_load.force"})


class SphFluid(Component):
    """A weakly compressible fluid in a tank, and the surfaces that move in it."""

    def __init__(self, params: SphFluidParams, resources: Resources = ONE_THREAD) -> None:
        self.params, self.gives = params, (SURFACE_LOAD, *gauge_ports(params))
        self.takes: tuple[Port, ...] = (surface(params),)
        self.fluid = constants(params)
        self.team, self.state = Team(resources.threads), build.state(params)
        press(self.fluid, self.state.place, self.state.motion)
        self.near = NeighbourLists()
        self.rows: Whole = np.zeros(0, np.int64)  # (samples,) where the samples are in the state
        self.held: Whole = self.rows  # (k,) samples that a contact potential holds
        self.steepest = math.inf  # s, step that it allows
        self.terms = terms(params, params.boundary.method == "potential")
        if self.terms.hold is not None:
            self.steepest = self.terms.hold.walls(self.state)
        self.listed: Whole = self.rows  # (samples,) and where in the neighbour lists
        self.rate = np.empty((0, 4))  # (n, 4) m/s2, m/s2, m/s2, kg/(m3 s); of the present step
        self.drift: Array | None = None  # (fluid, 3) m/s, XSPH's; where it is on
        self.volume = np.empty(0)  # (samples,) m3
        self.placed = True
        if params.mirrored:
            from quintet.components.sph_fluid.mdbc import mirrors

            self.state.mirror = mirrors(params)
        self.images = None
        if params.boundary.symmetry:
            from quintet.components.sph_fluid.symmetry import Images

            self.images = Images(params)

    def describe(self) -> Fields:
        """At which spacing, and how deep, surfaces should be sampled."""
        planar = {"surface.dimensions": np.array([2.0])} if self.params.dimensions == 2 else {}
        return planar | {
            "surface.spacing": np.array([self.params.spacing]),
            "surface.depth": np.array([SUPPORT * self.fluid.smoothing.length]),
            "surface.inset": np.array([self.params.boundary.sample_depth * self.params.spacing]),
        }

    def bind(self, static: Fields, joined: Keys) -> None:
        """Make room for the samples of the surfaces joined."""
        if "surface.volume" in static:
            if self.params.dimensions == 2:
                require_one_metre(self.params)
            count = len(static["surface.volume"])
            self.state.add_samples(count, self.params.density, self.params.mirrored)
            if self.params.boundary.method == "dbc":
                press(self.fluid, self.state.place, self.state.motion)
            self.rows = self.state.sample_rows()
            self.placed = False
            self.body = np.array(static["surface.body"])
            self.volume = np.array(static["surface.volume"])
            self.state.film = np.zeros((count if self.params.boundary.lubrication_films else 0, 3))
            self.held = chosen(static, self.params)
            if len(self.held):
                self.terms = terms(self.params, True)

    def stable_dt(self) -> float:
        """Largest step [s]; Monaghan & Kos 1999 and Morris 1997, from the rates of the last one."""
        h, state = self.fluid.smoothing.length, self.state
        sound = h / (self.params.sound_speed + h * state.approach)
        pull = math.sqrt(h / state.acceleration) if state.acceleration > 0.0 else math.inf
        # Where friction is a stress, what comes nearer feels three times what passes by.
        stiff = self.params.viscosity.kinematic * (
            3.0 if self.params.viscosity.form == "stress" else 1.0
        )
        viscous = 0.125 * h * h / stiff if stiff > 0.0 else math.inf
        return min(self.terms.courant * sound, self.params.courant * pull, viscous, self.steepest)

    def take(self, fields: Fields) -> None:
        """Put the surface samples where they are in the coming step."""
        if len(self.rows):
            if self.params.dimensions == 2:
                fields = in_plane(fields, self.params)
            self.state.place[self.rows, :3] = fields["surface.position"]
            self.state.motion[self.rows, :3] = fields["surface.velocity"]
            if self.params.mirrored:
                self.state.mirror[self.rows - self.state.fluid] = fields["surface.mirror"]
            if self.terms.hold is not None:
                held = self.rows[self.held]
                self.steepest = self.terms.hold.bodies(self.state, held, self.body[self.held])
            if self.images is not None:
                self.images.refuse(fields["surface.position"])
            self.placed = True

    def step(self, dt: float) -> None:
        """Advance by dt [s]."""
        if not self.placed:
            raise OrderError("step: surface samples must be placed first. Call take before it.")
        if self._list_is_old(dt):
            refuse_dense(self.state, self.params)
            self._sort()
            self._list()
        self._filter_density()
        if self.params.integration == "symplectic":
            self._verlet(dt)
            return
        self._interact()
        self._push(dt)
        self._drift(dt)
        self._advance(dt)

    def _list_is_old(self, dt: float = 0.0) -> bool:
        return lists.are_old(self.state, self.rows, self.params, dt)

    def _sort(self) -> None:
        """Bring particles that are near into near rows; drop those that left the domain."""
        state, split = self.state, self.state.fluid
        kept = np.flatnonzero(lists.inside(state.place[:split], self.params))
        if not len(kept):
            raise StepError("step: all fluid has left the domain. Check the walls and gravity.")
        fluid, boundary = state.place.take(kept, axis=0), state.place[split : state.particles]
        grid = grid_around(fluid, lists.skin(self.params).reach)
        state.lost += split - len(kept)
        state.keep(kept[sorted_into(fluid, grid)[2]], sorted_into(boundary, grid)[2])
        state.reference, state.moved = np.concatenate([state.place[:, :3], state.mirror]), 0.0
        self.rows = state.sample_rows()

    @property
    def _advancing(self) -> int:
        """Rows whose density has a rate: all where walls are dynamic, or the fluid's."""
        return self.state.particles if self.params.boundary.method == "dbc" else self.state.fluid

    def _list(self) -> None:
        state, points = self.state, self.state.reference[: self.state.particles]
        query_points, self.listed = lists.query_points(state, self.rows, self.params)
        reach, after = lists.skin(self.params).reach, (self.team, query_points, self.near.list)
        if self.images is None:
            self.near = neighbours_within(reach, points, state.fluid, *after)
        else:
            self.near = self.images.neighbours(state, reach, *after)
        self.bulk = bulk(self.volume, self.rows, len(state.place), self.params)
        if self.params.mirrored and self.terms.contact is not None:
            self.terms = mark(self.terms, self.rows[self.held], len(state.place), self.params)
        if self.images is not None:
            self.images.copy(state.particles, self.bulk, self.terms.some)
        if len(state.film):
            from quintet.components.sph_fluid.facing import film

            self.film = film(state, self.body, self.volume, self.params.spacing, self.fluid)
        if self.params.precision == "float32":
            from quintet.components.sph_fluid.single import Single

            self.single = Single(state, self.fluid.density)
        self.rate = np.empty_like(state.place)
        if self.params.xsph > 0.0:
            self.drift = np.empty((state.fluid, 3))

    def _filter_density(self) -> None:
        state, every = self.state, self.params.shepard_every
        if every > 0 and state.steps % every == every - 1:
            from quintet.components.sph_fluid.shepard import smooth

            smooth(state, self.near.arrays, self.fluid, self.team)

    def _pairs(self) -> tuple[tuple[Any, ...], Any]:
        """What the loops over pairs take: particles, lists and laws; and friction."""
        state, near = self.state, self.near.arrays
        rubbing = friction(self.params, state, near, self.fluid, self.team)
        if self.images is not None and rubbing is not None:
            self.images.turn(rubbing.seen, state.particles)
        arrays: tuple[Any, Any] = state.place, state.motion
        if self.params.precision == "float32":
            from quintet.components.shared.single_precision import rounded

            rubbing, arrays = rounded(rubbing), self.single.of(state, self.team)
        return (*arrays, near, self.terms.fluid), rubbing

    def _interact(self) -> None:
        """Forces and rates of density."""
        state, law, gravity = self.state, self.terms, self.params.gravity
        self._mirror()
        if self.params.mirrored:
            from quintet.components.sph_fluid.mdbc import press_walls

            samples = (self.rows, self.listed, self.held)
            press_walls(state, self.near.arrays, *samples, self.params, self.team)
            self._mirror()
        squeeze = damped(state, self.near.arrays, self.params, self.team, self._mirror)
        self.pairs = pairs, rubbing = self._pairs()
        terms = (self.rate, self.drift, law.diffusion, rubbing, law.guard, law.contact)
        pairs = (state.fluid, *pairs, gravity)
        found = self.team.run(interact, self._advancing, *pairs, *terms, self.bulk, squeeze)
        state.acceleration = math.sqrt(max(greatest for greatest, _ in found))
        state.approach = max(fastest for _, fastest in found)

    def _mirror(self) -> None:
        if self.images is not None:
            self.images.fill(self.state)

    def _push(self, dt: float) -> None:
        """Push the samples as they pushed the fluid."""
        state, law, (pairs, rubbing) = self.state, self.terms, self.pairs
        if len(self.rows):
            on_samples = (rubbing, law.guard, law.contact, self.bulk, state.force)
            self.team.run(push_samples, len(self.rows), self.rows, self.listed, *pairs, *on_samples)
        if len(state.film):
            from quintet.components.sph_fluid.gap import push

            push(self.film, state, self.near.arrays, dt, self.params, self.fluid)

    def _drift(self, dt: float) -> None:
        """XSPH: move with the neighbours' mean velocity."""
        if self.drift is not None:
            time = self.params.xsph * dt
            self.team.run(shift, self.state.fluid, time, self.drift, self.state.place)

    def _verlet(self, dt: float) -> None:
        from quintet.components.sph_fluid import symplectic

        def act() -> None:
            self._push(dt)
            self._drift(dt)

        numbers = (self._advancing, dt, self.params.spacing, self.fluid, self.rate)
        moved = symplectic.step(self.state, self.team, *numbers, self._interact, act)
        self._finish(moved, dt)

    def _advance(self, dt: float) -> None:
        state = self.state
        # At most twice as far as the last step: extrapolating from a sliver would magnify noise.
        ahead = AHEAD * min(dt / state.last_dt, 2.0) if state.last_dt > 0.0 else 0.0
        arrays = (self.rate, state.reference, state.place, state.motion, state.before)
        numbers = (state.fluid, dt, ahead, self.params.spacing, self.fluid)
        self._finish(self.team.run(advance, self._advancing, *numbers, *arrays), dt)

    def _finish(self, moved: list[tuple[float, int]], dt: float) -> None:
        state = self.state
        if any(failed for _, failed in moved):
            raise StepError(failure(self.state, self.params, dt))
        if self.images is not None:
            self.images.turn_back(state)
        self._mirror()
        state.moved = math.sqrt(max(distance for distance, _ in moved))
        state.last_dt, state.steps = dt, state.steps + 1

    def give(self, wanted: Keys) -> Fields:
        """Copy out the mean force of the last step on each sample, and what gauges read now."""
        given = {} if wanted <= LOADS else dict(self._read_gauges())
        if wanted & LOADS:
            given["surface_load.force"] = self.state.force.copy()
        return {key: given[key] for key in wanted}

    def _read_gauges(self) -> Fields:
        from quintet.components.sph_fluid.gauges import Gauges

        return Gauges(self.params, self.fluid).read(self.state, self.near.arrays)

    def save(self) -> Fields:
        """Copy out all state; the neighbour list is kept as the places it was made from."""
        return self.state.save() | {"placed": np.array(self.placed)}

    def load(self, state: Fields) -> None:
        """Come back to a saved state."""
        self.placed = bool(state["placed"])
        self.state = State.load(state)
        self.rows = self.state.sample_rows()
        if self.terms.hold is not None:
            self.steepest = self.terms.hold.limit(self.state, self.rows[self.held])
        if len(self.state.reference):
            self._list()

    def totals(self) -> Totals:
        """Mass, momentum and energies of the fluid that is left."""
        found = totals(self.state, self.params, self.fluid)
        if (law := self.terms.contact) is not None and len(self.state.reference):
            from quintet.components.sph_fluid.contact import energy

            found.internal += energy(self.state, self.near.arrays, law, self.params, self.team)
        return found

    def view(self) -> Fields:
        """Fluid particles in the order of their birth."""
        return view(self.state)

    def items(self) -> int:
        """Fluid, wall and sample particles."""
        return self.state.particles
