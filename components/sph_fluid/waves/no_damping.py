"""The interface of a fluid to its damping zones, and a fluid without any."""

from typing import Protocol

from quintet.components.sph_fluid.state import Array, State
from quintet.interfaces.component import Fields


class Damping(Protocol):
    """Zones in which the fluid's motion is damped."""

    work: float  # J, that they did on the fluid so far; 0 or less

    def apply(self, state: State, dt: float) -> None:
        """Damp velocities at the end of a step [s]."""

    def save(self) -> dict[str, Array]:
        """Copy out their work."""

    def load(self, state: Fields) -> None:
        """Come back to a saved state."""


class NoDamping:
    """A fluid that nothing damps."""

    work = 0.0

    def apply(self, state: State, dt: float) -> None:
        """Nothing to do: there are none."""

    def save(self) -> dict[str, Array]:
        """Nothing to remember."""
        return {}

    def load(self, state: Fields) -> None:
        """Nothing to do: nothing is remembered."""
