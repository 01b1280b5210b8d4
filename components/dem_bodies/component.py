"""Rigid bodies in contact, stepped by velocity Verlet."""

import math
from dataclasses import dataclass

import numpy as np

from quintet.components.dem_bodies import ball_search, build, kernels, passes, rolling, search
from quintet.components.dem_bodies import state as rows
from quintet.components.dem_bodies.crowd import crowd_step, crowding, crowding_of_balls
from quintet.components.dem_bodies.materials import DURATION, SPEED_UP
from quintet.components.dem_bodies.params import CONTACT, DemBodiesParams
from quintet.components.dem_bodies.state import arrange, empty_contacts
from quintet.components.shared.threads import Team, threads_wanted
from quintet.interfaces.component import Array, Component, Fields, Totals
from quintet.interfaces.errors import StepError
from quintet.interfaces.ports import LOAD, MOTION

DEEPEST = 0.5  # overlap over contact radius; Hertz's law is for small ones
# As ports.MOTION gives them; 2 is our own.
SHAPES = {"sphere": 0.0, "box": 1.0, "spheres": 2.0, "agglomerate": 2.0}
FEWEST = 8  # blocks of rows that are worth handing to another thread
# Of the port, in the order that kernels.moves takes.
MOVES = ("motion.position", "motion.velocity", "motion.orientation", "motion.angular_velocity")
# Of the balls' pairs; the rest follows from these.
KEPT = ("begin", "partner", "held", "roll", "force")


@dataclass(slots=True)
class Books:
    """What a run has added up."""

    time: float = 0.0  # s
    dissipated: float = 0.0  # J, by dampers and friction
    given: float = 0.0  # J, work of the loads


