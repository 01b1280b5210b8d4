"""When a flow has settled: neither densities nor the force on walls change any more."""

from collections.abc import Mapping

import numpy as np

from quintet.components.meshless_gas.parts import Monitor, Reader, Walls
from quintet.components.meshless_gas.readings import Steady
from quintet.interfaces.component import Array, Fields

STEPS, SETTLED, SINCE, FORCE = 0, 1, 2, 3  # in the memory; the last has three numbers


class SteadyMonitor(Monitor):
    """Judges, every so many steps, whether a flow has settled."""

    def __init__(self, criteria: Steady, walls: Walls) -> None:
        self.criteria, self.walls = criteria, walls
        self.memory = np.zeros(6)

    @property
    def is_settled(self) -> bool:  # type: ignore[override]
        """Whether the flow has settled."""
        return bool(self.memory[SETTLED])

    def update(self, primitive: Array, change: float, time: float) -> None:
        """Count a step; every so many, compare the force on walls with that at the last check."""
        self.memory[STEPS] += 1.0
        if self.memory[STEPS] % self.criteria.steps != 0.0:
            return
        force = self.walls.force(primitive)
        moved = np.sqrt(((force - self.memory[FORCE:]) ** 2).sum())
        is_still = moved <= self.criteria.force * self.walls.scale(primitive)
        self.memory[FORCE:] = force
        if change <= self.criteria.change and is_still:
            self.memory[SETTLED], self.memory[SINCE] = 1.0, time

    def readers(self, primitive: Array) -> Mapping[str, Reader]:
        """Whether the flow has settled, beside the loads on the body."""
        return {"body": lambda: {"body.settled": np.array([float(self.is_settled)])}}

    def save(self) -> dict[str, Array]:
        """Copy out the memory."""
        return {"settling": self.memory.copy()}

    def restore(self, saved: Fields) -> None:
        """Return to a saved memory."""
        self.memory[:] = saved["settling"]
