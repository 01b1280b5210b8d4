"""Toys: pucks slowed down by air, and a mass on a spring that carries another."""

import numpy as np

from quintet.interfaces.component import Component, Field, Fields, Keys, Port, Totals
from quintet.interfaces.params import Count, NotNegative, Number, Positive, Vector, parameters
from quintet.interfaces.ports import FORCE, POSITION, VELOCITY

X = np.array([1.0, 0.0, 0.0])
HEAT = Field("heat", (), "W", "impulse")
FLIGHT = Port("flight", (POSITION, VELOCITY))
BREATH = Port("breath", (FORCE, HEAT))


class Pucks(Component):
    """Rigid pucks that nothing holds; they warm up by friction."""

    takes = (BREATH,)
    gives = (FLIGHT,)

    @parameters
    class Params:
        """How heavy and how fast they are at the start."""

        mass: Positive = 2.0  # kg
        velocities: tuple[Vector, ...] = ((3.0, 0.0, 0.0), (0.0, -1.0, 0.5))  # m/s
        dt: Positive = 0.01  # s

    def __init__(self, params: Params) -> None:
        self.params = params
        self.velocity = np.array(params.velocities)  # (n, 3) m/s
        self.position = np.zeros_like(self.velocity)
        self.force = np.zeros_like(self.velocity)
        self.heating, self.warmth = np.zeros(len(self.velocity)), np.zeros(len(self.velocity))

    def stable_dt(self) -> float:
        return self.params.dt

    def take(self, fields: Fields) -> None:
        self.force = np.array(fields.get("breath.force", self.force))
        self.heating = np.array(fields.get("breath.heat", self.heating))

    def step(self, dt: float) -> None:
        kick = dt * self.force / self.params.mass
        self.position = self.position + dt * (self.velocity + 0.5 * kick)
        self.velocity = self.velocity + kick
        self.warmth = self.warmth + dt * self.heating

    def give(self, wanted: Keys) -> Fields:
        outputs = {"flight.position": self.position, "flight.velocity": self.velocity}
        return {key: outputs[key].copy() for key in wanted}

    def save(self) -> Fields:
        return {key: getattr(self, key).copy() for key in self.KEPT}

    def load(self, state: Fields) -> None:
        for key in self.KEPT:
            setattr(self, key, np.array(state[key]))

    KEPT = ("velocity", "position", "force", "heating", "warmth")

    def totals(self) -> Totals:
        mass, v = self.params.mass, self.velocity
        kinetic, warmth = 0.5 * mass * float((v**2).sum()), float(self.warmth.sum())
        return Totals(mass * len(v), mass * v.sum(axis=0), np.zeros(3), kinetic, 0.0, warmth)


class Air(Component):
    """Still air: it drags with -c v, and shares the lost energy with what it drags."""

    takes = (FLIGHT,)
    gives = (BREATH,)

    @parameters
    class Params:
        """Drag, and the part of the heat that goes back."""

        drag: NotNegative = 1.0  # N s/m, c
        share: NotNegative = 0.4
        count: Count = 2
        dt: Positive = 0.01  # s

    def __init__(self, params: Params) -> None:
        self.params = params
        self.speed = np.zeros((params.count, 3))
        self.momentum, self.warmth = np.zeros(3), 0.0

    def stable_dt(self) -> float:
        return self.params.dt

    def take(self, fields: Fields) -> None:
        self.speed = np.array(fields.get("flight.velocity", self.speed))

    def step(self, dt: float) -> None:
        drag, lost = self.params.drag, (self.speed**2).sum()
        self.momentum = self.momentum + dt * drag * self.speed.sum(axis=0)
        self.warmth += dt * drag * float(lost) * (1.0 - self.params.share)

    def give(self, wanted: Keys) -> Fields:
        drag, share = self.params.drag, self.params.share
        heat = share * drag * (self.speed**2).sum(axis=1)
        outputs = {"breath.force": -drag * self.speed, "breath.heat": heat}
        return {key: outputs[key] for key in wanted}

    def save(self) -> Fields:
        state = {"speed": self.speed.copy(), "momentum": self.momentum.copy()}
        return {**state, "warmth": np.array([self.warmth])}

    def load(self, state: Fields) -> None:
        self.speed, self.momentum = np.array(state["speed"]), np.array(state["momentum"])
        self.warmth = float(state["warmth"][0])

    def totals(self) -> Totals:
        return Totals(0.0, self.momentum.copy(), np.zeros(3), 0.0, 0.0, self.warmth)


