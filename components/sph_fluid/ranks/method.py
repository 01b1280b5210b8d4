"""What a fluid asks of its ranks, be it one or several."""

from collections.abc import Callable, Sequence
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from quintet.components.shared.geometry.bounds import Bounds
from quintet.components.sph_fluid.state import Array, State, Whole
from quintet.interfaces.component import Fields
from quintet.interfaces.errors import StepError


class NearRows(NamedTuple):
    """Rows of the fluid and of the boundary that are near to something, in their order."""

    position: Array  # (n, 4) m, m, m, kg/m3
    velocity: Array  # (n, 4) m/s, m/s, m/s, Pa m6/kg2
    split: int  # how many, the first, are fluid


class Ranks(Protocol):
    """The ranks of one fluid; of several, each calls every method, in the same order."""

    rank: int  # number of this one

    def begin_step(self) -> None:
        """Begin to measure how long this rank computes."""

    def end_step(self) -> None:
        """Stop measuring."""

    def sort(self, state: State, reach: float, walls: Bounds | None) -> None:
        """Bring particles that are near into near rows; drop those that left the domain."""

    def join(self, static: Fields) -> None:
        """Refuse samples that links bring if they need one rank."""

    def follow_samples(self, fields: Fields, first: int = 0) -> None:
        """Note where the samples from the first one on were placed."""

    def load(self, state: State) -> None:
        """Take over a state of all rows that was loaded."""

    def fluid(self, state: State) -> int:
        """Number of fluid particles of all ranks."""

    def boundary(self, state: State) -> int:
        """Number of wall and sample particles of all ranks."""

    def greatest(self, *numbers: float) -> tuple[float, ...]:
        """Largest of all ranks of each number."""

    def count(self, *numbers: int) -> tuple[int, ...]:
        """Sum over all ranks of each number of rows."""

    def sums(self, state: State, columns: Sequence[Array]) -> Array:
        """Sums (k,) of columns (fluid,) over the fluid of all ranks; they have no order."""

    def gather_forces(self, state: State, number: Whole) -> None:
        """Bring the forces on all samples to rank 0; `number` (k,) are those of this rank."""

    def boundary_keys(self, state: State) -> Whole:
        """Numbers (boundary,) that rise in the order in which one rank would have its rows."""

    def all_rows(self, keys: Whole, rows: Array) -> Array:
        """Rows of all ranks on every rank, in the order of their keys; own ones (k, ...)."""

    def whole(self, state: State) -> State:
        """All rows on rank 0; on others their own."""

    def owners(self, state: State) -> Fields:
        """Rank of each particle, in the order of birth, for a view; nothing of one rank."""

    def owner(self, state: State, identity: int) -> str:
        """Name the rank that owns a particle, which rank 0 chooses; "" of one rank."""

    def near(self, state: State, is_near: Callable[[Array], NDArray[np.bool_]]) -> NearRows:
        """Rows of all ranks that are near, or more, on rank 0; on others none."""


def refuse_none(left: int) -> None:
    """Raise if no fluid is left."""
    if not left:
        raise StepError("step: all fluid has left the domain. Check the walls and gravity.")


def places(state: State) -> Array:
    """Where all rows and mirror points are, as neighbour lists are made from it; (any, 3) m."""
    return np.concatenate([state.position_density[:, :3], state.mirror_point])
