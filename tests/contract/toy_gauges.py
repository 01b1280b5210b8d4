"""Toy: a component with many fields, which counts the requests for each."""

from collections import Counter

import numpy as np

from quintet.interfaces.component import Component, Field, Fields, Keys, Port
from quintet.interfaces.params import Count, Positive, parameters
from quintet.interfaces.ports import FORCE, POSITION, VELOCITY

REQUESTS: Counter[str] = Counter()
BINDINGS: dict[str, frozenset[str]] = {}
VALUE = Field("value", (), "Pa")


class Gauged(Component):
    """Points at rest, a force on them and a gauge that is expensive to read."""

    takes = (Port("load", (FORCE,)),)
    gives = (Port("motion", (POSITION, VELOCITY)), Port("push", (FORCE,)), Port("gauge", (VALUE,)))

    @parameters
    class Params:
        """How many points."""

        count: Count = 1000
        dt: Positive = 0.01  # s

    def __init__(self, params: Params) -> None:
        self.params = params
        REQUESTS.clear()

    def bind(self, static: Fields, joined: Keys) -> None:
        BINDINGS["joined"] = frozenset(joined)

    def stable_dt(self) -> float:
        return self.params.dt

    def take(self, fields: Fields) -> None:
        pass

    def step(self, dt: float) -> None:
        pass

    def give(self, wanted: Keys) -> Fields:
        REQUESTS.update(wanted)
        shapes = {"gauge.value": (self.params.count,)}
        return {key: np.zeros(shapes.get(key, (self.params.count, 3))) for key in wanted}

    def save(self) -> Fields:
        return {}

    def load(self, state: Fields) -> None:
        pass
