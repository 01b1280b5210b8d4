"""Toy to which every law of the contract applies: bodies that samples around them drag."""

import numpy as np

from quintet.interfaces import rotation
from quintet.interfaces.component import (
    ONE_THREAD,
    Array,
    Component,
    Field,
    Fields,
    Keys,
    Port,
    Resources,
    Totals,
)
from quintet.interfaces.errors import StepError
from quintet.interfaces.manifest import ConformCase
from quintet.interfaces.params import NotNegative, Positive, Vector, parameters
from quintet.interfaces.ports import (
    ACTIVE,
    ANGULAR_VELOCITY,
    FORCE,
    LOAD,
    ORIENTATION,
    POSITION,
    VELOCITY,
)

MASS = Field("mass", (), "kg")
CLOUD = Port(
    "cloud",
    (POSITION, VELOCITY, ACTIVE),
    items="partner",
    static=(Field("volume", (), "m3"),),
    requests=(Field("spacing", (), "m"),),
)
CLOUD_LOAD = Port("cloud_load", (FORCE,), items="partner")
FLIGHT = Port("flight", (POSITION, VELOCITY, ORIENTATION, ANGULAR_VELOCITY, ACTIVE), static=(MASS,))
STATE = ("x", "v", "q", "spin", "active", "force", "torque", "cloud", "breathing", "drag", "clock")
FASTEST = 1e6  # m/s
ACTIVITY = {"cloud.active": ("cloud_load",), "flight.active": ("load",)}


class Sound(Component):
    """Bodies in free flight; a cloud drags the first body, and too fast bodies are inactive."""

    takes: tuple[Port, ...] = (LOAD, CLOUD)
    gives: tuple[Port, ...] = (FLIGHT, CLOUD_LOAD)

    @parameters
    class Params:
        """Equal bodies, and how fast each starts."""

        mass: Positive = 2.0  # kg
        velocities: tuple[Vector, ...] = ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))  # m/s
        spins: tuple[Vector, ...] = ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))  # rad/s
        fastest: Positive = 100.0  # m/s, of an active body
        noise: NotNegative = 0.0  # N
        seed: int = 1
        dt: Positive = 0.01  # s

    def __init__(self, params: Params, resources: Resources = ONE_THREAD) -> None:
        self.params, self.threads = params, resources.threads
        self.v, self.spin = np.array(params.velocities), np.array(params.spins)  # (n, 3)
        count = len(self.v)
        self.x, self.force, self.torque = (np.zeros((count, 3)) for _ in range(3))
        self.q = np.tile([1.0, 0.0, 0.0, 0.0], (count, 1))
        self.active = np.ones(count)
        self.volume = np.zeros(0)  # (samples,) m3
        self.cloud, self.drag = np.zeros((0, 3)), np.zeros((0, 3))  # m/s, N
        self.breathing = np.zeros(0)  # activity of the samples
        self.clock = np.zeros(1)  # steps

    def describe(self) -> Fields:
        mass = np.full(len(self.x), self.params.mass)
        return {"flight.mass": mass, "cloud.spacing": np.array([0.1])}

    def bind(self, static: Fields, joined: Keys) -> None:
        if "cloud" in joined:
            self.volume = np.array(static["cloud.volume"])
            self.cloud, self.drag = (np.zeros((len(self.volume), 3)) for _ in range(2))
            self.breathing = np.ones(len(self.volume))

    def stable_dt(self) -> float:
        return self.params.dt / (1.0 + float(np.abs(self.v).max()))

    def take(self, fields: Fields) -> None:
        self.force = np.array(fields.get("load.force", self.force))
        self.torque = np.array(fields.get("load.torque", self.torque))
        self.cloud = np.array(fields.get("cloud.velocity", self.cloud))
        self.breathing = np.array(fields.get("cloud.active", self.breathing))

    def drags(self) -> Array:
        """Force of the first body on each sample [N]."""
        return (self.volume * self.breathing)[:, None] * (self.v[0] - self.cloud)

    def step(self, dt: float) -> None:
        """Drift half, kick, drift half."""
        middle = self.x + 0.5 * dt * self.v
        q = rotation.turned(self.q, self.spin, 0.5 * dt)
        self.drag = self.drags()
        loads = self.active[:, None] * (self.force + self.noise())
        loads[0] -= self.drag.sum(axis=0)
        self.v = self.v + dt * loads / self.params.mass
        self.spin = self.spin + dt * self.active[:, None] * self.torque
        self.x, self.q = middle + 0.5 * dt * self.v, rotation.turned(q, self.spin, 0.5 * dt)
        self.active = self.active * (np.abs(self.v).max(axis=1) <= self.params.fastest)
        self.clock = self.clock + 1
        if np.abs(self.v).max() > FASTEST:
            raise StepError(f"step: a body must be slower than {FASTEST:g} m/s. Step shorter.")

    def noise(self) -> Array:
        """Force that swings from step to step [N]."""
        random = np.random.default_rng([self.params.seed, int(self.clock[0])])
        return self.params.noise * random.normal(size=self.x.shape)

    def outputs(self) -> dict[str, Array]:
        """All fields that it can give."""
        return {
            "flight.position": self.x,
            "flight.velocity": self.v,
            "flight.orientation": self.q,
            "flight.angular_velocity": self.spin,
            "flight.active": self.active,
            "cloud_load.force": self.drag,
        }

    def give(self, wanted: Keys) -> Fields:
        fields = self.outputs()
        return {key: fields[key].copy() for key in wanted}

    def save(self) -> Fields:
        return {key: getattr(self, key).copy() for key in STATE}

    def load(self, state: Fields) -> None:
        for key in STATE:
            setattr(self, key, np.array(state[key]))

    def totals(self) -> Totals:
        mass = self.params.mass
        kinetic = 0.5 * mass * float((self.v**2).sum())
        return Totals(mass * len(self.x), mass * self.v.sum(axis=0), np.zeros(3), kinetic)

    def view(self) -> Fields:
        return {"points": self.x.copy(), "velocity": self.v.copy()}

    def items(self) -> int:
        return len(self.x)

    @staticmethod
    def conform_cases() -> tuple[ConformCase, ...]:
        """At rest; spinning; with a body that is too fast, and noise."""
        zero_load = np.zeros((2, 3))
        inputs = {
            "static": {"cloud.volume": np.array([0.5, 0.3, 0.2])},
            "rest": {
                "load.force": zero_load,
                "load.torque": zero_load,
                "cloud.position": np.zeros((3, 3)),
                "cloud.velocity": np.zeros((3, 3)),
                "cloud.active": np.ones(3),
            },
            "scale": {"load.force": 5.0, "load.torque": 5.0, "cloud.velocity": 1.0},
            "activity": ACTIVITY,
        }
        forces = ("load.force", "cloud_load.force")
        spins = {"spins": [[5.0, 0.0, 1.0], [0.0, -3.0, 2.0]]}
        fast = {"velocities": [[1.0, 0.0, 0.0], [0.0, 9.0, 0.0]], "fastest": 8.0, "noise": 0.1}
        return (
            ConformCase("at rest", {}, forces=forces, **inputs),
            ConformCase("spinning", spins, still=False, **inputs),
            ConformCase("too fast", fast, still=False, smooth=False, **inputs),
        )
