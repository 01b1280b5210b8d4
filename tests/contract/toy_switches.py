"""Toys: a switch that opens after its first window, and a lamp that notes what it sees."""

import math

import numpy as np

from quintet.interfaces.component import Component, Fields, Keys, Port
from quintet.interfaces.params import parameters
from quintet.interfaces.ports import ACTIVE

STATE = Port("state", (ACTIVE,))


class Switch(Component):
    """It is closed at the start."""

    gives = (STATE,)

    @parameters
    class Params:
        """It has none."""

    def __init__(self, params: Params) -> None:
        self.closed = np.ones(1)

    def stable_dt(self) -> float:
        return math.inf

    def take(self, fields: Fields) -> None:
        pass

    def step(self, dt: float) -> None:
        self.closed = np.zeros(1)

    def give(self, wanted: Keys) -> Fields:
        return {"state.active": self.closed.copy()}

    def save(self) -> Fields:
        return {"closed": self.closed.copy()}

    def load(self, state: Fields) -> None:
        self.closed = np.array(state["closed"])


class Lamp(Component):
    """It notes the state at every step."""

    takes = (STATE,)

    @parameters
    class Params:
        """It has none."""

    def __init__(self, params: Params) -> None:
        self.state, self.seen = 1.0, []

    def stable_dt(self) -> float:
        return math.inf

    def take(self, fields: Fields) -> None:
        self.state = float(fields["state.active"][0])

    def step(self, dt: float) -> None:
        self.seen.append(self.state)

    def give(self, wanted: Keys) -> Fields:
        return {}

    def save(self) -> Fields:
        return {"seen": np.array(self.seen)}

    def load(self, state: Fields) -> None:
        self.seen = np.array(state["seen"]).tolist()
