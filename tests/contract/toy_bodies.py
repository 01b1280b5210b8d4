"""Toys: balls that turn and move as they are pushed."""

from dataclasses import replace
from functools import partial

import numpy as np

from quintet.components.shared.geometry.surface_samples import rigid_answer, sphere
from quintet.interfaces.component import Array, Component, Fields, Keys, Port, Totals
from quintet.interfaces.params import Count, Positive, Vector, parameters
from quintet.interfaces.ports import LOAD, MOTION, RADIUS


def turn(orientation: Array, spin: Array, dt: float) -> Array:
    """Quaternions (n, 4) w, x, y, z after turning with spins (n, 3) rad/s for a time [s]."""
    rate = np.linalg.norm(spin, axis=1, keepdims=True)
    axis = spin / np.where(rate > 0.0, rate, 1.0)
    c, s = np.cos(0.5 * dt * rate), axis * np.sin(0.5 * dt * rate)
    w, v = orientation[:, :1], orientation[:, 1:]
    scalar = c * w - (s * v).sum(axis=1, keepdims=True)
    return np.concatenate([scalar, c * v + w * s + np.cross(s, v)], axis=1)


class Balls(Component):
    """Spheres in free motion, pushed by forces and torques about their centres."""

    takes = (LOAD,)
    gives = (replace(MOTION, static=(*MOTION.static, RADIUS)),)

    @parameters
    class Params:
        """Equal spheres, and where and how fast each starts."""

        diameter: Positive = 0.5  # m
        mass: Positive = 2.0  # kg
        positions: tuple[Vector, ...] = ((1.0, 2.0, 0.5), (2.0, 1.0, -1.0))  # m
        velocities: tuple[Vector, ...] = ((1.0, 0.0, 0.2), (0.0, -0.7, 0.0))  # m/s
        spins: tuple[Vector, ...] = ((0.5, 1.0, -2.0), (0.0, 3.0, 1.0))  # rad/s
        dt: Positive = 0.01  # s

    def __init__(self, params: Params) -> None:
        self.params = params
        self.x, self.v = np.array(params.positions), np.array(params.velocities)
        self.spin = np.array(params.spins)
        self.q = np.tile([1.0, 0.0, 0.0, 0.0], (len(self.x), 1))
        self.force, self.torque = np.zeros_like(self.x), np.zeros_like(self.x)
        self.inertia = 0.1 * params.mass * params.diameter**2  # kg m2

    def describe(self) -> Fields:
        count, params = len(self.x), self.params
        radius, mass = np.full(count, 0.5 * params.diameter), np.full(count, params.mass)
        return {"motion.radius": radius, "motion.mass": mass}

    def sample(self, request: Fields) -> Fields:
        ball = partial(sphere, self.params.diameter)
        return rigid_answer("motion", request, [ball] * len(self.x))

    def stable_dt(self) -> float:
        return self.params.dt

    def take(self, fields: Fields) -> None:
        self.force = np.array(fields.get("load.force", self.force))
        self.torque = np.array(fields.get("load.torque", self.torque))

    def step(self, dt: float) -> None:
        """Drift half, kick, drift half."""
        self.x, self.q = self.x + 0.5 * dt * self.v, turn(self.q, self.spin, 0.5 * dt)
        self.v = self.v + dt * self.force / self.params.mass
        self.spin = self.spin + dt * self.torque / self.inertia
        self.x, self.q = self.x + 0.5 * dt * self.v, turn(self.q, self.spin, 0.5 * dt)

    def give(self, wanted: Keys) -> Fields:
        outputs = {
            "motion.position": self.x,
            "motion.velocity": self.v,
            "motion.orientation": self.q,
            "motion.angular_velocity": self.spin,
        }
        return {key: outputs[key].copy() for key in wanted}

    def save(self) -> Fields:
        return {
            key: getattr(self, key).copy() for key in ("x", "v", "q", "spin", "force", "torque")
        }

    def load(self, state: Fields) -> None:
        for key in ("x", "v", "q", "spin", "force", "torque"):
            setattr(self, key, np.array(state[key]))

    def totals(self) -> Totals:
        mass = self.params.mass
        turning = mass * np.cross(self.x, self.v) + self.inertia * self.spin
        kinetic = 0.5 * mass * (self.v**2).sum() + 0.5 * self.inertia * (self.spin**2).sum()
        momentum = mass * self.v.sum(axis=0)
        return Totals(mass * len(self.x), momentum, turning.sum(axis=0), float(kinetic))


BODY = Port("body", MOTION.fields)
DRAG = Port("drag", LOAD.fields)


class Wind(Component):
    """Air that drags bodies towards its own velocity and spin, and hardens as it turns."""

    takes = (BODY,)
    gives = (DRAG,)

    @parameters
    class Params:
        """How fast it blows and turns, and how hard."""

        velocity: Vector = (2.0, 0.0, 0.5)  # m/s
        spin: Vector = (0.0, 0.5, 3.0)  # rad/s
        drag: Positive = 0.8  # N s/m
        twist: Positive = 0.05  # N m s
        count: Count = 2
        dt: Positive = 0.01  # s

    def __init__(self, params: Params) -> None:
        self.params = params
        self.force, self.torque = np.zeros((params.count, 3)), np.zeros((params.count, 3))

    def stable_dt(self) -> float:
        return self.params.dt

    def take(self, fields: Fields) -> None:
        if "body.velocity" not in fields:
            return
        params = self.params
        self.force = params.drag * (np.array(params.velocity) - fields["body.velocity"])
        hardening = 1.0 + fields["body.orientation"][:, 1:2] ** 2
        difference = np.array(params.spin) - fields["body.angular_velocity"]
        self.torque = params.twist * hardening * difference

    def step(self, dt: float) -> None:
        pass

    def give(self, wanted: Keys) -> Fields:
        outputs = {"drag.force": self.force, "drag.torque": self.torque}
        return {key: outputs[key].copy() for key in wanted}

    def save(self) -> Fields:
        return {"force": self.force.copy(), "torque": self.torque.copy()}

    def load(self, state: Fields) -> None:
        self.force, self.torque = np.array(state["force"]), np.array(state["torque"])
