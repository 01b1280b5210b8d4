"""The fluid as a component: what happens in a step, in order."""

import math
from functools import partial

import numpy as np

from quintet.components.shared.threads import Team
from quintet.components.sph_fluid import MANIFEST, build, diagnostics, features, judgement
from quintet.components.sph_fluid.boundary.method import Films, MakeFilmRows, NoFilms
from quintet.components.sph_fluid.boundary.planar import in_plane, require_one_metre
from quintet.components.sph_fluid.boundary.samples import Samples
from quintet.components.sph_fluid.constants import constants
from quintet.components.sph_fluid.integration.method import StepTask
from quintet.components.sph_fluid.kernels import write_pressure
from quintet.components.sph_fluid.mass_balance.losses import begin_books, refuse_many_lost
from quintet.components.sph_fluid.pairs.interaction import Interaction
from quintet.components.sph_fluid.pairs.neighbour_lists import FluidLists
from quintet.components.sph_fluid.params import SphFluidParams
from quintet.components.sph_fluid.ports import SHOWS, requests
from quintet.components.sph_fluid.state import Array, State
from quintet.components.sph_fluid.view import view, wall_faces
from quintet.interfaces.component import (
    ONE_THREAD,
    Component,
    Fields,
    Keys,
    Resources,
    Totals,
)
from quintet.interfaces.faces import polygons

LOADS = frozenset({"surface_load.force"})


