"""What a step in time is given, and what every scheme does with a row at its end."""

from collections.abc import Callable
from typing import NamedTuple, Protocol

from quintet.components.shared.threads import Team
from quintet.components.sph_fluid.state import Array, State

Moved = list[tuple[float, int]]  # of each share of the rows: greatest shift² [m2], and failures


class StepTask(NamedTuple):
    """One step of one fluid."""

    dt: float  # s
    rows: int  # whose density obeys the equation of continuity
    rate: Array  # (n, 4) m/s2, m/s2, m/s2, kg/(m3 s), as the last pass over pairs wrote it
    compute_rates: Callable[[float], None]  # writes those of the state as it is, with outer
    # forces at a share of the step
    apply_forces: Callable[[], None]  # once, with the forces that the step is made of


class Integration(Protocol):
    """A scheme in time."""

    def step(self, state: State, task: StepTask, team: Team) -> Moved:
        """Advance a state by a step."""
