"""Elastic-plastic bodies of particles, stepped by velocity Verlet."""

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from quintet.components.shared.threads import Team
from quintet.components.sph_solid import MANIFEST
from quintet.components.sph_solid.begin import refuse_thin_bodies, restarted
from quintet.components.sph_solid.build import gauged, initial_state, materials, pair_law
from quintet.components.sph_solid.diagnostics import check, failure, totals
from quintet.components.sph_solid.features import pair_sums, partner_faces, ranks
from quintet.components.sph_solid.gauges import bodies, gauges, levels
from quintet.components.sph_solid.glue import add_work, glued_rows, pull, release, write_forces
from quintet.components.sph_solid.judgement import ENERGY_EVERY, Judge
from quintet.components.sph_solid.kernels.motion import (
    drift_half,
    kick_and_drift_half,
    kick_and_heat,
)
from quintet.components.sph_solid.kernels.pairs import Forces
from quintet.components.sph_solid.materials import Materials
from quintet.components.sph_solid.method import method, viscosity_note
from quintet.components.sph_solid.neighbours import SolidLists
from quintet.components.sph_solid.params import SphSolidParams
from quintet.components.sph_solid.ports import SHOWS
from quintet.components.sph_solid.ranks.method import extremes
from quintet.components.sph_solid.state import Array, State
from quintet.components.sph_solid.view import view
from quintet.interfaces.component import (
    ONE_THREAD,
    Component,
    Fields,
    Keys,
    Resources,
    Totals,
)

if TYPE_CHECKING:
    from quintet.components.sph_solid.partner_faces import PartnerFaces

FEWEST = 500  # particles that are worth handing to another thread
LOAD, REACTION = "glued_load.force", "contact_load.force"
NEEDED_BY_LEVELS = ("body", "failed", "position")
NO_LEVELS = dict.fromkeys(("levels.highest", "levels.lowest"), np.zeros(0))  # rank 0 answers


