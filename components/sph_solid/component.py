"""Elastic-plastic bodies of particles, stepped by velocity Verlet."""

import math
from collections.abc import Mapping

import numpy as np

from quintet.components.shared.threads import Team
from quintet.components.sph_solid import MANIFEST
from quintet.components.sph_solid.build import initial_state, materials, nearest, pair_law
from quintet.components.sph_solid.diagnostics import bodies, failure, gauges, levels, totals, view
from quintet.components.sph_solid.features import pair_sums
from quintet.components.sph_solid.judgement import (
    BONDS_EVERY,
    ENERGY_EVERY,
    bonds,
    is_elastic,
    note_energies,
    note_torn,
    note_viscous,
    warnings,
)
from quintet.components.sph_solid.kernels.material import (
    Points,
    advance,
    write_artificial,
    write_stresses,
)
from quintet.components.sph_solid.kernels.motion import (
    drift_half,
    kick_and_drift_half,
    kick_and_heat,
)
from quintet.components.sph_solid.kernels.pairs import Forces
from quintet.components.sph_solid.method import viscosity_note
from quintet.components.sph_solid.neighbours import SolidLists
from quintet.components.sph_solid.params import SphSolidParams
from quintet.components.sph_solid.ports import SHOWS
from quintet.components.sph_solid.state import Array, State, Whole
from quintet.interfaces.component import (
    ONE_THREAD,
    Component,
    Fields,
    Keys,
    Resources,
    Totals,
    fields_of,
)
from quintet.interfaces.errors import StepError

FEWEST = 500  # particles that are worth handing to another thread
LOAD = "glued_load.force"