class SphFluid(Component):
    """A weakly compressible fluid in a tank, and the surfaces that move in it.

    A class of one's own may derive from it, with a `Params` that derives from `SphFluidParams`: in
    a scene it is a kind, ``module:Class``, with all ports and gauges of this one.
    """

    Params: type[SphFluidParams] = SphFluidParams

    manifest = MANIFEST
    shows = SHOWS
    compiles = True

    def __init__(self, params: SphFluidParams, resources: Resources = ONE_THREAD) -> None:
        self.params, (self.takes, self.gives) = params, self.ports_of(params)
        self.team, self.constants = Team(resources.threads), constants(params)
        self._notes = list(params.notes)
        self.state, self.samples = build.state(params), Samples()
        self.open_boundaries = features.open_boundaries(params)
        self.open_boundaries.start(self.state)
        self.items_vary = bool(params.boundary.inflow)
        self.walls_move = bool(params.boundary.pistons)
        write_pressure(self.constants, self.state.position_density, self.state.velocity_pressure)
        self.all_ranks, self.symmetry = features.ranks(params, resources)
        self.frame = features.frame(params, self.all_ranks)
        self.boundary = features.boundary_method(params, self.samples, self.frame)
        self.boundary.start(self.state)
        self.pistons = features.pistons(params, self.samples, self.all_ranks, self.symmetry)
        self.damping = features.damping(params, self.all_ranks)
        self.lists = FluidLists(params, self.samples, self.all_ranks)
        self.pressure_parts = features.pressure_parts(params, self.boundary)
        precision = features.precision(params, self.all_ranks)
        self.born = self.all_ranks.fluid(self.state)  # particles of the fluid
        parts = (self.boundary, self.symmetry, precision, self.samples, self.frame)
        self.pairs = Interaction(params, *parts)
        self.integration = features.integration(params)
        self.courant = features.courant_limit(params)
        self.films: Films = NoFilms()  # before there are surfaces
        self.make_film_rows: MakeFilmRows | None = None  # a device has its own
        self.filter = features.shepard_filter(params)
        self.gauges = features.gauges(params, self.symmetry, self.all_ranks, self.frame)

    def describe(self) -> Fields:
        """Request how surfaces are to be sampled."""
        return requests(self.params)

    def bind(self, static: Fields, joined: Keys) -> None:
        """Make room for the samples of the surfaces joined."""
        if "surface.volume" in static:
            self.frame.refuse_bodies()
            if self.params.dimensions == 2:
                require_one_metre(self.params)
        static = self.pistons.join(static)
        if "surface.volume" in static:
            self.all_ranks.join(static)
            self.samples.join(self.state, static, self.params.density)
            self.boundary.join(self.state, static)
            parts = (self.samples, self.all_ranks, self.make_film_rows)
            self.films = features.lubrication_films(self.params, *parts)
            self.films.join(self.state, static)
            self.pistons.start(self.state, self.boundary)

    def prime(self, fields: Fields) -> None:
        """Refuse bodies that begin out of place; remove fluid inside them, where a scene asks."""
        if not self.pistons.links:
            return
        body = self.samples.body[: self.pistons.links]
        places = self.symmetry.wrapped_samples(fields)["surface.position"]
        features.refuse_misplaced(self.params, body, places)
        is_begun = len(self.state.reference) > 0  # from another run, which has removed it
        if self.params.remove_inside_bodies and not is_begun:
            self._notes += features.remove_inside_bodies(
                self.state, self.samples, places, self.params
            )

    def stable_dt(self) -> float:
        """Largest step [s]; Monaghan & Kos 1999 and Morris 1997, from the rates of the last one."""
        h, state, viscosity = self.constants.smoothing.length, self.state, self.params.viscosity
        sound = h / (self.params.sound_speed + h * state.largest_approach)
        falling = math.inf
        if state.largest_acceleration > 0.0:
            falling = math.sqrt(h / state.largest_acceleration)
        # Where viscosity is a stress, what comes nearer feels three times what passes by.
        stiff = viscosity.kinematic * (3.0 if viscosity.form == "stress" else 1.0)
        viscous = 0.125 * h * h / stiff if stiff > 0.0 else math.inf
        limits = (self.courant * sound, self.params.courant * falling, viscous)
        return min(*limits, self.boundary.stable_dt)

    def take(self, fields: Fields) -> None:
        """Put the surface samples where they are in the coming step."""
        if self.pistons.links:
            if self.params.dimensions == 2:
                fields = in_plane(fields, self.params)
            fields = self.symmetry.wrapped_samples(fields)
            self.samples.move(self.state, fields)
            self.all_ranks.follow_samples(fields)
            self.boundary.follow_samples(self.state, fields)
            self.symmetry.require_before(fields["surface.position"])
            self.open_boundaries.refuse_samples(fields["surface.position"])

    def step(self, dt: float) -> None:
        """Advance by dt [s]."""
        self.samples.require_placed()
        self.all_ranks.begin_step()
        self.pistons.place(self.state, self.boundary, dt)
        if self.lists.need_rebuild(self.state, self.boundary, dt):
            diagnostics.refuse_dense(self.state, self.params, self.all_ranks)
            self.symmetry.wrap(self.state)
            self.open_boundaries.renew(self.state)
            self.lists.sort(self.state)
            refuse_many_lost(self.state, self.params)
            self._list()
        if self.filter and self.filter.is_due(self.state):
            self.symmetry.write_images(self.state)
            self.filter.apply(self.state, self.lists.arrays, self.team)
        rows, rate = self.boundary.rows_with_density_rate(self.state), self.pairs.rates.rate
        if self.state.steps % judgement.EVERY == 0:
            isolated = not len(self.samples.volume) and self.params.boundary.is_still
            judgement.note(self.state, self.params, self.totals(), isolated, self.all_ranks)
        parts = (self.team, self.films, self.all_ranks)
        apply = partial(self.pairs.apply_forces, self.state, self.lists.arrays, dt, *parts)
        task = StepTask(dt, rows, rate, partial(self._compute_rates, dt), apply)
        moved, state = self.integration.step(self.state, task, self.team), self.state
        shift2, failures, fastest, approach = self.all_ranks.greatest(
            max(shift2 for shift2, _ in moved),
            max(failures for _, failures in moved),
            state.largest_acceleration,
            state.largest_approach,
        )
        if failures:
            raise diagnostics.failure(state, self.params, dt, self.all_ranks)
        self.symmetry.reflect_crossed(state)
        state.moved = math.sqrt(shift2)
        state.largest_acceleration, state.largest_approach = fastest, approach
        state.last_dt, state.steps = dt, state.steps + 1
        self.damping.apply(state, dt)
        self.frame.advance(dt)
        self.pistons.advance(state, dt)
        self.all_ranks.end_step()

    def _list(self) -> None:
        """List what is near, and make room for what is summed over it."""
        self.lists.make(self.state, self.boundary, self.symmetry, self.team)
        self.boundary.resize(self.state, self.symmetry)
        self.pairs.resize(self.state)
        self.films.resize(self.state, self.lists.arrays)
        self.open_boundaries.resize(self.state)

    def _compute_rates(self, dt: float, share: float) -> None:
        """Accelerations and rates of density, of the state as it is at a share of the step."""
        self.frame.set_time(share * dt)
        for part in self.pressure_parts:
            if part.reads_images:
                self.symmetry.write_images(self.state)
            part.write_pressure(self.state, self.lists.arrays, self.team)
        self.symmetry.write_images(self.state)
        self.pairs.compute(self.state, self.lists.arrays, self.team)
        self.open_boundaries.hold(self.state, self.pairs.rates)

    def check(self) -> None:
        """Refuse a particle whose velocity is not finite."""
        diagnostics.check(self.state, self.params)

    def give(self, wanted: Keys) -> Fields:
        """Copy out the mean force of the last step on each sample, and what gauges read now."""
        outputs: dict[str, Array] = {}
        if self.gauges and not wanted <= LOADS:
            if len(self.state.reference):
                self.symmetry.write_images(self.state)
            outputs.update(self.gauges.read(self.state, self.lists.arrays))
        if wanted & LOADS:
            outputs["surface_load.force"] = self.pistons.forces_of_links(self.state).copy()
        return {key: outputs[key] for key in wanted}

    def save(self) -> Fields:
        """Copy out all state; the neighbour list is kept as the places it was made from."""
        gathered = self.all_ranks.whole(self.state).save()
        part_states = self.frame.save() | self.pistons.save() | self.open_boundaries.save()
        part_states |= self.damping.save() | {"reach": np.array(self.lists.reach)}
        return gathered | {"placed": np.array(self.samples.placed)} | part_states

    def load(self, state: Fields) -> None:
        """Come back to a saved state, of this run or of another that it begins from."""
        self.open_boundaries.refuse_other(state)
        limit = math.inf if self.items_vary else self.born
        diagnostics.refuse_other_samples(state, len(self.samples.volume))
        diagnostics.refuse_other_particles(state, limit, self.all_ranks.boundary(self.state))
        self.state, self.samples.placed = State.load(state), bool(state["placed"])
        self.state.fit_damper(self.params.acoustic_damper > 0.0)
        self.all_ranks.load(self.state)
        self.samples.find_rows(self.state)
        self.boundary.load(self.state)
        self.films.load(self.state)
        self.frame.load(state)
        self.pistons.load(state)
        self.damping.load(state)
        if len(self.state.reference):
            self._list()

    def begin_from(self, state: Fields) -> None:
        """Begin from the state of another run; motions, books and warnings begin with this one."""
        diagnostics.refuse_other_reach(state, self.lists.reach)
        clocks = {*self.frame.save(), *self.pistons.save(), *self.damping.save()}
        super().begin_from({key: rows for key, rows in state.items() if key not in clocks})
        begin_books(self.state, self.all_ranks.fluid(self.state))
        self.pistons.refuse_jump(state)

    def totals(self) -> Totals:
        """Mass, momentum and energies of the fluid that is left, in the frame of its tank."""
        totals = diagnostics.totals(self.state, self.params, self.constants, self.all_ranks)
        if len(self.state.reference):
            self.symmetry.write_images(self.state)
            totals.internal += self.boundary.energy(self.state, self.lists.arrays, self.team)
        totals.work += self.frame.work + self.pistons.work + self.damping.work
        return totals

    def view(self) -> Fields:
        """Fluid particles in the order of their birth."""
        return {**view(self.all_ranks.whole(self.state)), **self.all_ranks.owners(self.state)}

    def notes(self) -> tuple[str, ...]:
        """What was not as a scene may have meant it: masses, films that are missing."""
        return *self._notes, *self.films.notes

    def warnings(self) -> dict[str, str]:
        """Compression, fluid that leaves its tank, and energy from nowhere."""
        mass = self.constants.mass * self.params.slab_thickness
        return judgement.warnings(self.state, self.params, mass, self.all_ranks)

    def walls(self) -> Fields:
        """Return the tank's closed faces, the obstacles in it, and pistons where they are now."""
        return polygons([*wall_faces(self.params), *self.pistons.faces()])

    def items(self) -> int:
        """Fluid, wall and sample particles."""
        return self.all_ranks.fluid(self.state) + self.all_ranks.boundary(self.state)