SWING = Port("swing", (POSITION, VELOCITY))
CARRIED = Port("carried", (VELOCITY,))
LUMP = Port("lump", (FORCE,))


class Swing(Component):
    """A mass on a spring."""

    takes = (LUMP,)
    gives = (SWING,)

    @parameters
    class Params:
        """Drawn out by a metre at the start."""

        mass: Positive = 1.0  # kg
        stiffness: Positive = 10.0  # N/m
        start: Number = 1.0  # m
        dt: Positive = 0.01  # s

    def __init__(self, params: Params) -> None:
        self.params = params
        self.x, self.v, self.push = params.start * X[None], np.zeros((1, 3)), np.zeros((1, 3))

    def stable_dt(self) -> float:
        return self.params.dt

    def take(self, fields: Fields) -> None:
        self.push = np.array(fields.get("lump.force", self.push))

    def step(self, dt: float) -> None:
        """Störmer and Verlet: drift half, kick, drift half."""
        middle = self.x + 0.5 * dt * self.v
        self.v = self.v + dt * (self.push - self.params.stiffness * middle) / self.params.mass
        self.x = middle + 0.5 * dt * self.v

    def give(self, wanted: Keys) -> Fields:
        outputs = {"swing.position": self.x, "swing.velocity": self.v}
        return {key: outputs[key].copy() for key in wanted}

    def save(self) -> Fields:
        return {"x": self.x.copy(), "v": self.v.copy(), "push": self.push.copy()}

    def load(self, state: Fields) -> None:
        self.x, self.v, self.push = (np.array(state[key]) for key in ("x", "v", "push"))

    def totals(self) -> Totals:
        mass, stiffness = self.params.mass, self.params.stiffness
        kinetic = 0.5 * mass * float((self.v**2).sum())
        internal = 0.5 * stiffness * float((self.x**2).sum())
        return Totals(mass, mass * self.v[0], np.zeros(3), kinetic, 0.0, internal)


class Burden(Component):
    """A mass that is carried along: it answers with -m dv/dt, and starts at rest."""

    takes = (CARRIED,)
    gives = (LUMP,)

    @parameters
    class Params:
        """How heavy it is."""

        mass: Positive = 2.0  # kg
        dt: Positive = 0.01  # s

    def __init__(self, params: Params) -> None:
        self.params = params
        self.v, self.middle, self.force = (np.zeros((1, 3)) for _ in range(3))

    def stable_dt(self) -> float:
        return self.params.dt

    def take(self, fields: Fields) -> None:
        self.middle = np.array(fields.get("carried.velocity", self.middle))

    def step(self, dt: float) -> None:
        """The received velocity holds in the middle of the step; extrapolate it to the end."""
        end = 2.0 * self.middle - self.v
        self.force = -self.params.mass * (end - self.v) / dt
        self.v = end

    def give(self, wanted: Keys) -> Fields:
        return {key: self.force.copy() for key in wanted}

    def save(self) -> Fields:
        return {"v": self.v.copy(), "middle": self.middle.copy(), "force": self.force.copy()}

    def load(self, state: Fields) -> None:
        self.v, self.middle, self.force = (np.array(state[k]) for k in ("v", "middle", "force"))

    def totals(self) -> Totals:
        mass = self.params.mass
        kinetic = 0.5 * mass * float((self.v**2).sum())
        return Totals(mass, mass * self.v[0], np.zeros(3), kinetic)
