"""A structure of finite elements, stepped by velocity Verlet."""

import math
from dataclasses import astuple
from typing import TYPE_CHECKING

import numpy as np

from quintet.components.fe_plate import MANIFEST
from quintet.components.fe_plate.added_mass import AddedMass
from quintet.components.fe_plate.build import Structure, initial_state, structure
from quintet.components.fe_plate.contact_surface import OpeningSurface, areas, described_layer
from quintet.components.fe_plate.diagnostics import (
    check,
    inside_out,
    motion,
    not_finite,
    present_velocity,
    require_before_walls,
    totals,
)
from quintet.components.fe_plate.erosion import eroding_parts
from quintet.components.fe_plate.features import (
    Loads,
    Pressures,
    Stepped,
    partner_faces,
    ranks,
    stepping_kernel,
)
from quintet.components.fe_plate.gauges import measured, readings
from quintet.components.fe_plate.judgement import EVERY, Judge
from quintet.components.fe_plate.kernels.flow import HUGE
from quintet.components.fe_plate.kernels.nodes import (
    add_damped,
    kick,
    kick_and_drift,
    sum_parted,
)
from quintet.components.fe_plate.params import FePlateParams
from quintet.components.fe_plate.points import integration_notes, points_of
from quintet.components.fe_plate.ports import SHOWS
from quintet.components.fe_plate.state import Accumulated, Array, first_rows
from quintet.components.fe_plate.supports import supports
from quintet.components.fe_plate.view import shown, view
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

if TYPE_CHECKING:
    from quintet.components.fe_plate.partner_faces import PartnerFaces