class SphSolid(Component):
    """Moves elastic-plastic bodies of particles, which may hang on a partner's mesh.

    A class of one's own may derive from it, with a `Params` that derives from `SphSolidParams`: in
    a scene it is a kind, ``module:Class``, with all ports of this one.
    """

    Params: type[SphSolidParams] = SphSolidParams
    manifest = MANIFEST
    shows = SHOWS

    def __init__(self, params: SphSolidParams, resources: Resources = ONE_THREAD) -> None:
        self.params, (self.takes, self.gives) = params, self.ports_of(params)
        self.team, self.law = Team(resources.threads, FEWEST), pair_law(params)
        self.laws, numbers = materials(params)
        self.density = np.array([one.density for one in self.laws])
        self.state = initial_state(params, self.laws, numbers)
        self.bonds = bonds(self.state, params)
        self.gauged = nearest(self.state.position, params)
        self.lists = SolidLists(params, self.team)
        self.sums = pair_sums(params, self.team)
        self.is_carried = False  # whether a mesh bears the glued particles
        self._begin()

    def describe(self) -> Fields:
        """State where glued particles are, and their masses."""
        if not self.params.glued:
            return {}
        rows = self._glued_rows()
        return {
            "glued_load.position": self.state.position[rows],
            "glued_load.mass": self._masses()[rows],
        }

    def bind(self, static: Fields, joined: Keys) -> None:
        """Learn whether a mesh bears the glued particles."""
        self.is_carried = "glued" in joined or "glued_load" in joined

    def prepare(self, fields: Fields) -> None:
        """Compile all kernels: try a step, and come back."""
        kept = self.save()
        self.take(fields)
        self.step(self.stable_dt())
        self.give(frozenset(fields_of(self.gives)))
        self.load(kept)

    def stable_dt(self) -> float:
        """Return the share `courant` of what the slowest particle bears."""
        return self.params.courant * self.state.bound

    def take(self, fields: Fields) -> None:
        """Set velocities of glued particles in the coming step, and which are still glued."""
        state = self.state
        if "glue_activity.active" in fields:
            active = np.asarray(fields["glue_activity.active"])
            if len(freed := np.flatnonzero(active < state.active)):
                rows = self._glued_rows()[freed]  # they bring their motion with them
                squares = (state.velocity[rows] ** 2).sum(axis=1)
                state.work += 0.5 * float(self._masses()[rows] @ squares)
            state.active[:] = active
        if "glued.velocity" in fields:
            state.pulled[:] = fields["glued.velocity"] * state.active[:, None]

    def step(self, dt: float) -> None:
        """Advance by exactly dt [s]; stresses follow the motion in the step's middle."""
        state, rows = self.state, self.rows
        if state.steps % ENERGY_EVERY == 0:
            self._judge()
        self._pull()
        self._work_on_glued(dt)
        displaced = self.team.run(
            kick_and_drift_half, state.particles, dt, state.position, state.velocity,
            state.acceleration, state.failed, state.volume, state.reference, rows.place,
            rows.motion,
        )  # fmt: skip
        ends = np.array(displaced)
        spread = self.lists.spread(ends[:, :3].min(axis=0), ends[:, 3:].max(axis=0))
        if self.lists.are_outworn(state, spread) and not self._still_hold(dt):
            self._search(dt)
        self._write_gradients()
        self._advance_materials(dt)
        rows = self.rows
        self.team.run(
            drift_half, state.particles, dt, state.position, state.velocity, state.acceleration,
            state.sound, rows.place, rows.motion,
        )  # fmt: skip
        before = None if self.sums.heats is None else state.acceleration.copy()
        self._write_accelerations()
        if before is not None and self.sums.heats is not None:
            # Heat was that of velocities which the acceleration before it predicted.
            change = state.acceleration - before
            state.heating -= 0.5 * dt * (self.sums.heats * change).sum(axis=1)
        squares = self.team.run(
            kick_and_heat, state.particles, dt, state.velocity, state.acceleration, state.heating,
            state.energy,
        )  # fmt: skip
        state.time += dt
        state.steps += 1
        self._work_on_glued(dt)
        if not math.isfinite(sum(squares)):
            raise StepError(failure(state, self.params, dt))

    def _work_on_glued(self, dt: float) -> None:
        """Add the work of half a step of dt [s] that what they hang on does on glued particles."""
        state = self.state
        if len(state.active):
            state.work -= 0.5 * dt * float((state.force * state.pulled).sum())

    def _judge(self) -> None:
        """Take down energies and lost bonds: at steps of certain numbers, so that runs repeat."""
        state = self.state
        glued = self._glued_rows()[state.active > 0.0]
        found = totals(state, self._masses(), glued, self.params.gravity)
        note_energies(state, found.kinetic, found.potential, found.internal)
        elastic = np.array([is_elastic(law) for law in self.laws], float)[state.material]
        contact = self.sums.contact_energy(state, self.density[state.material], elastic)
        note_viscous(state, self.of_material, self.laws, contact)
        if state.steps % BONDS_EVERY == 0 and not self.lists.are_for_good:
            note_torn(state, self.bonds, self.laws, self.params)

    def warnings(self) -> Mapping[str, str]:
        """Reasons why the results may be wrong: energy from nowhere, numerical fracture."""
        return warnings(self.state, self.density, self.params, len(self.bonds))

    def notes(self) -> tuple[str, ...]:
        """Settings that would be better for a slow impact."""
        note = viscosity_note(self.params)
        return (note,) if note else ()

    def _begin(self) -> None:
        """Find what acts at the start, where nothing is strained."""
        state = self.state
        self.lists.widen(state, 0.0)
        self.lists.sort(state, state.position)
        self._list()
        self._fill_rows()
        self.rows.motion[: state.particles, 3] = state.failed
        self._write_gradients()
        self._write_stresses()
        self.rows.motion[: state.particles, 3] = state.sound
        self._write_accelerations()

    def _fill_rows(self) -> None:
        state, rows, count = self.state, self.rows, self.state.particles
        rows.place[:count, :3], rows.place[:count, 3] = state.position, state.volume
        rows.motion[:count, :3] = state.velocity

    def _still_hold(self, dt: float) -> bool:
        return self.lists.still_hold(self.state, self.rows.place[: self.state.particles], dt)

    def _search(self, dt: float) -> None:
        """List what is near in the middle of a step of dt [s], and sort by it."""
        state = self.state
        self.lists.reflect(state)
        low, high = state.velocity.min(axis=0), state.velocity.max(axis=0)
        spread = dt * self.lists.spread(low, high)
        middle = state.position + 0.5 * dt * state.velocity
        if self.lists.is_unstable(spread) or not np.isfinite(middle).all():
            raise StepError(failure(state, self.params, dt))
        self.lists.widen(state, spread)
        self.lists.sort(state, middle)
        self._list()
        self._fill_rows()
        self.rows.place[: state.particles, :3] = state.reference
        self.rows.motion[: state.particles, 3] = state.failed

    def _list(self) -> None:
        """Make lists from the references, and find the rows of what is asked for."""
        state = self.state
        self.rows = self.lists.make(state)
        self.sums.make(state, self.lists)
        self.of_material = [np.flatnonzero(state.material == k) for k in range(len(self.laws))]
        self.held = np.flatnonzero(state.fixed)
        self.moves = ((state.fixed[self.held, None] >> np.arange(3)) & 1) == 0
        self.points = Points(
            state.deviator, state.density_ratio, state.pressure, state.energy, state.strain,
            state.temperature, state.damage, state.failed, state.sound, state.heating,
        )  # fmt: skip

    def _glued_rows(self) -> Whole:
        """Rows of the particles that are glued or were, in the order of their port."""
        glue = self.state.glue
        found = np.flatnonzero(glue >= 0)
        return found[np.argsort(glue[found])]

    def _pull(self) -> None:
        """Let glued particles move as they are told in this step."""
        state = self.state
        if len(state.active):
            glued = state.active > 0.0
            rows = self._glued_rows()[glued]
            state.velocity[rows], state.acceleration[rows] = state.pulled[glued], 0.0

    def _write_gradients(self) -> None:
        """Gradients of velocity, of places and motion as they stand in the rows."""
        rows, count = self.rows, self.state.particles
        self.lists.images.write_positions(rows.place, count)
        self.lists.images.write_vectors(rows.motion, count)
        self.sums.write_gradients(rows, self.law)

    def _advance_materials(self, dt: float) -> None:
        rows = self.rows
        for law, mine in zip(self.laws, self.of_material, strict=True):
            self.team.run(
                advance, len(mine), mine, self.points, rows.gradient, rows.correction, law, dt
            )
        self._write_stresses()

    def _write_stresses(self) -> None:
        rows, count = self.rows, self.state.particles
        self.team.run(
            write_stresses, count, self.density, self.state.material, self.points, rows.correction,
            rows.stress,
        )  # fmt: skip
        if self.law.artificial is not None:
            self.team.run(write_artificial, count, self.law.artificial, rows.stress)

    def _write_accelerations(self) -> None:
        """Accelerations, forces on glued particles, the next step's bound, as the rows stand."""
        state, rows, count = self.state, self.rows, self.state.particles
        images = self.lists.images
        images.write_positions(rows.place, count)
        images.write_vectors(rows.motion, count)
        images.write_tensors(rows.stress, count)
        forces = Forces(state.acceleration, state.heating)
        state.bound = self.sums.write_accelerations(rows, self.law, forces)
        if len(self.held):
            state.acceleration[self.held] *= self.moves
        if len(state.active):
            mine = self._glued_rows()
            force = self._masses()[mine, None] * state.acceleration[mine]
            state.force[:] = force * state.active[:, None]
        if any(self.params.gravity):
            state.acceleration += self.params.gravity
            state.acceleration[self.held] *= self.moves
        if len(state.active):
            state.acceleration[mine[state.active > 0.0]] = 0.0

    def give(self, wanted: Keys) -> Fields:
        """Copy out forces on glued particles, and what bodies and gauges read now."""
        given: dict[str, Array] = {}
        ports_wanted = {key.partition(".")[0] for key in wanted}
        if "bodies" in ports_wanted:
            given.update(bodies(self.state, self._masses(), self.params))
        if "gauges" in ports_wanted:
            place = np.empty(self.state.particles, np.int64)
            place[self.state.identity] = np.arange(self.state.particles)
            given.update(gauges(self.state, place[self.gauged], self.density))
        if "levels" in ports_wanted:
            given.update(levels(self.state, self.params))
        if LOAD in wanted:
            given[LOAD] = self.state.force.copy()
        return {key: given[key] for key in wanted}

    def save(self) -> Fields:
        """Copy out all state; the neighbour list is kept as the places it was made from."""
        return self.state.save()

    def load(self, state: Fields) -> None:
        """Come back to a saved state, bit for bit."""
        self.state = State.load(state)
        self._list()

    def _masses(self) -> Array:
        """Mass (n,) kg of each particle."""
        return np.asarray(self.state.volume * self.density[self.state.material])

    def totals(self) -> Totals:
        """Mass, momentum and energies; what hangs on a mesh is the mesh's."""
        carried = np.zeros(0, np.int64)
        if self.is_carried and len(self.state.active):
            carried = self._glued_rows()[self.state.active > 0.0]
        found = totals(self.state, self._masses(), carried, self.params.gravity)
        if self.params.axisymmetric:  # the rest of a ring moves the other way
            found.momentum[:2], found.angular_momentum[:] = 0.0, 0.0
        return found

    def view(self) -> Fields:
        """Particles in the order of their birth, with stress, strain and damage."""
        return view(self.state)

    def items(self) -> int:
        """Count the particles."""
        return self.state.particles