class SphSolid(Component):
    """Moves elastic-plastic bodies of particles, glued to a partner's mesh or touching it.

    A class of one's own may derive from it, with a `Params` that derives from `SphSolidParams`: in
    a scene it is a kind, ``module:Class``, with all ports of this one.
    """

    Params: type[SphSolidParams] = SphSolidParams
    manifest = MANIFEST
    shows = SHOWS
    compiles = True

    def __init__(self, params: SphSolidParams, resources: Resources = ONE_THREAD) -> None:
        self.params, (self.takes, self.gives) = params, self.ports_of(params)
        self.team, self.law = Team(resources.threads, FEWEST), pair_law(params)
        laws, numbers = materials(params)
        self.materials = Materials(laws, self.team)
        self.state = initial_state(params, laws, numbers)
        self.judge = Judge(self.state, laws, params)
        self.gauged = gauged(self.state.position, params)
        self.all_ranks = ranks(params, resources)
        self.lists = SolidLists(params, self.team, self.all_ranks)
        self.sums = pair_sums(params, self.team)
        self.is_carried = False  # whether a mesh carries the glued particles
        self.faces: PartnerFaces | None = None  # of a partner, that particles touch
        self._begin()

    def describe(self) -> Fields:
        """Return positions and masses of glued particles."""
        if not self.params.glued:
            return {}
        state, rows = self.state, glued_rows(self.state)
        columns = np.column_stack([state.position[rows], self.materials.mass(state)[rows]])
        of_all = self.all_ranks.all_rows(state.glue[rows], columns)
        return {
            "glued_load.position": of_all[:, :3].copy(),
            "glued_load.mass": of_all[:, 3].copy(),
        }

    def bind(self, static: Fields, joined: Keys) -> None:
        """Take down whether a mesh carries the glued particles."""
        self.is_carried = "glued" in joined or "glued_load" in joined
        laws, spacing = self.materials.laws, self.params.spacing
        self.faces = partner_faces(static, joined, self.state, laws, spacing)
        if self.faces:
            self.faces.make(self.state, self.materials)

    def stable_dt(self) -> float:
        """Return the share `courant` of the smallest stable step of all particles, or contact's."""
        free = self.params.courant * self.state.bound
        return min(free, self.faces.penalty.stable_step(self.state.bound)) if self.faces else free

    def take(self, fields: Fields) -> None:
        """Set which particles are still glued, their velocities, and faces in the coming step."""
        state = self.state
        if self.faces:
            self.faces.penalty.take(fields)
        if "glue_activity.active" in fields:
            active, mass = fields["glue_activity.active"], self.materials.mass(state)
            release(state, active, mass, self.params.gravity, self.all_ranks)
        if "glued.velocity" in fields:
            state.pulled[:] = fields["glued.velocity"] * state.active[:, None]

    def step(self, dt: float) -> None:
        """Advance by exactly dt [s]; stresses follow the motion in the step's middle."""
        state, rows = self.state, self.rows
        self.all_ranks.begin_step()
        if state.steps % ENERGY_EVERY == 0:
            mass = self.materials.mass(state)
            touching = self.faces.penalty.numbers if self.faces else None
            self.judge.note(state, mass, self.sums, self.params.gravity, self.all_ranks, touching)
        pull(state)
        add_work(state, dt)
        if self.faces:
            self.faces.kick(state, dt)
        displaced = self.team.run(
            kick_and_drift_half, state.particles, dt, state.position, state.velocity,
            state.acceleration, state.failed, state.volume, state.reference, rows.place,
            rows.motion,
        )  # fmt: skip
        ends = np.array(displaced)
        low, high = extremes(self.all_ranks, ends[:, :3], ends[:, 3:])
        spread = self.lists.spread(low, high)
        if self.lists.may_miss(state, spread, rows.place[: state.particles], dt):
            self._search(dt)
        rows = self.rows
        self.lists.images.write_all(state.particles, rows.place, rows.motion)
        self.sums.write_gradients(rows, self.law)
        self.materials.advance(rows, dt)
        self.materials.write_stresses(state, rows, self.law)
        self.team.run(
            drift_half, state.particles, dt, state.position, state.velocity, state.acceleration,
            state.sound, rows.place, rows.motion,
        )  # fmt: skip
        before = None if self.sums.heats is None else state.acceleration.copy()
        self._write_accelerations()
        if before is not None and self.sums.heats is not None:
            # The heating was computed with velocities that the old acceleration predicted.
            change = state.acceleration - before
            state.heating -= 0.5 * dt * (self.sums.heats * change).sum(axis=1)
        squares = self.team.run(
            kick_and_heat, state.particles, dt, state.velocity, state.acceleration, state.heating,
            state.energy,
        )  # fmt: skip
        state.time += dt
        state.steps += 1
        add_work(state, dt)
        wrong = float(not math.isfinite(sum(squares)))
        if self.all_ranks.greatest(np.array([wrong]))[0]:
            raise failure(state, self.params, dt, self.all_ranks)
        self.all_ranks.end_step()

    def check(self) -> None:
        """Refuse a particle whose energy, strain, temperature or damage is not finite."""
        check(self.state, self.params)

    def warnings(self) -> Mapping[str, str]:
        """Reasons why the results may be wrong: energy that appears, numerical fracture."""
        texts = self.judge.warnings(self.state, self.all_ranks)
        return texts | self.faces.penalty.warnings() if self.faces else texts

    def notes(self) -> tuple[str, ...]:
        """Settings that would be better for a slow impact."""
        note = viscosity_note(self.params)
        return (note,) if note else ()

    def _begin(self) -> None:
        """Find accelerations and the stable step at the start, where nothing is strained."""
        state = self.state
        self.lists.widen(state, 0.0)
        self.all_ranks.sort(state, state.position)
        self._list()
        self.rows.fill(state, state.position, state.failed)
        self.lists.images.write_all(state.particles, self.rows.place, self.rows.motion)
        self.sums.write_gradients(self.rows, self.law)
        self.materials.write_stresses(state, self.rows, self.law)
        self.rows.motion[: state.particles, 3] = state.sound
        self._write_accelerations()
        if self.lists.are_for_good:
            refuse_thin_bodies(state, self.rows.gradient, self.all_ranks)

    def _search(self, dt: float) -> None:
        """Sort particles by their places in the middle of a step of dt [s], and list neighbours."""
        state = self.state
        if not self.lists.sort(state, dt):
            raise failure(state, self.params, dt, self.all_ranks)
        self._list()
        self.rows.fill(state, state.reference, state.failed)

    def _list(self) -> None:
        """Make lists from the references, and find the rows of materials and fixed particles."""
        state = self.state
        self.rows = self.lists.make(state)
        self.sums.make(state, self.lists)
        self.materials.take(state)
        self.fixed_rows = np.flatnonzero(state.fixed)
        self.moves = ((state.fixed[self.fixed_rows, None] >> np.arange(3)) & 1) == 0
        if self.faces:
            self.faces.make(state, self.materials)

    def _write_accelerations(self) -> None:
        """Write accelerations, forces on glued particles and the next stable step."""
        state, rows, count = self.state, self.rows, self.state.particles
        self.lists.images.write_all(count, rows.place, rows.motion, rows.stress)
        forces = Forces(state.acceleration, state.heating)
        bound = self.sums.write_accelerations(rows, self.law, forces)
        state.bound = -float(self.all_ranks.greatest(np.array([-bound]))[0])
        if len(self.fixed_rows):
            state.acceleration[self.fixed_rows] *= self.moves
        write_forces(state, self.materials.mass(state), self.all_ranks)
        if any(self.params.gravity):
            state.acceleration += self.params.gravity
            state.acceleration[self.fixed_rows] *= self.moves
        if len(state.active):
            state.acceleration[glued_rows(state, attached=True)] = 0.0

    def give(self, wanted: Keys) -> Fields:
        """Copy out forces on glued particles, and readings of bodies, gauges and levels."""
        state, values = self.state, dict[str, Array]()
        ports_wanted = {key.partition(".")[0] for key in wanted}
        if "bodies" in ports_wanted:
            mass = self.materials.mass(state)
            values.update(bodies(state, mass, self.params, self.all_ranks))
        if "gauges" in ports_wanted:
            read = self.all_ranks.rows_of(state, self.gauged)
            if self.faces:
                read.velocity += self.faces.penalty.kicked[self.gauged]
            values.update(gauges(read, self.materials.density))
        if "levels" in ports_wanted:
            whole = self.all_ranks.whole(state, NEEDED_BY_LEVELS)
            values.update(levels(whole, self.params) if not self.all_ranks.rank else NO_LEVELS)
        if LOAD in wanted:
            values[LOAD] = state.force.copy()
        if REACTION in wanted:
            penalty = self.faces.penalty if self.faces else None
            values[REACTION] = penalty.reaction.copy() if penalty else np.zeros((0, 3))
        return {key: values[key] for key in wanted}

    def save(self) -> Fields:
        """Copy out all state; the neighbour list is kept as the places it was made from."""
        saved = self.all_ranks.whole(self.state).save()
        return saved | dict(self.faces.penalty.save()) if self.faces else saved

    def load(self, state: Fields) -> None:
        """Restore a saved state, bit for bit."""
        self.state = State.load(state)
        self.all_ranks.load(self.state)
        if self.faces:
            self.faces.penalty.load(state)
        self._list()

    def begin_from(self, state: Fields) -> None:
        """Begin from the state of another run of the same particles; judge from here on."""
        settings = self.params.spacing, method(self.params).total_lagrangian
        contact = self.faces.penalty.beginning(state) if self.faces else {}
        self.load({**restarted(state, self.state, self.all_ranks, *settings), **contact})
        if self.lists.are_short(self.state):  # pairs of that run did not reach so far
            self.lists.widen(self.state, 0.0)
            self._list()

    def totals(self) -> Totals:
        """Mass, momentum and energies, without the motion of particles that a mesh carries."""
        state = self.state
        carried = glued_rows(state, attached=True)[: None if self.is_carried else 0]
        mass, gravity = self.materials.mass(state), self.params.gravity
        sums = totals(state, mass, carried, gravity, self.all_ranks)
        if self.params.axisymmetric:  # the other half of a ring moves the other way
            sums.momentum[:2], sums.angular_momentum[:] = 0.0, 0.0
        if self.faces:
            numbers = self.faces.penalty.numbers
            sums.kinetic += numbers.half_kick
            sums.internal += numbers.energy
            sums.dissipated = numbers.dissipated
        return sums

    def view(self) -> Fields:
        """Particles in the order of their birth, with stress, strain and damage."""
        return {**view(self.all_ranks.whole(self.state)), **self.all_ranks.owners(self.state)}

    def items(self) -> int:
        """Count the particles."""
        return self.all_ranks.particles(self.state)
