"""Copies in single precision of what pairs need; imported only by a scene that asks.

The state stays double. Positions are copied relative to the middle of the fluid and densities to
ρ₀, so that what is rounded away is 6e-8 of the fluid's extent and of its compression.
"""

from typing import Any

from quintet.components.shared.single_precision import SingleCopy, Singles, centre, rounded
from quintet.components.shared.threads import Team
from quintet.components.sph_fluid.laws import Fluid
from quintet.components.sph_fluid.state import State


def rounded_law(numbers: Any) -> Any:
    """Round the numbers of a law, with densities above that at no pressure; None stays None."""
    if isinstance(numbers, Fluid):
        numbers = numbers._replace(base=numbers.density)
    return rounded(numbers)


class Single:
    """Room for the copies of one fluid's state, from one list of neighbours to the next."""

    def __init__(self, state: State, density: float) -> None:
        origin = (*centre(state.reference[: state.fluid]), density)
        self.place = SingleCopy(state.place.shape, origin)
        self.motion = SingleCopy(state.motion.shape, (0.0, 0.0, 0.0, 0.0))

    def of(self, state: State, team: Team) -> tuple[Singles, Singles]:
        """Copy the state as it is now."""
        return self.place.of(state.place, team), self.motion.of(state.motion, team)
