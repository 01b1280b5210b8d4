"""Rigid bodies in contact, stepped by velocity Verlet."""

import math
from dataclasses import astuple, dataclass

import numpy as np

from quintet.components.dem_bodies import MANIFEST, build, diagnostics
from quintet.components.dem_bodies import state as rows
from quintet.components.dem_bodies.contact import search
from quintet.components.dem_bodies.contact.ball_pairs import ball_pairs, no_ball_pairs
from quintet.components.dem_bodies.contact.materials import DURATION, SPEED_UP
from quintet.components.dem_bodies.contact.step_limit import many_contacts_step
from quintet.components.dem_bodies.diagnostics import (
    ALLOWED_DEPTH,
    contact_points,
    doubts,
    failure,
)
from quintet.components.dem_bodies.kernels import step as kernels
from quintet.components.dem_bodies.kernels.contact_counts import count_ball_contacts, count_contacts
from quintet.components.dem_bodies.params import DemBodiesParams
from quintet.components.dem_bodies.ports import SHOWS
from quintet.components.dem_bodies.shapes.sampling import sample
from quintet.components.dem_bodies.start import described
from quintet.components.dem_bodies.state import BallPairs
from quintet.components.dem_bodies.view import planes_view, view
from quintet.components.shared.threads import Team
from quintet.interfaces.component import (
    ONE_THREAD,
    Array,
    Component,
    Fields,
    Keys,
    Resources,
    Totals,
)
from quintet.interfaces.errors import StepError

LEAVE_PLANE = [1, 3, 5]  # force along y, torque about x and z
TURN = 0.05  # rad in a step of a free body that is no sphere: its energy is then kept to 1e-4
FEWEST = 8  # blocks of rows that are worth handing to another thread
SHARED = (kernels.DRIFT, kernels.BALLS, kernels.KICK)  # stages of a step that threads share out
# Of the port, in the order that kernels.copy_motion takes.
MOTION = ("motion.position", "motion.velocity", "motion.orientation", "motion.angular_velocity")
CONTACT_FIELDS = ("contact.force", "contact.torque")
# Of the pairs of balls; the rest follows from these.
SAVED = ("begin", "partner", "history", "rolling_moment", "force")


@dataclass(slots=True)
class Accumulated:
    """What a run has added up."""

    time: float = 0.0  # s
    dissipated: float = 0.0  # J, by dampers and friction
    given: float = 0.0  # J, work of the loads
    coarsest: float = 0.0  # longest step in contact, over the duration of that contact
    deepest: float = 0.0  # largest overlap over the radius of the contact