FEWEST = 128  # blocks that are worth handing to another thread
SHARES = 4  # of each thread: where they meet, forces are summed once more
SQUASHED = 4.0  # least steps in which a node that meets a wall moves by an element
SMALLEST = 0.02  # of an element's volume at the start: below it, it has been turned inside out
POSITION, VELOCITY = "faces.position", "faces.velocity"
TOUCHED_POSITION, TOUCHED_VELOCITY = "contact_surface.position", "contact_surface.velocity"
MEAN_VELOCITY, ACTIVE = "node_glue.velocity", "face_activity.active"
OPEN = "open_faces.active"
INNER, TOUCHING = "contact_surface.inner", "contact_surface_load.force"
REACTION = "contact_load.force"
# Ports whose partners push as at a step's begin.
EARLY = ("node_glue", "contact_surface", "contact_faces")


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
        self.resources = resources
        self.team = Team(resources.threads, FEWEST, SHARES)
        self.all_ranks = ranks(resources, self.team.ends)
        whole = structure(params, self.team.ends)
        self.built = built = self.all_ranks.share_out(whole)
        self.mesh = self.all_ranks.mesh_to_keep(whole.mesh)
        self.notes_of_mesh = whole.mesh.notes
        self.model, self.places = built.model, built.places
        self.measured = measured(whole.mesh, params.gauges, self.all_ranks)
        self.faces = whole.mesh.side[whole.coupled]  # (f, 4) nodes
        self.owners = self.all_ranks.elements_of(whole.mesh.owner[whole.coupled])  # of the f faces
        self.places_of_owners = self.places.subset(self.owners.rows)
        self.surface = np.unique(self.faces[self.faces >= 0])  # nodes
        rows = np.searchsorted(self.surface, self.faces)
        self.corner = np.where(self.faces < 0, -1, rows)  # (f, 4) among these; -1 ends an edge
        self.start = whole.mesh.node[self.surface]  # (k, 3) m
        owner, area = whole.mesh.owner[whole.coupled], areas(whole.mesh.node, self.faces)
        self.layer = described_layer(whole, self.surface, owner, area)
        self.on_surface = self.all_ranks.nodes_of(self.surface)
        self.loaded = self.on_surface  # nodes that partners push
        self.whole: Structure | None = whole  # until partners are joined
        self.opening: OpeningSurface | None = None  # if a partner touches what erosion opens
        self.touching: PartnerFaces | None = None  # faces of a partner that these touch
        self.state = initial_state(params, built)
        self.kernel = stepping_kernel(points_of(params))
        self.all_loads = Loads(self.on_surface, Pressures(params.pressures, built))
        self.added_mass = AddedMass(self.on_surface, built.mass)
        self.loads = np.zeros((len(self.surface), 3))  # N, of partners
        self.kicks_early = False  # whether loads act in the first half of a step alone
        # m/s, that velocities at an end lack, of nodes of the surface that this rank moves.
        self.half_kick = np.zeros_like(self.loads[self.on_surface.ids])
        self.accumulated = Accumulated()
        self.bound = self._write_forces(0.0, False)  # s
        self.judge = Judge(params, built, bool(len(self.state.springs)))

    def describe(self) -> Fields:
        """Return places of the surface's nodes at the start, and the corners of its faces."""
        mesh = {
            "start": self.start,
            "corner": self.corner.astype(np.float64),
        }
        if self.params.dimensions == 2:
            mesh["dimensions"] = np.array([2.0])
        described = {
            f"{port}.{key}": array.copy()
            for port in ("faces", "node_glue", "contact_surface")
            for key, array in mesh.items()
        }
        layer = self.layer | {"step": np.array([self.bound])}
        return described | {f"contact_surface.{key}": array.copy() for key, array in layer.items()}

    def sample(self, request: Fields) -> Fields:
        """Sample the structure below its faces, hang points on these, or list inner faces."""
        if INNER in request and self.whole:
            place = self.built.places, self.params, self.surface, self.all_ranks
            self.opening = self.opening or OpeningSurface(self.whole, *place)
            return {f"contact_surface.{key}": a for key, a in self.opening.described.items()}
        port = next(iter(request)).partition(".")[0]
        return mesh_answer(port, request, self.describe())

    def bind(self, static: Fields, joined: Keys) -> None:
        """Take the mass of particles that are glued to the nodes, and faces that are touched."""
        if "contact_faces" in joined and eroding_parts(self.params):
            self.sample({INNER: np.ones(1)})
        self.whole = None
        if self.opening:
            self.loaded = self.all_loads.surface = self.opening.nodes
            self.loads = np.zeros((self.loaded.size, 3))
            self.half_kick = np.zeros_like(self.loads[self.loaded.ids])
        surface = {"start": self.start, "corner": self.corner, **self.layer}
        surface = dict(self.opening.described) if self.opening else surface
        velocity = self.state.velocity[self.loaded.rows]
        self.touching = partner_faces(static, joined, surface, velocity, self.resources)
        self.kicks_early = not joined.isdisjoint(EARLY)
        # What pushes in the first half of a step alone: the link keeps that balance.
        self.judge.closed = not self.kicks_early
        if "node_load.added_mass" in static:
            added = static["node_load.added_mass"]
            self.accumulated.brought += self.added_mass.replace(
                added, self.model, self.state, self.all_ranks
            )

    def prime(self, fields: Fields) -> None:
        """Refuse nodes that begin behind rigid walls."""
        require_before_walls(self.built, self.state, self.all_ranks)

    def stable_dt(self) -> float:
        """Return a share of the proven bound, or contact's stable step."""
        free = self.params.courant * self.bound
        return min(free, self.touching.penalty.stable_step(self.bound)) if self.touching else free

    def take(self, fields: Fields) -> None:
        """Set the forces [N] on the surface's nodes, none if left out, and their added mass."""
        if self.touching:
            self.touching.penalty.take(fields)
        force, touching = fields.get("node_load.force"), fields.get(TOUCHING)
        self.loads[:] = 0.0 if touching is None else touching
        if force is not None:
            self.loads[: len(force)] += force
        added = fields.get("node_mass.added")
        if added is not None and not np.array_equal(added, self.added_mass.added):
            self.accumulated.brought += self.added_mass.replace(
                added, self.model, self.state, self.all_ranks
            )

    def step(self, dt: float) -> None:
        """Advance by exactly dt [s]: half kick, drift, stresses, half kick."""
        total, damping = self.accumulated, self.params.mass_damping
        rows, pushes = self.loaded.rows, self.loads
        if self.touching:
            moving = self.state.position[rows], self.state.mean_velocity[rows]
            open_faces = self.opening.open_faces(self.state) if self.opening else None
            pushes = pushes + self.touching.push(*moving, open_faces, dt)
        loads = pushes[self.loaded.ids]
        loaded = self.all_loads.write(self.state, pushes, total.time)
        if self.kicks_early:
            # Forces of glue and contact are those at the step's begin: half a step late they would
            # feed energy in. So they act in its first half, and not in its second one.
            half, model = 0.5 * dt, self.model
            self.half_kick = half * model.inverse_mass[rows, None] * loads * model.free[rows]
            self.state.velocity[rows] += self.half_kick
        decay = math.exp(-0.5 * damping * dt)  # of the kinetic energy, in either half
        if total.steps % EVERY == 0:
            works, is_first = self.state.works(self.model.moving), total.steps == 0
            # Velocities have the half kick of this step already.
            parts = self.added_mass.total()[: self.model.moving], self.model.gravity, None
            energies = self.state, motion(self.state, *parts), works, total.brought
            self.judge.note(*energies, self.all_ranks, is_first)
        total.steps += 1
        if damping:
            add_damped(self.model, self.state, 1.0 - decay)
        kick_and_drift(self.model, self.state, dt, damping, loaded)
        total.time += dt
        if self.params.pressures:
            mean = self.state.mean_velocity[rows]
            self.state.partner_work[rows] += dt * (mean * loads).sum(axis=1)
        self.bound = self._write_forces(dt, loaded)
        if damping:
            add_damped(self.model, self.state, 1.0 / decay - 1.0)
        if self.kicks_early:
            self.state.velocity[rows] -= self.half_kick

    def _write_forces(self, dt: float, loaded: bool) -> float:
        """Advance the elements by a step and the nodes' velocities by half; return the bound."""
        built, shares, time = self.built, list[Stepped](), self.accumulated.time
        self.all_ranks.begin(self.state)
        for spans in (built.inner, built.border):
            if spans is built.border:
                self.all_ranks.finish(self.state)
            for part, first, last in spans:
                shares += self.team.run(
                    self.kernel, last - first, first, self.model, self.state, built.laws[part],
                    built.resistance, dt,
                )  # fmt: skip
        here, place = min((volume, place) for _, volume, place in shares)
        extremes = np.array([min(stable for stable, _, _ in shares), here])
        bound, least = self.all_ranks.least(extremes).tolist()
        if not least > SMALLEST:
            raise inside_out(built, place if here == least else -1, least, time, self.all_ranks)
        sum_parted(built.parted, self.state.forces)
        ahead = 2.0 * min(bound, 1.0)  # s
        damping = self.params.mass_damping
        squares, closing = kick(self.model, self.state, dt, damping, loaded, ahead)
        wrong = float(not math.isfinite(squares))
        closing, wrong = self.all_ranks.greatest(np.array([closing, wrong])).tolist()
        if wrong:
            raise not_finite(built, self.state, time, self.all_ranks)
        if bound >= HUGE:  # all elements have eroded
            return math.inf
        # A step squashes an element that meets a wall by a small share of its edge.
        return bound / (1.0 + SQUASHED * closing * bound / built.shortest)

    def check(self) -> None:
        """Refuse an element whose energy, strain, temperature or damage is not finite."""
        check(self.built, self.state, self.all_ranks)

    def give(self, wanted: Keys) -> Fields:
        """Copy out the motion of the surface, its faces that have not eroded, and gauges."""
        position, mean = self.state.position, self.state.mean_velocity
        motion = {POSITION: position, VELOCITY: self.state.velocity, MEAN_VELOCITY: mean}
        touched = {TOUCHED_POSITION: position, TOUCHED_VELOCITY: mean}
        nodes = self.opening.nodes if self.opening else self.on_surface
        values: dict[str, Array] = {}
        for rows, arrays in ((self.on_surface, motion), (nodes, touched)):
            if some := {key: array for key, array in arrays.items() if key in wanted}:
                values |= zip(some, rows.give(list(some.values())), strict=True)
        if OPEN in wanted and self.opening:
            values[OPEN] = self.opening.open_faces(self.state)
        if missing := wanted & {ACTIVE, OPEN} - values.keys():
            active = self.owners.gather(self.places_of_owners.active(self.state))
            values |= {key: active.copy() for key in missing}
        if REACTION in wanted:
            penalty = self.touching.penalty if self.touching else None
            values[REACTION] = penalty.reaction.copy() if penalty else np.zeros((0, 3))
        if not wanted - values.keys():  # of gauges none
            return values
        kicks = (self.loaded.rows, self.half_kick) if self.kicks_early else None
        state = self.state._replace(velocity=present_velocity(self.state.velocity, kicks))
        return values | readings(self.measured, self.built, state, wanted, self.all_ranks)

    def save(self) -> Fields:
        """Copy out all state."""
        saved = self.all_ranks.whole(self.state)
        saved["accumulated"] = np.array([*astuple(self.accumulated), self.bound])
        saved["judge"] = self.judge.save()
        saved["loads"] = self.loads.copy()
        saved["half_kick"] = self.loaded.gather(self.half_kick.copy())
        saved["added_mass"] = self.added_mass.added.copy()
        return saved | dict(self.touching.save()) if self.touching else saved

    def load(self, state: Fields) -> None:
        """Restore a saved state, bit for bit."""
        self.state.forces[:] = 0.0
        self.all_ranks.restore(self.state, state)
        self.all_loads.left = True
        self.loads[:] = state["loads"]
        self.half_kick = np.array(state["half_kick"][self.loaded.ids])
        self.added_mass.restore(state["added_mass"], self.model)
        time, brought, steps, self.bound = state["accumulated"].tolist()
        self.accumulated = Accumulated(time, brought, int(steps))
        self.judge.load(state["judge"])
        if self.touching:
            self.touching.load(state)

    def begin_from(self, state: Fields) -> None:
        """Begin from the state of another run; times of pressures count from now on.

        Its partners may have pushed fewer or more nodes: those of the coupled faces come first.
        """
        pushed = {key: first_rows(state[key], self.loaded.size) for key in ("loads", "half_kick")}
        contact = self.touching.beginning(state) if self.touching else {}
        super().begin_from({**state, **pushed, **contact})
        self.accumulated.time = 0.0
        self.accumulated.steps = 0  # the first step takes down energies to judge by
        self.judge.most[:] = 0.0

    def totals(self) -> Totals:
        """Mass, momentum and energies, with added mass.

        Internal is strain, plastic work, stabilisation and springs of contact; work is that of
        pressures, rigid walls and mass damping; contact dissipates by friction and erosion.
        """
        mass = self.added_mass.total()[: self.model.moving]
        kicks = (self.loaded.rows, self.half_kick) if self.kicks_early else None
        energies = motion(self.state, mass, self.model.gravity, kicks)
        sums = totals(self.state, self.built, mass, energies, self.all_ranks)
        if self.touching:
            sums.internal += self.touching.penalty.numbers.energy
            sums.dissipated = self.touching.penalty.numbers.dissipated
        return sums

    def warnings(self) -> dict[str, str]:
        """Energy that appears, hourglassing, motion that bulk viscosity takes, poor contact."""
        texts = self.judge.warnings()
        return texts | self.touching.warnings() if self.touching else texts

    def notes(self) -> tuple[str, ...]:
        """Sizes of meshes from files and what of them is left out; integration in thin parts."""
        notes = *self.notes_of_mesh, *integration_notes(self.params)
        return (*notes, self.touching.note) if self.touching and self.touching.note else notes

    def view(self) -> Fields:
        """Outer faces with velocity, stress, plastic strain and temperature."""
        nodes, elements = self.all_ranks.nodes, self.all_ranks.elements
        kicks = (self.loaded.rows, self.half_kick) if self.kicks_early else None
        velocity = present_velocity(self.state.velocity, kicks)
        motion_of = np.hstack([self.state.position[nodes.rows], velocity[nodes.rows]])
        gathered = nodes.gather(motion_of), elements.gather(shown(self.places, self.state))
        mesh = self.all_ranks.mesh_to_show(self.mesh, self.built)
        return {} if self.all_ranks.rank else view(mesh, *gathered)

    def walls(self) -> Fields:
        """Return rigid walls, clamped faces and planes of symmetry."""
        mesh = self.all_ranks.mesh_to_show(self.mesh, self.built)
        return {} if self.all_ranks.rank else supports(self.params, mesh)

    def items(self) -> int:
        """Count the elements."""
        return self.all_ranks.elements.size
