"""What a fluid asks of its inflows and outflows, and a fluid without any."""

from typing import Protocol

from quintet.components.sph_fluid.kernels import Rates
from quintet.components.sph_fluid.state import State


class OpenBoundaries(Protocol):
    """Faces of the tank through which fluid comes and goes."""

    def start(self, state: State) -> None:
        """Put particles into the buffers of inflows, at the start."""

    def renew(self, state: State) -> None:
        """Let particles come and go, before neighbour lists are made."""

    def resize(self, state: State) -> None:
        """Find the particles of buffers in a state with new lists."""

    def hold(self, state: State, rates: Rates) -> None:
        """Let the particles of buffers move as they do, whatever acts on them."""


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