class DemBodies(Component):
    """Moves rigid bodies under gravity, contact forces and the loads it is given.

    Parameters
    ----------
    params : DemBodiesParams
        Bodies, materials, planes.
    """

    takes = (LOAD,)

    def __init__(self, params: DemBodiesParams) -> None:
        self.params = params
        self.gives = (MOTION, CONTACT) if params.contact_forces else (MOTION,)
        self.solids = [build.solid(body) for body in params.bodies]
        number = build.balls_first(params.bodies)
        bodies, solids = [params.bodies[k] for k in number], [self.solids[k] for k in number]
        self.model = build.model(params, bodies, solids)
        self.state = build.state(bodies, number, solids)
        self.tally = np.zeros((rows.blocks_of(len(solids) + 1), rows.TALLIES))
        self.balls = ball_search.no_balls(self.model)
        self.contacts = empty_contacts(0)
        self.loaded = False  # whether any body has a load
        self.books = Books()
        self.count = len(self.solids)
        several = threads_wanted() > 1 and len(self.tally) >= 2 * FEWEST
        self.rolling = bool(self.model.law[:, :, 4].any() and self.model.ball.any())
        self.team = Team(threads_wanted() if several else 1, FEWEST, 1)
        self.mass = np.array([one.mass for one in self.solids])  # (m,) kg
        self.skin = build.SKIN * float(self.model.sphere_radius.min())  # m
        self.frequency = build.expected_frequency(params, self.solids)  # rad/s
        self.damping = float(self.model.law[:, :, 2].max())  # ζ of the most damped contact
        self.held = np.zeros(self.count + 1, np.int64)  # contacts of each row
        self.most = 0  # contacts that a row can have before pairs are listed anew
        self._move(0.0)

    def describe(self) -> Fields:
        """State shapes, sizes, masses; all clumps are shape 2 with the box that holds them."""
        return {
            "motion.shape": np.array([SHAPES[body.shape] for body in self.params.bodies]),
            "motion.size": np.array([one.size for one in self.solids]),
            "motion.mass": self.mass.copy(),
        }

    def stable_dt(self) -> float:
        """Return a fraction of a contact's duration; while nothing can touch, a longer step."""
        if self.params.step is not None:
            return self.params.step
        report, longest = self.state.report, self.params.longest_step
        stiffest = math.sqrt(report[rows.STIFFEST])  # rad/s
        ω = max(self.frequency, stiffest)
        contact = DURATION * SPEED_UP / ω / self.params.steps_per_contact
        if crowd_step(self.most, stiffest, self.damping) < contact:  # else no need to count them
            crowd = self._crowd(self.contacts.history, self.balls.held)
            contact = min(contact, crowd_step(crowd, stiffest, self.damping))
        # Pairs that are not listed were further apart than the skin, and may have come nearer.
        gap = min(report[rows.GAP], self.skin - 2.0 * math.sqrt(report[rows.WAY]))
        speed = report[rows.FASTEST] + report[rows.HARDEST] * longest
        free = gap / (2.0 * speed) if speed > 0.0 else longest
        return float(min(longest, max(free, contact)))

    def _crowd(self, history: Array, held: Array) -> int:
        """Most contacts of any row, of the pairs with a depth in `history` and in `held`."""
        pairs, model = self.contacts, self.model
        ends = (pairs.ends, pairs.begin, model.sphere_body, model.edge_ends)
        crowding(history, *ends, self.held)
        return crowding_of_balls(self.balls.row, self.balls.partner, held, self.held)

    def _crowd_listed(self) -> int:
        return self._crowd(np.ones_like(self.contacts.history), np.ones_like(self.balls.held))

    def take(self, fields: Fields) -> None:
        """Set force [N] and torque [N m] on each body; without them there is none."""
        force, torque = fields.get("load.force"), fields.get("load.torque")
        if force is None and torque is None and not self.loaded:
            return
        load, row = self.state.load, self.state.row[: self.count]
        load[row, :3] = 0.0 if force is None else force
        load[row, 3:] = 0.0 if torque is None else torque
        self.loaded = bool(load.any())

    def step(self, dt: float) -> None:
        """Advance by exactly dt [s]: half kick, drift, contacts, half kick."""
        report = self.state.report
        held = report[rows.ELASTIC]
        if self.params.contact_forces:
            self.state.before[:] = self.state.contact
        self._move(dt)
        self.books.time += dt
        self.books.given += float(report[rows.GIVEN])
        self.books.dissipated += float(held - report[rows.WORK] - report[rows.ELASTIC])

    def _move(self, dt: float) -> None:
        state, loaded, limit = self.state, self.loaded, 0.25 * self.skin**2
        if self.team.size > 1 or self.rolling:
            self._move_by_passes(dt, limit)
        elif not kernels.advance(*self._arrays(), dt, loaded, limit):
            self._list()
            kernels.resolve(*self._arrays(), dt, loaded)
        report = state.report
        if not (report[rows.DEEPEST] <= DEEPEST and math.isfinite(report[rows.WORK])):
            self._refuse(dt)

    def _move_by_passes(self, dt: float, limit: float) -> None:
        """Do as kernels.advance does, with the blocks of rows shared out among threads."""
        model, state, tally, loaded = self.model, self.state, self.tally, self.loaded
        team, blocks = self.team, len(self.tally)
        team.run(passes.drift, blocks, model, state, tally, dt, loaded)
        if not passes.furthest(state, tally) <= limit:
            self._list()
        team.run(passes.press_balls, blocks, model, state, self.balls, tally, dt)
        if self.rolling:
            team.run(rolling.resist, blocks, model, state, self.balls, tally, dt)
        passes.press_others(*self._arrays(), dt)
        team.run(passes.finish, blocks, model, state, self.balls, tally, dt, loaded)
        passes.close(state, tally)

    def _arrays(self) -> tuple[rows.Model, rows.State, rows.Balls, rows.Contacts, Array]:
        return self.model, self.state, self.balls, self.contacts, self.tally

    def _list(self) -> None:
        if not np.isfinite(self.state.position).all():
            self._refuse(0.0)
        pairs, asked = (self.balls, self.contacts), self.params.contact_forces
        self.balls, self.contacts = search.listed(self.model, self.state, *pairs, self.skin, asked)
        self.most = self._crowd_listed()
        self.state.report[rows.WAY] = 0.0

    def _refuse(self, dt: float) -> None:
        """End the run with the body that is wrong and what to do."""
        after = f"dem_bodies, t = {self.books.time + dt:.6g} s"
        s, m = self.state, self.count
        good = np.isfinite(s.motion.sum(axis=1))[s.row]
        if not good.all():
            k = int(np.argmin(good))
            a = s.row[k]
            raise StepError(
                f"{after}: the state must stay finite; body {k} is at {s.position[a].tolist()} m "
                f"with {s.velocity[a].tolist()} m/s under a load of {s.load[a].tolist()} N, N m. "
                "Look at the load it was given, or make steps_per_contact larger."
            )
        deepest, (i, j) = s.report[rows.DEEPEST], self._pair(int(s.report[rows.WHICH]))
        other = f"body {j}" if j < m else "a plane"
        raise StepError(
            f"{after}: a contact may be {DEEPEST} of its radius deep; body {i} is {deepest:.3g} of "
            f"it deep in {other}, near {s.position[s.row[i]].round(4).tolist()} m. Make young or "
            "rounding larger, or speed nearer to that of the impacts."
        )

    def _pair(self, which: int) -> tuple[int, int]:
        """Bodies of a pair as the report numbers them; planes are beyond all bodies."""
        count = len(self.balls.partner)
        if which < count:
            return ball_search.deepest(self.state, self.balls)
        touching = self.contacts.touching
        i, j = self.state.body[touching[touching[:, 0] == which - count][0, 1:3]]
        return int(i), int(j)

    def give(self) -> Fields:
        """Copy out the motion of all bodies; if asked for, what contacts did in the last step."""
        s, n = self.state, self.count
        # One piece of memory, for pieces of their own are fetched from the system at every call.
        parts = np.split(np.empty(13 * n), [3 * n, 6 * n, 10 * n])
        motion = dict(zip(MOVES, (part.reshape(n, -1) for part in parts), strict=True))
        kernels.moves(s, *motion.values())
        if not self.params.contact_forces:
            return motion
        mean = 0.5 * (s.before + s.contact)[s.row]  # gives the change of momentum to rounding
        return {**motion, "contact.force": mean[:, :3], "contact.torque": mean[:, 3:]}

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
        other = self.contacts
        count = int(self.state.report[rows.TOUCHING])
        geometry, bodies = other.geometry[:count], self.state.body[other.touching[:count, 1:3]]
        found = ball_search.touched(self.model, self.state, self.balls)
        return {
            "bodies": np.vstack([found.bodies, bodies]),
            "point": np.vstack([found.point, geometry[:, 3:6]]),
            "normal": np.vstack([found.normal, geometry[:, :3]]),
            "force": np.vstack([found.force, geometry[:, 8:]]),
            "depth": np.append(found.depth, geometry[:, 6]),
        }

    def save(self) -> Fields:
        """Copy out all state: bodies, listed pairs and their history, what was added up."""
        kept = {name: array.copy() for name, array in self.state._asdict().items()}
        kept["pairs.key"] = self.contacts.key.copy()
        kept["pairs.history"] = self.contacts.history.copy()
        kept |= {f"balls.{name}": getattr(self.balls, name).copy() for name in KEPT}
        kept["balls.partner"] = self.balls.partner.astype(np.int64)  # messages know no uint32
        books = self.books
        kept["books"] = np.array([books.time, books.dissipated, books.given])
        return kept

    def load(self, state: Fields) -> None:
        """Come back to a saved state, bit for bit."""
        balls = np.count_nonzero(self.model.ball)
        arrange(self.model, self.state, self.state.row[state["body"][:balls]])
        for name, array in self.state._asdict().items():
            array[:] = state[name]
        kept = empty_contacts(len(state["pairs.key"]))
        kept.key[:] = state["pairs.key"]
        kept.history[:] = state["pairs.history"]
        self.contacts = search.contacts_from(kept.key, kept)
        begin, partner = np.array(state["balls.begin"]), state["balls.partner"].astype(np.uint32)
        asked = self.params.contact_forces
        self.balls = ball_search.balls_from(self.model, begin, partner, asked)
        for name in KEPT[2:]:
            getattr(self.balls, name)[:] = state[f"balls.{name}"]
        self.most = self._crowd_listed()
        self.loaded = bool(self.state.load.any())
        self.books = Books(*state["books"].tolist())

    def totals(self) -> Totals:
        """Mass, momentum and energies of the bodies; internal is the contacts' elastic energy."""
        s, row, mass = self.state, self.state.row[: self.count], self.mass
        x, momentum = s.position[row], mass[:, None] * s.velocity[row]
        spin = kernels.spins(self.model, s)[row]
        return Totals(
            mass=float(mass.sum()),
            momentum=momentum.sum(axis=0),
            angular_momentum=(spin + np.cross(x, momentum)).sum(axis=0),
            kinetic=kernels.kinetic(self.model, s),
            potential=-float(mass @ (x @ self.model.fall[0])),
            internal=float(s.report[rows.ELASTIC]),
        )

    def view(self) -> Fields:
        """Corners and faces of boxes, centres of spheres, with body number and velocity."""
        points: list[Array] = []
        owners: list[int] = []
        faces: list[Array] = []
        for k, (body, a) in enumerate(zip(self.params.bodies, self.state.row, strict=False)):
            corners = self.solids[k].centres
            if body.size is not None:
                corners = build.CORNERS * 0.5 * np.array(body.size)
                faces.append(build.FACES + len(owners))
            axes = self.state.axes[a].reshape(3, 3)
            points.append(self.state.position[a] + corners @ axes.T)
            owners += [k] * len(corners)
        where, owner = np.vstack(points), np.array(owners)
        row = self.state.row[owner]
        spun = np.cross(self.state.angular_velocity[row], where - self.state.position[row])
        shown = {"points": where, "body": owner, "velocity": self.state.velocity[row] + spun}
        return shown | ({"cells": np.vstack(faces)} if faces else {})

    def items(self) -> int:
        """Count the bodies."""
        return self.count
