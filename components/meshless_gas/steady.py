"""When a flow has settled: densities hardly change any more, nor does the force on walls."""

import numpy as np

from quintet.components.meshless_gas.readings import Steady
from quintet.interfaces.component import Array, Fields

STEPS, SETTLED, SINCE, FORCE = 0, 1, 2, 3  # in the memory; the last has three numbers


class Settling:
    """Looks, every so many steps, whether a flow has settled."""

    def __init__(self, says: Steady) -> None:
        self.says = says
        self.memory = np.zeros(6)

    @property
    def is_settled(self) -> bool:
        """Whether it has."""
        return bool(self.memory[SETTLED])

    def is_due(self) -> bool:
        """Count a step; whether to look after it."""
        self.memory[STEPS] += 1.0
        return self.memory[STEPS] % self.says.steps == 0.0

    def look(self, change: float, force: Array, scale: float, time: float) -> None:
        """Compare with the last look.

        Parameters
        ----------
        change : float, 1
            Root mean square of the densities' relative change in the last step.
        force : (3,) N
            On all walls together.
        scale : float, N
            Sum of the sizes of the forces on their nodes.
        time : float, s
        """
        moved = np.sqrt(((force - self.memory[FORCE:]) ** 2).sum())
        is_still = moved <= self.says.force * scale
        self.memory[FORCE:] = force
        if change <= self.says.change and is_still:
            self.memory[SETTLED], self.memory[SINCE] = 1.0, time

    def save(self) -> dict[str, Array]:
        """Copy out what is remembered."""
        return {"settling": self.memory.copy()}

    def load(self, state: Fields) -> None:
        """Come back to what was saved."""
        self.memory[:] = state["settling"]
