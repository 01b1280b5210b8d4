"""When a flow has settled: neither densities nor the force on walls change any more."""

from collections.abc import Mapping

import numpy as np

from quintet.components.meshless_gas.build import Domain
from quintet.components.meshless_gas.parts import Monitor, Reader, Walls
from quintet.components.meshless_gas.ranks.one import Ranks
from quintet.components.meshless_gas.readings import Steady
from quintet.interfaces.component import Array, Fields

STEPS, SETTLED, SINCE, FORCE = 0, 1, 2, 3  # in the memory; the last has three numbers
APART = 1.15  # steps at one mark over those at the mark before
FEWEST = 20  # steps before the older mark, below which no drift is judged
# Drifts in a quarter of the run, at which a stand-off or a drag was found to be 3 % off.
QUARTER = 0.25
MOVED, NODES = 0.05, 0.08  # relative change of a density; share of the nodes that change by more
LOADS = 0.05  # change of the forces on wall nodes, over their sum


class SteadyMonitor(Monitor):
    """Judges, every so many steps, whether a flow has settled."""

    def __init__(
        self, criteria: Steady, walls: Walls, primitive: Array, domain: Domain, ranks: Ranks
    ) -> None:
        self.criteria, self.walls, self.domain, self.ranks = criteria, walls, domain, ranks
        self.nodes, self.forces = domain.cloud.nodes, walls.forces(primitive).size
        self.memory = np.zeros(6)
        # Steps, densities of nodes and forces on walls at two marks, the older first.
        self.marks = np.zeros((2, 1 + self.nodes + self.forces))

    @property
    def is_settled(self) -> bool:  # type: ignore[override]
        """Whether the flow has settled."""
        return bool(self.memory[SETTLED])

    @property
    def looks_next(self) -> bool:  # type: ignore[override]
        """Whether the next update looks at the states."""
        steps = self.memory[STEPS] + 1.0
        return bool(self._is_marked(steps) or self._is_checked(steps))

    def _is_marked(self, steps: float) -> bool:
        """Whether densities and forces are noted after so many steps."""
        return bool(steps > APART * self.marks[1, 0])

    def _is_checked(self, steps: float) -> bool:
        """Whether the force is compared with that at the last check."""
        return steps % self.criteria.steps == 0.0

    def update(self, primitive: Array, change: float, time: float) -> None:
        """Count a step; every so many, compare the force on walls with that at the last check."""
        self.memory[STEPS] += 1.0
        if self._is_marked(self.memory[STEPS]):
            self.marks[0] = self.marks[1]
            self.marks[1] = self._mark(primitive)
        if not self._is_checked(self.memory[STEPS]):
            return
        force = self.walls.force(primitive)
        moved = np.sqrt(((force - self.memory[FORCE:]) ** 2).sum())
        is_still = moved <= self.criteria.force * self.walls.scale(primitive)
        self.memory[FORCE:] = force
        if change <= self.criteria.change and is_still:
            self.memory[SETTLED], self.memory[SINCE] = 1.0, time

    def unsettle(self) -> None:
        """Let a flow that has settled go on, until the next look at least."""
        self.memory[SETTLED] = self.memory[SINCE] = 0.0

    def _mark(self, primitive: Array) -> Array:
        density, forces = primitive[: self.nodes, 0], self.walls.forces(primitive)
        return np.concatenate([self.memory[:1], density, forces.ravel()])

    def final_warnings(self, primitive: Array) -> dict[str, str]:
        """Warn of a flow that still changes much when the run ends."""
        if self.is_settled or self.marks[0, 0] < FEWEST:
            return {}
        drifts = self._drifts(primitive)
        if not drifts:
            return {}
        return {
            "steady": "the flow has not settled: in the last quarter of the run "
            f"{' and '.join(drifts)}. Raise end."
        }

    def _drifts(self, primitive: Array) -> list[str]:
        """Large changes since the older mark, in proportion to a quarter of the steps."""
        before, now = self.marks[0, 1:], self._mark(primitive)[1:]
        per_quarter = QUARTER / (1.0 - self.marks[0, 0] / self.memory[STEPS])
        rows = self.ranks.answered(self.domain)
        changes = np.abs(now[rows] / before[rows] - 1.0)
        many = self.ranks.total((changes > MOVED).astype(float))
        moving = per_quarter * many / self.ranks.total(np.ones(len(changes)))
        drifts = []
        if moving > NODES:
            drifts.append(
                f"densities changed by more than {MOVED:.0%} at {moving:.0%} of the nodes"
            )
        forces = now[self.nodes :].reshape(2, -1)
        sizes = np.abs(forces).sum(axis=1)
        moved = per_quarter * np.abs(forces - before[self.nodes :].reshape(2, -1)).sum(axis=1)
        # The pressure over a plate is hardly that of the stream: friction is the greater load.
        for name, drift, size in zip(
            ("pressure", "friction"), moved, (sizes.sum(), sizes[1]), strict=True
        ):
            if drift > LOADS * size:
                drifts.append(f"{name} on walls changed by {drift / size:.0%}")
        return drifts

    def readers(self, primitive: Array) -> Mapping[str, Reader]:
        """Whether the flow has settled, beside the loads on the body."""
        return {"body": lambda: {"body.settled": np.array([float(self.is_settled)])}}

    def save(self) -> dict[str, Array]:
        """Copy out the memory."""
        steps, densities, forces = np.split(self.marks, (1, 1 + self.nodes), axis=1)
        densities = self.ranks.collect(self.domain, densities.T).T
        marks = np.hstack([steps, densities, forces])
        return {"settling": self.memory.copy(), "settling_marks": marks}

    def restore(self, saved: Fields) -> None:
        """Return to a saved memory."""
        marks = saved["settling_marks"]
        steps, densities, forces = np.split(marks, (1, marks.shape[1] - self.forces), axis=1)
        self.memory[:] = saved["settling"]
        self.marks[:] = np.hstack([steps, self.ranks.rows_of(densities.T).T, forces])
