"""Toys: a plate on springs, and a wave of pressure that runs along it."""

import numpy as np

from quintet.components.shared.geometry.surface_samples_mesh import mesh_answer
from quintet.interfaces.component import Component, Fields, Keys, Totals
from quintet.interfaces.params import NotNegative, Positive, parameters
from quintet.interfaces.ports import FACES, NODE_LOAD, SURFACE, SURFACE_LOAD


class Plate(Component):
    """Three by two faces whose twelve nodes are masses on springs."""

    takes = (NODE_LOAD,)
    gives = (FACES,)

    @parameters
    class Params:
        """Equal masses and springs; half a metre between nodes."""

        mass: Positive = 1.0  # kg
        stiffness: Positive = 40.0  # N/m
        dt: Positive = 0.01  # s

    def __init__(self, params: Params) -> None:
        self.params = params
        grid = np.array([[0.5 * i, 0.5 * j, 0.0] for j in range(3) for i in range(4)])
        self.start = grid  # (12, 3) m
        self.u, self.v, self.push = (np.zeros_like(grid) for _ in range(3))

    def describe(self) -> Fields:
        first = [4 * j + i for j in range(2) for i in range(3)]
        corner = np.array([[n, n + 1, n + 5, n + 4] for n in first], dtype=float)
        return {"faces.start": self.start.copy(), "faces.corner": corner}

    def sample(self, request: Fields) -> Fields:
        return mesh_answer("faces", request, self.describe())

    def stable_dt(self) -> float:
        return self.params.dt

    def take(self, fields: Fields) -> None:
        self.push = np.array(fields.get("node_load.force", self.push))

    def step(self, dt: float) -> None:
        """Störmer and Verlet: kick half, drift, kick half."""
        mass, stiffness = self.params.mass, self.params.stiffness
        half = self.v + 0.5 * dt * (self.push - stiffness * self.u) / mass
        self.u = self.u + dt * half
        self.v = half + 0.5 * dt * (self.push - stiffness * self.u) / mass

    def give(self, wanted: Keys) -> Fields:
        outputs = {"faces.position": self.start + self.u, "faces.velocity": self.v.copy()}
        return {key: outputs[key] for key in wanted}

    def save(self) -> Fields:
        return {"u": self.u.copy(), "v": self.v.copy(), "push": self.push.copy()}

    def load(self, state: Fields) -> None:
        self.u, self.v, self.push = (np.array(state[key]) for key in ("u", "v", "push"))

    def totals(self) -> Totals:
        mass, stiffness = self.params.mass, self.params.stiffness
        kinetic = 0.5 * mass * float((self.v**2).sum())
        internal = 0.5 * stiffness * float((self.u**2).sum())
        momentum = mass * self.v.sum(axis=0)
        return Totals(12 * mass, momentum, np.zeros(3), kinetic, 0.0, internal)


class Gust(Component):
    """A wave of pressure p sin(k (x - c t)) that runs along a surface, and drags on it."""

    takes = (SURFACE,)
    gives = (SURFACE_LOAD,)

    @parameters
    class Params:
        """How strong, long and fast the wave is, and how it samples the surface."""

        pressure: NotNegative = 3.0  # Pa
        wave: Positive = 2.0  # 1/m, k
        speed: Positive = 1.5  # m/s, c
        drag: NotNegative = 1.0  # Pa s/m
        spacing: Positive = 0.125  # m
        depth: Positive = 0.125  # m, of samples: one layer, on the faces themselves
        dt: Positive = 0.01  # s

    def __init__(self, params: Params) -> None:
        self.params = params
        self.time = 0.0  # s
        self.area = np.zeros(0)  # (n,) m2
        self.normal = np.zeros((0, 3))
        self.place, self.speed = np.zeros((0, 3)), np.zeros((0, 3))
        self.force = np.zeros((0, 3))

    def describe(self) -> Fields:
        params = self.params
        return {
            "surface.spacing": np.array([params.spacing]),
            "surface.depth": np.array([params.depth]),
            "surface.inset": np.array([0.0]),
        }

    def bind(self, static: Fields, joined: Keys) -> None:
        if "surface" not in joined:
            return
        self.area = static["surface.volume"] / self.params.spacing
        self.normal = np.array(static["surface.normal"])
        self.force = np.zeros_like(self.normal)

    def stable_dt(self) -> float:
        return self.params.dt

    def take(self, fields: Fields) -> None:
        self.place = np.array(fields.get("surface.position", self.place))
        self.speed = np.array(fields.get("surface.velocity", self.speed))

    def step(self, dt: float) -> None:
        params, middle = self.params, self.time + 0.5 * dt
        phase = params.wave * (self.place[:, :1] - params.speed * middle)
        stress = -params.pressure * np.sin(phase) * self.normal - params.drag * self.speed
        self.force = self.area[:, None] * stress
        self.time += dt

    def give(self, wanted: Keys) -> Fields:
        return {key: self.force.copy() for key in wanted}

    def save(self) -> Fields:
        state = {"place": self.place, "speed": self.speed, "force": self.force}
        return {key: array.copy() for key, array in state.items()} | {"time": np.array([self.time])}

    def load(self, state: Fields) -> None:
        self.place, self.speed = np.array(state["place"]), np.array(state["speed"])
        self.force, self.time = np.array(state["force"]), float(state["time"][0])