class DemBodies(Component):
    """Moves rigid bodies under gravity, contact forces and the loads it is given.

    A class of one's own may derive from it, with a `Params` that derives from `DemBodiesParams`: in
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
        self.bodies, self.solids = list(params.placed), build.solids(params)
        number = build.balls_first(self.bodies)
        bodies, solids = [self.bodies[k] for k in number], [self.solids[k] for k in number]
        self.model = build.model(params, bodies, solids)
        self.state = build.state(bodies, number, solids)
        self.sums = np.zeros((rows.blocks_of(len(solids) + 1), rows.SUMS))
        self.balls = no_ball_pairs(self.model)
        self.others = rows.body_pairs(0)
        self.loaded = False  # whether any body has a load
        self.accumulated = Accumulated()
        self.count = len(self.solids)
        several = resources.threads > 1 and len(self.sums) >= 2 * FEWEST
        self.team = Team(resources.threads if several else 1, FEWEST, 1)
        self.mass = np.array([one.mass for one in self.solids])  # (m,) kg
        self.skin = build.skin(self.bodies, self.solids)  # m
        self.frequency = build.expected_frequency(params, self.bodies, self.solids)  # rad/s
        self.damping = float(self.model.material_pairs[:, :, 2].max())  # ζ of the most damped
        self.contacts = np.zeros(self.count + 1, np.int64)  # of each row
        self.most_contacts = 0  # that a row can have before pairs are listed anew
        self.begun = False  # whether the contacts of the start are known

    def describe(self) -> Fields:
        """State masses, and whether there are two dimensions."""
        return described(self.params, self.solids)

    def sample(self, request: Fields) -> Fields:
        """Sample the surfaces of all bodies as a partner asks for it."""
        return sample(self.bodies, request)

    def _begin(self) -> None:
        """Detect the contacts of the start, once.

        Kernels are compiled here: not before partners know what they wait for, and may compile
        theirs meanwhile.
        """
        if not self.begun:
            self.begun = True
            self._move(0.0)
            self.give(frozenset(MOTION))
            self.totals()

    def stable_dt(self) -> float:
        """Return a fraction of a contact's duration; while nothing can touch, a longer step."""
        self._begin()
        if self.params.fixed_step is not None:
            return self.params.fixed_step
        report, longest = self.state.report, self.params.longest_step
        stiffest = math.sqrt(report[rows.STIFFEST])  # rad/s
        ω = max(self.frequency, stiffest)
        contact = DURATION * SPEED_UP / ω / self.params.steps_per_contact
        if many_contacts_step(self.most_contacts, stiffest, self.damping) < contact:
            most = self._most_contacts(False)
            contact = min(contact, many_contacts_step(most, stiffest, self.damping))
        # Pairs that are not listed were further apart than the skin, and may have come nearer.
        gap = min(report[rows.SMALLEST_GAP], self.skin - 2.0 * math.sqrt(report[rows.TRAVEL]))
        if self.count == 1:  # it turns within its bounding sphere, away from all that it can touch
            gap, longest = max(gap, self._clearance()), min(longest, self._turning_step())
        speed = report[rows.LARGEST_SPEED] + report[rows.LARGEST_ACCELERATION] * longest
        free = gap / (2.0 * speed) if speed > 0.0 else longest
        return float(min(longest, max(free, contact)))

    def _clearance(self) -> float:
        """Distance [m] of the first row's bounding sphere from the nearest plane."""
        plane, x = self.model.plane, self.state.position[0]
        away = plane[:, 0] * x[0] + plane[:, 1] * x[1] + plane[:, 2] * x[2] - plane[:, 3]
        return float((away - self.model.bounding_radius[0]).min(initial=math.inf))

    def _turning_step(self) -> float:
        """Step [s] that resolves the rotation of the first row, if its axis moves."""
        if self.model.isotropic[0]:
            return math.inf
        x, y, z = self.state.angular_velocity[0].tolist()
        return TURN / max(math.sqrt(x * x + y * y + z * z), 1e-300)

    def _most_contacts(self, listed: bool) -> int:
        """Most contacts of any row; with `listed` as if all pairs that are listed touched."""
        pairs, balls, model = self.others, self.balls, self.model
        history = np.ones_like(pairs.history) if listed else pairs.history
        ends = (pairs.ends, pairs.begin, model.sphere_row, model.edge_ends)
        count_contacts(history, *ends, self.contacts)
        if balls is not None:
            history = np.ones_like(balls.history) if listed else balls.history
            count_ball_contacts(balls.row, balls.partner, history, self.contacts)
        return int(self.contacts.max())

    def take(self, fields: Fields) -> None:
        """Set force [N] and torque [N m] on each body; without them there is none."""
        force, torque = fields.get("load.force"), fields.get("load.torque")
        if force is None and torque is None and not self.loaded:
            return
        load, row = self.state.load, self.state.row[: self.count]
        load[row, :3] = 0.0 if force is None else force
        load[row, 3:] = 0.0 if torque is None else torque
        if self.params.dimensions == 2:
            load[:, LEAVE_PLANE] = 0.0
        self.loaded = bool(load.any())

    def step(self, dt: float) -> None:
        """Advance by exactly dt [s]: half kick, drift, contacts, half kick."""
        self._begin()
        report = self.state.report
        elastic = report[rows.ELASTIC_ENERGY]
        if self.params.contact_forces:
            self.state.previous_contact_load[:] = self.state.contact_load
        self._move(dt)
        lost = elastic - report[rows.CONTACT_WORK] - report[rows.ELASTIC_ENERGY]
        self.accumulated.time += dt
        self.accumulated.given += float(report[rows.LOAD_WORK])
        self.accumulated.dissipated += float(lost)
        duration = DURATION * SPEED_UP / math.sqrt(max(report[rows.STIFFEST], 1e-300))  # s
        self.accumulated.coarsest = max(self.accumulated.coarsest, float(dt / duration))
        self.accumulated.deepest = max(self.accumulated.deepest, float(report[rows.DEEPEST]))

    def _move(self, dt: float) -> None:
        stage = kernels.DRIFT
        while stage != kernels.DONE:
            stage = self._advance(stage, dt)
            if stage == kernels.LIST:
                self._list()
                stage = kernels.BALLS
        report = self.state.report
        if not (report[rows.DEEPEST] <= ALLOWED_DEPTH and math.isfinite(report[rows.CONTACT_WORK])):
            raise self._failure(dt)

    def _advance(self, stage: int, dt: float) -> int:
        """Run all stages from one on; with several threads, that one. Return the next one."""
        pairs, limit = (self.balls, self.others), 0.25 * self.skin**2
        arguments = (self.model, self.state, *pairs, self.sums, dt, self.loaded, limit)
        blocks, several = len(self.sums), self.team.size > 1
        stages = stage, stage + 1 if several else kernels.DONE
        if several and stage in SHARED:
            return min(self.team.run(kernels.step, blocks, *stages, *arguments))
        return int(kernels.step(0, blocks, *stages, *arguments))

    def _list(self) -> None:
        if not np.isfinite(self.state.position).all():
            raise self._failure(0.0)
        pairs, asked = (self.balls, self.others), self.params.contact_forces
        self.balls, self.others = search.list_pairs(
            self.model, self.state, *pairs, self.skin, asked
        )
        self.most_contacts = self._most_contacts(True)
        self.sums[:, rows.TRAVEL] = 0.0

    def _failure(self, dt: float) -> StepError:
        return failure(self.state, self.balls, self.others, self.accumulated.time + dt)

    def give(self, wanted: Keys) -> Fields:
        """Copy out the motion of all bodies; if wanted, what contacts did in the last step."""
        s, n, found = self.state, self.count, dict[str, Array]()
        if not wanted.isdisjoint(CONTACT_FIELDS):
            self._begin()
            # The mean of both ends gives the change of momentum to rounding.
            mean = 0.5 * (s.previous_contact_load + s.contact_load)[s.row]
            found = {"contact.force": mean[:, :3], "contact.torque": mean[:, 3:]}
        if wanted.isdisjoint(MOTION):
            return {key: found[key] for key in wanted}
        # One piece of memory, for pieces of their own are fetched from the system at every call.
        parts = np.split(np.empty(13 * n), [3 * n, 6 * n, 10 * n])
        motion = dict(zip(MOTION, (part.reshape(n, -1) for part in parts), strict=True))
        kernels.copy_motion(s.row, s.motion, s.orientation, *motion.values())
        return {key: array for key, array in (found | motion).items() if key in wanted}

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
        return contact_points(self.model, self.state, self.balls, self.others)

    def save(self) -> Fields:
        """Copy out all state: bodies, listed pairs and their history, what was added up."""
        self._begin()
        kept = {name: array.copy() for name, array in self.state._asdict().items()}
        kept["others.key"] = self.others.key.copy()
        kept["others.history"] = self.others.history.copy()
        if self.balls is not None:
            for name in SAVED:
                array = getattr(self.balls, name)
                if array is not None:
                    kept[f"balls.{name}"] = array.copy()
            kept["balls.partner"] = self.balls.partner.astype(np.int64)  # messages know no uint32
        total = self.accumulated
        kept["accumulated"] = np.array(astuple(total))
        return kept

    def load(self, state: Fields) -> None:
        """Come back to a saved state, bit for bit."""
        self.begun = True
        balls = np.count_nonzero(self.model.ball)
        rows.sort_rows(self.model, self.state, self.state.row[state["body"][:balls]])
        for name, array in self.state._asdict().items():
            array[:] = state[name]
        kept = rows.body_pairs(len(state["others.key"]))
        kept.key[:] = state["others.key"]
        kept.history[:] = state["others.history"]
        self.others = search.body_pairs_of(kept.key, kept)
        if self.balls is not None:
            self.balls = self._saved_pairs(state)
        self.most_contacts = self._most_contacts(True)
        self.loaded = bool(self.state.load.any())
        self.accumulated = Accumulated(*state["accumulated"].tolist())

    def _saved_pairs(self, state: Fields) -> BallPairs:
        begin, partner = np.array(state["balls.begin"]), state["balls.partner"].astype(np.uint32)
        pairs = ball_pairs(self.model, begin, partner, self.params.contact_forces)
        for name in SAVED[2:]:
            array = getattr(pairs, name)
            if array is not None:
                array[:] = state[f"balls.{name}"]
        return pairs

    def warnings(self) -> dict[str, str]:
        """Warn of contacts that few steps resolved, and of deep overlaps."""
        return doubts(self.accumulated.coarsest, self.accumulated.deepest)

    def totals(self) -> Totals:
        """Mass, momentum and energies of the bodies; internal is the contacts' elastic energy."""
        self._begin()
        s, row, mass = self.state, self.state.row[: self.count], self.mass
        x, momentum = s.position[row], mass[:, None] * s.velocity[row]
        angular_momentum = diagnostics.angular_momenta(self.model, s)[row]
        return Totals(
            mass=float(mass.sum()),
            momentum=momentum.sum(axis=0),
            angular_momentum=(angular_momentum + np.cross(x, momentum)).sum(axis=0),
            kinetic=diagnostics.kinetic_energy(self.model, s),
            potential=-float(mass @ (x @ self.model.gravity)),
            internal=float(s.report[rows.ELASTIC_ENERGY]),
        )

    def view(self) -> Fields:
        """Corners and faces of boxes and polygons, centres and radii of spheres, velocities."""
        return view(self.bodies, self.solids, self.state)

    def walls(self) -> Fields:
        """Return what is near the bodies of the planes."""
        return planes_view(self.params.planes, self.state)

    def items(self) -> int:
        """Count the bodies."""
        return self.count
