"""Rigid bodies in contact, stepped by velocity Verlet."""

import math
from dataclasses import dataclass
from typing import Any, cast

import numpy as np

from quintet.components.dem_bodies import build, contact_kernels, kernels, search
from quintet.components.dem_bodies import state as rows
from quintet.components.dem_bodies.materials import DURATION, SPEED_UP
from quintet.components.dem_bodies.params import DemBodiesParams
from quintet.components.dem_bodies.state import Contacts, Numbers, State, empty_contacts
from quintet.interfaces.component import Array, Component, Fields, Totals
from quintet.interfaces.errors import StepError
from quintet.interfaces.ports import LOAD, MOTION

SKIN = 0.4  # over the smallest contact radius
DEEPEST = 0.2  # overlap over contact radius; Hertz's law holds for small ones
SHAPES = {"sphere": 0.0, "box": 1.0, "spheres": 2.0}  # as ports.MOTION gives them; 2 is our own


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
    gives = (MOTION,)

    def __init__(self, params: DemBodiesParams) -> None:
        self.params = params
        self.solids = [build.solid(body) for body in params.bodies]
        self.model = build.model(params, self.solids)
        self.state: State = build.state(params, self.solids)
        self.contacts: Contacts = empty_contacts(0)
        self.books = Books()
        self.mass = np.array([one.mass for one in self.solids])  # (m,) kg
        self.count = len(self.solids)
        self.skin = SKIN * float(self.model.sphere_radius.min())  # m
        self.frequency = build.expected_frequency(params, self.solids)  # rad/s
        self._before: Numbers = np.zeros_like(self.state.contact)
        self._move(0.0)

    def describe(self) -> Fields:
        """State shapes, sizes and masses; a clump is shape 2 with the box that holds it."""
        return {
            "motion.shape": np.array([SHAPES[body.shape] for body in self.params.bodies]),
            "motion.size": np.array([one.size for one in self.solids]),
            "motion.mass": self.mass.copy(),
        }

    def stable_dt(self) -> float:
        """Return a fraction of the contact time; before anything touches, of the time until then."""
        report = self.state.report
        ω = max(self.frequency, math.sqrt(report[rows.STIFFEST]))
        longest = self.params.longest_step
        if ω == 0.0:
            return longest
        contact = DURATION * SPEED_UP / ω / self.params.steps_per_contact
        # A pair that is not listed has been further apart than the skin, and has come nearer.
        gap = min(float(report[rows.GAP]), self._unlisted_gap())
        if gap <= 0.0:
            return contact
        speed = report[rows.FASTEST] + report[rows.HARDEST] * longest
        free = gap / (2.0 * speed) if speed > 0.0 else longest
        return float(max(min(longest, free), min(contact, longest)))

    def take(self, fields: Fields) -> None:
        """Set force [N] and torque [N m] on each body; without them there is none."""
        load = self.state.load
        force, torque = fields.get("load.force"), fields.get("load.torque")
        load[: self.count, :3] = 0.0 if force is None else force
        load[: self.count, 3:] = 0.0 if torque is None else torque

    def step(self, dt: float) -> None:
        """Advance by exactly dt [s]: half kick, drift, contacts, half kick."""
        held = float(self.state.report[rows.ELASTIC])
        start = self.state.position.copy() if self.state.load.any() else None
        self._move(dt)
        work = float(self.state.report[rows.WORK])
        self.books.dissipated += held - work - float(self.state.report[rows.ELASTIC])
        self.books.time += dt

    def give(self) -> Fields:
        """Copy out the motion of all bodies."""
        s, m = self.state, self.count
        return {
            "motion.position": s.position[:m].copy(),
            "motion.velocity": s.velocity[:m].copy(),
            "motion.orientation": s.orientation[:m].copy(),
            "motion.angular_velocity": s.angular_velocity[:m].copy(),
        }
