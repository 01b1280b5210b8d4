"""The interface of a fluid to its pistons, and a fluid without any."""

from typing import Protocol

from quintet.components.sph_fluid.boundary.method import BoundaryMethod
from quintet.components.sph_fluid.state import Array, State
from quintet.interfaces.component import Fields


class Pistons(Protocol):
    """Parts of the boundary that move by themselves."""

    links: int  # samples that links bring, which theirs follow
    work: float  # J, that they did on the fluid so far

    def join(self, static: Fields) -> Fields:
        """Static fields of the samples that links bring, and of the pistons' after them."""

    def start(self, state: State, boundary: BoundaryMethod) -> None:
        """Put them where the scene has them."""

    def place(self, state: State, boundary: BoundaryMethod, dt: float) -> None:
        """Put them where they are in the middle of a step [s]."""

    def advance(self, state: State, dt: float) -> None:
        """Count the work of a step [s], and go on to its end."""

    def forces_of_links(self, state: State) -> Array:
        """Forces (samples, 3) N on the samples that links bring."""

    def faces(self) -> list[Array]:
        """Corners (k, 3) m of their faces where they are now, for pictures."""

    def save(self) -> dict[str, Array]:
        """Copy out their clock, and their work."""

    def load(self, state: Fields) -> None:
        """Come back to a saved state."""

    def refuse_jump(self, saved: Fields) -> None:
        """Refuse the state of another run in which they stand elsewhere than at their start."""


class NoPistons:
    """A boundary that stands."""

    links, work = 0, 0.0

    def join(self, static: Fields) -> Fields:
        """Return the fields of links alone."""
        self.links = len(static.get("surface.volume", ()))
        return static

    def start(self, state: State, boundary: BoundaryMethod) -> None:
        """Nothing to do: there are none."""

    def place(self, state: State, boundary: BoundaryMethod, dt: float) -> None:
        """Nothing to do: there are none."""

    def advance(self, state: State, dt: float) -> None:
        """Nothing to do: there are none."""

    def forces_of_links(self, state: State) -> Array:
        """All forces are on samples of links."""
        return state.force

    def faces(self) -> list[Array]:
        """None: there are no pistons."""
        return []

    def save(self) -> dict[str, Array]:
        """Nothing to remember."""
        return {}

    def load(self, state: Fields) -> None:
        """Nothing to do: nothing is remembered."""

    def refuse_jump(self, saved: Fields) -> None:
        """Nothing to do: there are none."""
