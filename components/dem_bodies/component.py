"""Rigid bodies in contact, stepped by velocity Verlet."""

import math
from dataclasses import astuple
from typing import TYPE_CHECKING

import numpy as np

from quintet.components.dem_bodies import MANIFEST, begin, build, diagnostics, features, gauges
from quintet.components.dem_bodies import state as rows
from quintet.components.dem_bodies.diagnostics import ALLOWED_DEPTH, Accumulated
from quintet.components.dem_bodies.params import DemBodiesParams
from quintet.components.dem_bodies.ports import SHOWS
from quintet.components.dem_bodies.shapes.sampling import sample
from quintet.components.dem_bodies.shapes.solid import solids
from quintet.components.dem_bodies.start import described, masses
from quintet.components.dem_bodies.view import extent, planes_view, view
from quintet.interfaces.component import (
    ONE_THREAD,
    Array,
    Component,
    Fields,
    Keys,
    Resources,
    Totals,
)
from quintet.interfaces.errors import SceneError, StepError

if TYPE_CHECKING:
    from quintet.components.dem_bodies.partner_faces import PartnerFaces

LEAVE_PLANE = [1, 3, 5]  # force along y, torque about x and z
LOADS = ("load.force", "load.torque")
REACTION = "contact_load.force"
# Of the port, in the order in which rows are copied out.
MOTION = ("motion.position", "motion.velocity", "motion.orientation", "motion.angular_velocity")
CONTACT_FIELDS = ("contact.force", "contact.torque")
FRONT_FIELDS = ("front_gauge.position", "front_gauge.share")


