"""The frame that a fluid is computed in: that of the world, or that of its moving tank."""

from typing import TYPE_CHECKING, Protocol

import numpy as np

from quintet.components.shared.threads import Team
from quintet.components.sph_fluid.laws import PairLaw
from quintet.components.sph_fluid.params import SphFluidParams
from quintet.components.sph_fluid.state import Array, State
from quintet.interfaces.component import Fields
from quintet.interfaces.params import Vector

if TYPE_CHECKING:
    from quintet.components.sph_fluid.motion.laws import FrameForces


class Frame(Protocol):
    """What the forces of a step depend on beside the fluid itself."""

    work: float  # J, done on the fluid by the motion so far
    rest_acceleration: Vector  # m/s2, that fluid at rest in the middle of the tank is held against

    def weight_at(self, points: Array) -> Array:
        """Acceleration (n, 3) m/s2 that fluid at rest at points (n, 3) m is held against."""

    @property
    def forces(self) -> "FrameForces | None":
        """What its own accelerations are made of at a time; None where it has none."""

    def set_time(self, later: float) -> None:
        """Set the forces to those at a time [s] after the begin of the step."""

    def law(self, law: PairLaw) -> PairLaw:
        """Numbers of the pair law at that time."""

    def accelerate(self, state: State, rate: Array, largest: float, team: Team) -> float:
        """Add the frame's own accelerations to the rates (n, 4); return the largest [m/s2]."""

    def count_work(self, state: State, dt: float) -> None:
        """Count the work of a step [s], by the forces in its middle."""

    def advance(self, dt: float) -> None:
        """Go on to the end of a step [s]."""

    def save(self) -> dict[str, Array]:
        """Copy out its clock, and its work."""

    def load(self, state: Fields) -> None:
        """Come back to a saved state."""

    def refuse_bodies(self) -> None:
        """Refuse surfaces of partners where they are in another frame."""


class StillFrame:
    """The world's own."""

    work = 0.0
    forces: "FrameForces | None" = None

    def __init__(self, params: SphFluidParams) -> None:
        self.gravity = np.array(params.gravity)
        self.rest_acceleration = params.hydrostatic_gravity

    def weight_at(self, points: Array) -> Array:
        """Gravity, everywhere."""
        return np.tile(self.gravity, (len(points), 1))

    def set_time(self, later: float) -> None:
        """Nothing to do: gravity is the same at all times."""

    def law(self, law: PairLaw) -> PairLaw:
        """Return the law."""
        return law

    def accelerate(self, state: State, rate: Array, largest: float, team: Team) -> float:
        """Return the largest acceleration: there is none but gravity."""
        return largest

    def count_work(self, state: State, dt: float) -> None:
        """Nothing to do: there is no motion."""

    def advance(self, dt: float) -> None:
        """Nothing to do: it has no clock."""

    def save(self) -> dict[str, Array]:
        """Nothing to remember."""
        return {}

    def load(self, state: Fields) -> None:
        """Nothing to do: nothing is remembered."""

    def refuse_bodies(self) -> None:
        """Nothing to refuse."""
