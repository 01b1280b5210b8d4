"""What a fluid asks of its inflows and outflows, and a fluid without any."""

from typing import Protocol

from quintet.components.sph_fluid.kernels import Rates
from quintet.components.sph_fluid.open_boundaries.saved_faces import refuse_other_faces
from quintet.components.sph_fluid.state import Array, State, Whole
from quintet.interfaces.component import Fields


class OpenBoundaries(Protocol):
    """Faces of the tank through which fluid comes and goes."""

    def start(self, state: State) -> None:
        """Put particles into the buffers of inflows, at the start."""

    def renew(self, state: State) -> None:
        """Let particles come and go, before neighbour lists are made."""

    def resize(self, state: State) -> None:
        """Find the particles of buffers in a state with new lists."""

    def hold(self, state: State, rates: Rates) -> None:
        """Keep the velocity and density of buffer particles: set their rates to 0."""

    def refuse_samples(self, points: Array) -> None:
        """Refuse samples (n, 3) m of bodies in buffers."""

    def save(self) -> dict[str, Whole]:
        """Copy out which faces have buffers."""

    def refuse_other(self, saved: Fields) -> None:
        """Refuse a saved state with buffers at other faces."""


class NoOpenBoundaries:
    """A fluid that stays in its tank, or goes over open faces unseen."""

    def start(self, state: State) -> None:
        """Nothing to do: there are no buffers."""

    def renew(self, state: State) -> None:
        """Nothing to do: nothing comes, and what goes is lost."""

    def resize(self, state: State) -> None:
        """Nothing to do: there are no buffers."""

    def hold(self, state: State, rates: Rates) -> None:
        """Nothing to do: there are no buffers."""

    def refuse_samples(self, points: Array) -> None:
        """Nothing to refuse: there are no buffers."""

    def save(self) -> dict[str, Whole]:
        """Nothing to remember."""
        return {}

    def refuse_other(self, saved: Fields) -> None:
        """Refuse a saved state with buffers."""
        refuse_other_faces(saved, [])