class DemBodies(Component):
    """Moves rigid bodies under gravity, contact forces and loads.

    A user's class may derive from it, with a `Params` that derives from `DemBodiesParams`: in
    a scene it is a kind, ``module:Class``, with all ports of this one.

    Parameters
    ----------
    params : DemBodiesParams
        Bodies, materials, planes.
    """

    Params: type[DemBodiesParams] = DemBodiesParams

    manifest = MANIFEST
    shows = SHOWS

    def __init__(self, params: DemBodiesParams, resources: Resources = ONE_THREAD) -> None:
        self.params, (self.takes, self.gives) = params, self.ports_of(params)
        self.bodies, self.solids = params.placed, solids(params.placed)  # of the kinds of bodies
        number = build.balls_first(self.bodies)
        model = build.model(params, self.bodies, number, self.solids)
        state, parts = build.state(self.bodies, number, self.solids), (self.bodies, self.solids)
        self.begun_in = extent(state)  # box around the bodies at the start
        self.stepping = features.stepping(params, model, state, *parts, resources)
        self.model, self.state = self.stepping.model, self.stepping.state
        self.lists = self.stepping.lists
        self.timetable = features.timetable(params, self.bodies, self.model)
        self.limit = features.step_limit(params, self.model, *parts)
        self.accumulated = Accumulated()
        self.count, self.mass = len(self.bodies), masses(self.bodies, self.solids)  # (m,) kg
        self.loaded = False  # whether any body has a load
        self.begun = False  # whether the contacts of the start are known
        self.faces: PartnerFaces | None = None  # of a partner, that spheres touch
        self.resources = resources

    def describe(self) -> Fields:
        """State masses, and whether there are two dimensions."""
        return described(self.params, self.mass)

    def sample(self, request: Fields) -> Fields:
        """Sample the surfaces of all bodies as a partner requests."""
        return sample(self.bodies, request)

    def bind(self, static: Fields, joined: Keys) -> None:
        """Take the faces of a partner's mesh, where a link joins them."""
        self.faces = features.partner_faces(
            static, joined, self.params, self.model, self.state, self.mass, self.resources
        )

    def _begin(self) -> None:
        """Detect the contacts of the start, once.

        Kernels are compiled here: partners know by then what they wait for, and may compile theirs
        at the same time.
        """
        if not self.begun:
            self.begun = True
            self._move(0.0)
            self.give(frozenset(MOTION))
            self.totals()

    def stable_dt(self) -> float:
        """Return a fraction of a contact's duration; while nothing can touch, a longer step."""
        self._begin()
        free = self.limit.stable(self.state, self.lists)
        stable = min(free, self.faces.stable_step()) if self.faces else free
        time = self.accumulated.time
        return self.timetable.longest(time, stable) if self.timetable else stable

    def take(self, fields: Fields) -> None:
        """Set force [N] and torque [N m] on each body; 0 where none is given."""
        if self.faces:
            self.faces.penalty.take(fields)
        if not self.loaded and fields.keys().isdisjoint(LOADS):
            return
        load = np.zeros((self.count, 6))
        load[:, :3] = fields.get("load.force", 0.0)
        load[:, 3:] = fields.get("load.torque", 0.0)
        if self.params.dimensions == 2:
            load[:, LEAVE_PLANE] = 0.0
        self.stepping.set_loads(load)
        self.loaded = bool(load.any())

    def step(self, dt: float) -> None:
        """Advance by exactly dt [s]: half kick, drift, contacts, half kick."""
        self._begin()
        elastic = self.state.report[rows.ELASTIC_ENERGY]
        if self.faces:
            self.faces.kick(self.state, dt)
        if self.params.contact_forces:
            self.stepping.keep_contact_loads()
        if self.timetable:
            self.timetable.advance(self.state, self.accumulated.time, dt)
        self._move(dt)
        self.accumulated.add(dt, elastic, self.state.report)

    def _move(self, dt: float) -> None:
        """Advance; raise an error where neighbours cannot be listed, or overlaps are too deep."""
        listed, report = self.stepping.advance(self.state, dt, self.loaded), self.state.report
        is_finite = math.isfinite(report[rows.CONTACT_WORK])
        if listed and report[rows.DEEPEST] <= ALLOWED_DEPTH and is_finite:
            return
        time, balls = self.accumulated.time + dt * listed, self.stepping.pairs_of_all()
        _, state = self.stepping.whole()
        others, answers = self.lists.bodies, self.stepping.answers
        nothing: tuple[str, Array | None] = "", None
        text, place = diagnostics.failure(state, balls, others, time) if answers else nothing
        raise StepError(self.stepping.shared_text(text), place)

    def check(self) -> None:
        """Refuse a body whose rotation is not finite."""
        if self.stepping.is_alone and not self.stepping.is_finite():
            diagnostics.check(self.stepping.whole()[1])

    def give(self, wanted: Keys) -> Fields:
        """Copy out the motion of all bodies, and the contacts and the front if they are wanted."""
        fields = dict[str, Array]()
        if not wanted.isdisjoint(CONTACT_FIELDS):
            self._begin()
            _, s = self.stepping.whole("contact_load", "previous_contact_load")
            # The mean of both ends gives the change of momentum to rounding.
            mean = 0.5 * (s.previous_contact_load + s.contact_load)[s.row]
            fields |= {"contact.force": mean[:, :3], "contact.torque": mean[:, 3:]}
        if REACTION in wanted:
            reaction = self.faces.penalty.reaction if self.faces else np.zeros((0, 3))
            fields[REACTION] = reaction.copy()
        if not wanted.isdisjoint(FRONT_FIELDS):
            self._begin()
            whole, balls = self.stepping.whole("motion", "centre"), self.stepping.pairs_of_all()
            if self.stepping.answers:
                axis = gauges.AXES.index(str(self.params.front_gauge))
                fields |= gauges.front(*whole, balls, self.lists.bodies, axis)
        if not wanted.isdisjoint(MOTION):
            fields |= dict(zip(MOTION, self.stepping.motion(), strict=False))
        return {key: array for key, array in fields.items() if key in wanted}

    def contact_points(self) -> Fields:
        """List what touched in the last step, of bodies with `contact_forces`.

        Returns
        -------
        bodies : (k, 2) the first body and the other; `count` is the ground, which all planes are
        point, normal : (k, 3) m and 1, the normal towards the first body
        force : (k, 3) N on the first body
        depth : (k,) m, overlap
        """
        if not self.params.contact_forces:
            raise ValueError("contact_forces must be true to list contacts; found false. Set it.")
        self._begin()
        balls, whole = self.stepping.pairs_of_all(), self.stepping.whole()
        return diagnostics.contact_points(*whole, balls, self.lists.bodies)

    def save(self) -> Fields:
        """Copy out all state: bodies, listed pairs and their history, accumulated numbers."""
        self._begin()
        _, state = self.stepping.whole()
        arrays = {name: array.copy() for name, array in state._asdict().items()}
        arrays["accumulated"] = np.array(astuple(self.accumulated))
        arrays |= self.timetable.save() if self.timetable else {}
        arrays |= self.lists.save() | begin.surroundings(self.model)
        return arrays | dict(self.faces.penalty.save()) if self.faces else arrays

    def load(self, state: Fields) -> None:
        """Restore a saved state, bit for bit."""
        self.begun = True
        self.stepping.load(state)
        if self.faces:
            self.faces.penalty.load(state)
        self.loaded = bool(np.any(state["load"]))
        self.accumulated = Accumulated(*state["accumulated"].tolist())
        if self.timetable:
            self.timetable.load(state, self.state)

    def begin_from(self, state: Fields) -> None:
        """Begin from the state of another run, with the planes, materials and locks of this one."""
        if self.timetable:
            self.timetable.restart(self.state)
            state = {**state, **self.timetable.save()}
        has_rolling = self.lists.balls is not None and self.lists.balls.rolling_moment is not None
        lists = begin.Lists(has_rolling, self.params.contact_forces)
        parts = (self.bodies, self.solids, self.model)
        fitted, changed = begin.fitted(state, *parts, lists)
        self.load({**fitted, **(self.faces.penalty.beginning(state) if self.faces else {})})
        self.accumulated = Accumulated()
        if changed:
            self.begun = False
            try:
                self._begin()
            except StepError as error:
                raise SceneError(f"the first contacts after begin_from failed: {error}") from error

    def warnings(self) -> dict[str, str]:
        """Warn of contacts that few steps resolved, and of deep overlaps."""
        texts = self.accumulated.warnings()
        return texts | self.faces.penalty.warnings() if self.faces else texts

    def totals(self) -> Totals:
        """Mass, momentum and energies of the bodies; internal is the contacts' elastic energy."""
        self._begin()
        whole = self.stepping.whole("motion", "angular_momentum")
        if not self.stepping.answers:
            return Totals()
        totals = diagnostics.totals(*whole, self.mass)
        if self.faces:
            totals.kinetic += self.faces.penalty.numbers.half_kick
            totals.internal += self.faces.penalty.numbers.energy
            # Spheres that touch faces are free: nothing else takes or gives energy.
            by_friction = self.faces.penalty.numbers.dissipated
            totals.dissipated = self.accumulated.dissipated + by_friction
        return totals

    def view(self) -> Fields:
        """Corners and faces of boxes and polygons, centres and radii of spheres, velocities."""
        _, state = self.stepping.whole("motion")
        return view(self.bodies, self.solids, state) if self.stepping.answers else {}

    def walls(self) -> Fields:
        """Polygons on the planes, near where the bodies were at the start and where they are."""
        model, state = self.stepping.whole("motion")
        if not self.stepping.answers:
            return {}
        planes = model.plane[model.plane[:, 3] > rows.GONE]
        return planes_view(planes, (self.begun_in, extent(state)))

    def items(self) -> int:
        """Count the bodies."""
        return self.count
