"""A structure of finite elements, stepped by velocity Verlet."""

import math
from dataclasses import astuple

import numpy as np

from quintet.components.fe_plate import MANIFEST
from quintet.components.fe_plate.added_mass import AddedMass
from quintet.components.fe_plate.build import initial_state, structure
from quintet.components.fe_plate.diagnostics import inside_out, motion, not_finite, totals
from quintet.components.fe_plate.features import Pressures, stepping_kernel
from quintet.components.fe_plate.gauges import measured, readings
from quintet.components.fe_plate.judgement import EVERY, Judge
from quintet.components.fe_plate.kernels.flow import HUGE
from quintet.components.fe_plate.kernels.nodes import (
    kick,
    kick_and_drift,
    kinetic_energy,
    sum_parted,
)
from quintet.components.fe_plate.params import FePlateParams
from quintet.components.fe_plate.points import integration_notes, points_of
from quintet.components.fe_plate.ports import SHOWS
from quintet.components.fe_plate.state import Accumulated, Array
from quintet.components.fe_plate.supports import supports
from quintet.components.fe_plate.view import view
from quintet.components.shared.geometry.surface_samples_mesh import mesh_answer
from quintet.components.shared.threads import Team
from quintet.interfaces.component import (
    ONE_THREAD,
    Component,
    Fields,
    Keys,
    Resources,
    Totals,
)

FEWEST = 128  # blocks that are worth handing to another thread
SHARES = 4  # of each thread: where they meet, forces are summed once more
SQUASHED = 4.0  # least steps in which a node that meets a wall moves by an element
SMALLEST = 0.02  # of an element's volume at the start: below it, it has been turned inside out
POSITION, VELOCITY = "faces.position", "faces.velocity"
MEAN_VELOCITY, ACTIVE = "node_glue.velocity", "face_activity.active"


