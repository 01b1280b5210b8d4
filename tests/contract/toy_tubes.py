"""Toys: a membrane on a layer of still water, whose mass it must move with its own.

The model of Causin, Gerbeau and Nobile (2005), Comput. Methods Appl. Mech. Engrg. 194, 4506:
potential flow in a straight channel, no pressure at its ends, a wall that moves on one
side. Its pressure answers an acceleration by an added mass that is diagonal in sines and full in
the nodes; Förster, Wall and Ramm (2007), ibid. 196, 1278, show that no staggered scheme holds it.
"""

import math

import numpy as np

from quintet.interfaces.component import Array, Component, Fields, Keys, Port, Totals
from quintet.interfaces.params import Count, NotNegative, Number, Positive, parameters
from quintet.interfaces.ports import FORCE, POSITION, VELOCITY

MEMBRANE = Port("membrane", (POSITION, VELOCITY))
WALL = Port("wall", (VELOCITY,))
PRESSURE = Port("pressure", (FORCE,))
SWEEPS = 30  # to the tension at a step's end, at most
UP = np.array([0.0, 0.0, 1.0])


def sines(count: int) -> Array:
    """Orthonormal sines over the inner nodes (count, count), its own inverse."""
    numbers = np.arange(1, count + 1)
    angles = math.pi / (count + 1) * np.outer(numbers, numbers)
    return np.asarray(math.sqrt(2.0 / (count + 1)) * np.sin(angles))


def added_masses(count: int, length: float, depth: float, density: float) -> Array:
    """Added mass of each sine [kg per m of membrane], per unit width (Causin et al. 2005)."""
    waves = math.pi / length * np.arange(1, count + 1)  # 1/m
    return np.asarray(density / (waves * np.tanh(waves * depth)))


class Membrane(Component):
    """A string between two points; its tension rises as it is stretched (Kirchhoff's string).

    The implicit midpoint rule, with the mean of the tensions at both ends of the step, so that
    its energy is kept exactly.
    """

    takes = (PRESSURE,)
    gives = (MEMBRANE,)

    @parameters
    class Params:
        """A bump at a third of the length, at rest."""

        count: Count = 40  # nodes between the ends
        length: Positive = 1.0  # m
        mass: Positive = 1.0  # kg/m
        tension: Positive = 1.0  # N, unstretched
        stretch: NotNegative = 10.0  # N, force per strain
        height: Number = 0.05  # m, of the bump
        width: Positive = 0.15  # m
        dt: Positive = 0.01  # s

    def __init__(self, params: Params) -> None:
        self.params = params
        count, self.spacing = params.count, params.length / (params.count + 1)
        self.place = self.spacing * np.arange(1, count + 1)  # (n,) m
        self.sines = sines(count)
        half = 0.5 * math.pi / (count + 1) * np.arange(1, count + 1)
        self.waves = (2.0 / self.spacing * np.sin(half)) ** 2  # (n,) 1/m2, of second differences
        bump = np.exp(-(((self.place - params.length / 3.0) / params.width) ** 2))
        self.q = self.sines @ (params.height * bump)  # (n,) m, by sines
        self.v, self.push = np.zeros(count), np.zeros(count)  # m/s, N

    def stable_dt(self) -> float:
        return self.params.dt

    def take(self, fields: Fields) -> None:
        if "pressure.force" in fields:
            self.push = self.sines @ fields["pressure.force"][:, 2]

    def _slope(self, q: Array) -> float:
        """Integral of the slope squared [m]."""
        return self.spacing * float(self.waves @ q**2)

    def _tension(self, q: Array) -> float:
        params = self.params
        return params.tension + 0.5 * params.stretch / params.length * self._slope(q)

    def step(self, dt: float) -> None:
        half, before = 0.5 * dt / self.params.mass, self._tension(self.q)
        tension = before
        for _ in range(SWEEPS):
            force = self.push / self.spacing - tension * self.waves * self.q
            mean = (self.v + half * force) / (1.0 + 0.5 * dt * half * tension * self.waves)
            last, tension = tension, 0.5 * (before + self._tension(self.q + dt * mean))
            if abs(tension - last) <= 1e-14 * tension:
                break
        self.q, self.v = self.q + dt * mean, 2.0 * mean - self.v

    def give(self, wanted: Keys) -> Fields:
        start = np.outer(self.place, [1.0, 0.0, 0.0])
        position = start + np.outer(self.sines @ self.q, UP)
        velocity = np.outer(self.sines @ self.v, UP)
        outputs = {"membrane.position": position, "membrane.velocity": velocity}
        return {key: outputs[key] for key in wanted}

    def save(self) -> Fields:
        return {"q": self.q.copy(), "v": self.v.copy(), "push": self.push.copy()}

    def load(self, state: Fields) -> None:
        self.q, self.v, self.push = (np.array(state[key]) for key in ("q", "v", "push"))

    def totals(self) -> Totals:
        params, slope = self.params, self._slope(self.q)
        node_mass = params.mass * self.spacing  # kg of a node
        kinetic = 0.5 * node_mass * float(self.v @ self.v)
        momentum = node_mass * float((self.sines @ self.v).sum()) * UP
        internal = 0.5 * slope * (params.tension + 0.25 * params.stretch / params.length * slope)
        return Totals(node_mass * params.count, momentum, np.zeros(3), kinetic, 0.0, internal)


class Channel(Component):
    """Water under a wall that moves: potential flow, at rest at the start."""

    takes = (WALL,)
    gives = (PRESSURE,)

    @parameters
    class Params:
        """The layer, of unit width."""

        count: Count = 40  # nodes of the wall
        length: Positive = 1.0  # m
        depth: Positive = 0.5  # m
        density: Positive = 1.0  # kg/m2, of unit width
        dt: Positive = 0.01  # s

    def __init__(self, params: Params) -> None:
        self.params = params
        masses = added_masses(params.count, params.length, params.depth, params.density)
        shapes, spacing = sines(params.count), params.length / (params.count + 1)
        self.mass = spacing * (shapes * masses) @ shapes  # (n, n) kg, full
        self.v, self.middle, self.force = (np.zeros(params.count) for _ in range(3))

    def stable_dt(self) -> float:
        return self.params.dt

    def take(self, fields: Fields) -> None:
        if "wall.velocity" in fields:
            self.middle = np.array(fields["wall.velocity"][:, 2])

    def step(self, dt: float) -> None:
        """The received velocity holds in the middle of the step; extrapolate it to the end."""
        end = 2.0 * self.middle - self.v
        self.force = -self.mass @ (end - self.v) / dt
        self.v = end

    def give(self, wanted: Keys) -> Fields:
        return {key: np.outer(self.force, UP) for key in wanted}

    def save(self) -> Fields:
        return {"v": self.v.copy(), "middle": self.middle.copy(), "force": self.force.copy()}

    def load(self, state: Fields) -> None:
        self.v, self.middle, self.force = (np.array(state[k]) for k in ("v", "middle", "force"))

    def totals(self) -> Totals:
        momentum = self.mass @ self.v
        kinetic = 0.5 * float(self.v @ momentum)
        return Totals(float(self.mass.sum()), momentum.sum() * UP, np.zeros(3), kinetic)
