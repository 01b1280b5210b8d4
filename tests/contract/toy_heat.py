"""Toys: a slab in steady conduction, and a wall of points that conducts to a noisy cold bath."""

import numpy as np

from quintet.components.shared.geometry.surface_samples_mesh import mesh_answer
from quintet.interfaces.component import Component, Fields, Keys, Totals
from quintet.interfaces.params import NotNegative, Number, Positive, parameters
from quintet.interfaces.ports import NODE_HEAT, NODE_TEMPERATURE, WALL_HEAT, WALL_TEMPERATURE


class Slab(Component):
    """Four nodes of one face, each joined to a hot side by a conductance; no heat capacity."""

    takes = (NODE_HEAT,)
    gives = (NODE_TEMPERATURE,)

    @parameters
    class Params:
        """One square face of a metre."""

        hot: Number = 400.0  # K
        conductance: Positive = 1.0  # W/K, of each node

    def __init__(self, params: Params) -> None:
        self.params = params
        self.temperature = np.full(4, params.hot)  # K
        self.flow = np.zeros(4)  # W
        self.gained = 0.0  # J

    def describe(self) -> Fields:
        square = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]])
        corner = np.array([[0.0, 1.0, 2.0, 3.0]])
        return {"node_temperature.start": square, "node_temperature.corner": corner}

    def sample(self, request: Fields) -> Fields:
        return mesh_answer("node_temperature", request, self.describe())

    def stable_dt(self) -> float:
        return np.inf

    def take(self, fields: Fields) -> None:
        self.flow = np.array(fields.get("node_heat.heat_flow", self.flow))

    def step(self, dt: float) -> None:
        self.temperature = self.params.hot + self.flow / self.params.conductance
        self.gained += dt * float(self.flow.sum())

    def give(self, wanted: Keys) -> Fields:
        return {key: self.temperature.copy() for key in wanted}

    def save(self) -> Fields:
        state = {"temperature": self.temperature.copy(), "flow": self.flow.copy()}
        return {**state, "gained": np.array([self.gained])}

    def load(self, state: Fields) -> None:
        self.temperature, self.flow = np.array(state["temperature"]), np.array(state["flow"])
        self.gained = float(state["gained"][0])

    def totals(self) -> Totals:
        return Totals(internal=self.gained)


class Wall(Component):
    """Points that conduct from the slab to a cold bath."""

    takes = (WALL_TEMPERATURE,)
    gives = (WALL_HEAT,)

    @parameters
    class Params:
        """Four points about the middle of the slab's face, so that all nodes are alike."""

        cold: Number = 300.0  # K
        conductance: Positive = 3.0  # W/K, of each point
        noise: NotNegative = 0.0  # of the flow, from step to step
        dt: Positive = 0.01  # s

    def __init__(self, params: Params) -> None:
        self.params = params
        self.temperature = np.full(4, params.cold)  # K
        self.flow = np.zeros(4)  # W
        self.steps, self.lost = 0, 0.0

    def describe(self) -> Fields:
        place = [[x, y, 0.0] for x in (0.25, 0.75) for y in (0.25, 0.75)]
        return {"wall_heat.position": np.array(place)}

    def stable_dt(self) -> float:
        return self.params.dt

    def take(self, fields: Fields) -> None:
        self.temperature = np.array(fields.get("wall_temperature.temperature", self.temperature))

    def step(self, dt: float) -> None:
        random = np.random.default_rng(self.steps)
        swing = 1.0 + self.params.noise * random.normal(size=4)
        self.flow = -self.params.conductance * (self.temperature - self.params.cold) * swing
        self.steps, self.lost = self.steps + 1, self.lost + dt * float(self.flow.sum())

    def give(self, wanted: Keys) -> Fields:
        return {key: self.flow.copy() for key in wanted}

    def save(self) -> Fields:
        state = {"temperature": self.temperature.copy(), "flow": self.flow.copy()}
        return {**state, "books": np.array([self.steps, self.lost])}

    def load(self, state: Fields) -> None:
        self.temperature, self.flow = np.array(state["temperature"]), np.array(state["flow"])
        self.steps, self.lost = int(state["books"][0]), float(state["books"][1])

    def totals(self) -> Totals:
        return Totals(internal=-self.lost)