class FePlate(Component):
    """Moves a structure under the loads it is given, pressures, gravity and rigid walls.

    A class of one's own may derive from it, with a `Params` that derives from `FePlateParams`: in
    a scene it is a kind, ``module:Class``, with all ports of this one.

    Parameters
    ----------
    params : FePlateParams
        Parts, supports, loads.
    """

    Params: type[FePlateParams] = FePlateParams

    manifest = MANIFEST
    shows = SHOWS

    def __init__(self, params: FePlateParams, resources: Resources = ONE_THREAD) -> None:
        self.params, (self.takes, self.gives) = params, self.ports_of(params)
        self.team = Team(resources.threads, FEWEST, SHARES)
        self.built = built = structure(params, self.team.ends)
        self.mesh, self.model, self.places = built.mesh, built.model, built.places
        self.measured = measured(self.mesh, params.gauges)
        self.faces = self.mesh.side[built.coupled]  # (f, 4) nodes
        self.owner = self.mesh.owner[built.coupled]  # (f,) elements
        self.surface = np.unique(self.faces[self.faces >= 0])  # nodes
        rows = np.searchsorted(self.surface, self.faces)
        self.corner = np.where(self.faces < 0, -1, rows)  # (f, 4) among these; -1 ends an edge
        self.state = initial_state(params, built)
        self.kernel = stepping_kernel(points_of(params))
        self.pressures = Pressures(params.pressures, built)
        self.added_mass = AddedMass(self.surface, built.mass)
        self.loads = np.zeros((len(self.surface), 3))  # N, of partners
        self.glued = False  # whether particles are glued to it
        self.half_kick = np.zeros((len(self.surface), 3))  # m/s, that velocities at an end lack
        self.accumulated = Accumulated()
        self.bound = self._write_forces(0.0)  # s
        self.judge = Judge(params, built, bool(len(self.state.springs)))

    def describe(self) -> Fields:
        """Return places of the surface's nodes at the start, and the corners of its faces."""
        mesh = {
            "start": self.mesh.node[self.surface],
            "corner": self.corner.astype(np.float64),
        }
        if self.params.dimensions == 2:
            mesh["dimensions"] = np.array([2.0])
        return {
            f"{port}.{key}": array.copy()
            for port in ("faces", "node_glue")
            for key, array in mesh.items()
        }

    def sample(self, request: Fields) -> Fields:
        """Sample the structure below its faces, or hang points on these."""
        port = next(iter(request)).partition(".")[0]
        return mesh_answer(port, request, self.describe())

    def bind(self, static: Fields, joined: Keys) -> None:
        """Take the mass of particles that are glued to the nodes."""
        self.glued = "node_glue" in joined
        # Glued particles push in the first half of a step alone: the link keeps that balance.
        self.judge.closed = not self.glued
        if "node_load.added_mass" in static:
            added = static["node_load.added_mass"]
            self.accumulated.brought += self.added_mass.replace(added, self.model, self.state)

    def stable_dt(self) -> float:
        """Return a share of the proven bound."""
        return self.params.courant * self.bound

    def take(self, fields: Fields) -> None:
        """Set the forces [N] on the surface's nodes, none if left out, and their added mass."""
        force = fields.get("node_load.force")
        self.loads[:] = 0.0 if force is None else force
        added = fields.get("node_mass.added")
        if added is not None and not np.array_equal(added, self.added_mass.added):
            self.accumulated.brought += self.added_mass.replace(added, self.model, self.state)

    def step(self, dt: float) -> None:
        """Advance by exactly dt [s]: half kick, drift, stresses, half kick."""
        total, damping = self.accumulated, self.params.mass_damping
        self.state.load[:] = 0.0
        self.state.load[self.surface] = self.loads
        self.pressures.add(self.state, total.time)
        if self.glued:
            self._kick_early(dt)
        decay = math.exp(-0.5 * damping * dt)  # of the kinetic energy, in either half
        if total.steps % EVERY == 0:
            self._note_energies()
        total.steps += 1
        if damping:
            total.damp((1.0 - decay) * kinetic_energy(self.model, self.state))
        work = kick_and_drift(self.model, self.state, dt, damping)
        total.time += dt
        total.work += work
        if self.params.pressures:
            mean = self.state.mean_velocity[self.surface]
            total.outside += work - dt * float((mean * self.loads).sum())
        self.bound = self._write_forces(dt)
        if damping:
            total.damp((1.0 / decay - 1.0) * kinetic_energy(self.model, self.state))
        if self.glued:
            self.state.velocity[self.surface] -= self.half_kick

    def _note_energies(self) -> None:
        """Take down the energies of the state between two steps, and the work done on it."""
        work = self.accumulated.done() + float(self.state.wall_work.sum())
        self.judge.note(self.state, *self._motion(), work, self.accumulated.steps == 0)

    def _kick_early(self, dt: float) -> None:
        """Apply the partners' loads in the step's first half, and not in its second one.

        Forces of glued particles are those at the step's begin: half a step late they would feed
        energy in.
        """
        rows = self.surface
        push = 0.5 * dt * self.model.inverse_mass[rows, None] * self.loads * self.model.free[rows]
        self.state.velocity[rows] += push
        self.half_kick = push

    def _write_forces(self, dt: float) -> float:
        """Advance the elements by a step and the nodes' velocities by half; return the bound."""
        built, bound = self.built, math.inf
        for law, first, last in zip(built.laws, built.first, built.first[1:], strict=False):
            shares = self.team.run(
                self.kernel, last - first, first, self.model, self.state, law, built.resistance, dt
            )
            bound = min(bound, *(stable for stable, _, _ in shares))
            least, worst = min((volume, place) for _, volume, place in shares)
            if not least > SMALLEST:
                raise inside_out(built, worst, least, self.accumulated.time)
        sum_parted(built.parted, self.state.forces)
        ahead = 2.0 * min(bound, 1.0)  # s
        squares, closing = kick(self.model, self.state, dt, self.params.mass_damping, ahead)
        if not math.isfinite(squares):
            raise not_finite(built, self.state, self.accumulated.time)
        if bound >= HUGE:  # all elements have eroded
            return math.inf
        # A step squashes an element that meets a wall by a small share of its edge.
        return bound / (1.0 + SQUASHED * closing * bound / built.shortest)

    def give(self, wanted: Keys) -> Fields:
        """Copy out the motion of the surface, its faces that have not eroded, and gauges."""
        values: dict[str, Array] = {}
        for key, array in (
            (POSITION, self.state.position),
            (VELOCITY, self.state.velocity),
            (MEAN_VELOCITY, self.state.mean_velocity),
        ):
            if key in wanted:
                values[key] = array[self.surface]
        if ACTIVE in wanted:
            values[ACTIVE] = self.places.active(self.state)[self.owner]
        return values | readings(self.measured, self.built, self.state, wanted)

    def save(self) -> Fields:
        """Copy out all state."""
        saved = {name: array.copy() for name, array in self.state.to_save().items()}
        saved["accumulated"] = np.array([*astuple(self.accumulated), self.bound])
        saved["judge"] = self.judge.save()
        saved["loads"], saved["half_kick"] = self.loads.copy(), self.half_kick.copy()
        return saved | {"added_mass": self.added_mass.added.copy()}

    def load(self, state: Fields) -> None:
        """Restore a saved state, bit for bit."""
        self.state.forces[:] = 0.0
        for name, array in self.state.to_save().items():
            array[:] = state[name]
        self.loads[:] = state["loads"]
        self.half_kick = np.array(state["half_kick"])
        self.added_mass.restore(state["added_mass"], self.model)
        time, work, outside, damped, brought, steps, self.bound = state["accumulated"].tolist()
        self.accumulated = Accumulated(time, work, outside, damped, brought, int(steps))
        self.judge.load(state["judge"])

    def totals(self) -> Totals:
        """Mass, momentum and energies, with added mass.

        Internal is strain, plastic work and stabilisation; work is that of pressures, rigid walls
        and mass damping.
        """
        mass, work = self.added_mass.total(), self.accumulated.outside
        return totals(self.state, self.built, mass, self._motion(), work)

    def _motion(self) -> tuple[float, float]:
        """Kinetic and potential energy [J]."""
        velocity = self.state.velocity
        if self.glued:
            velocity = velocity.copy()
            velocity[self.surface] += self.half_kick
        return motion(self.state, self.added_mass.total(), velocity, self.model.gravity)

    def warnings(self) -> dict[str, str]:
        """Energy that appears, hourglassing, and motion that bulk viscosity takes."""
        return self.judge.warnings()

    def notes(self) -> tuple[str, ...]:
        """Sizes of meshes from files and what of them is left out; integration in thin parts."""
        return (*self.mesh.notes, *integration_notes(self.params))

    def view(self) -> Fields:
        """Outer faces with velocity, stress, plastic strain and temperature."""
        return view(self.mesh, self.places, self.state)

    def walls(self) -> Fields:
        """Return rigid walls, clamped faces and planes of symmetry."""
        return supports(self.params, self.mesh)

    def items(self) -> int:
        """Count the elements."""
        return len(self.mesh.corner)
