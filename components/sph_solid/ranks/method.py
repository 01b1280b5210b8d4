"""What a solid asks of its ranks, be it one or several."""

from collections.abc import Sequence
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from quintet.components.shared.search.neighbours import NeighbourLists
from quintet.components.shared.symmetry import Plane
from quintet.components.shared.threads import Team
from quintet.components.sph_solid.state import Array, State, Whole
from quintet.interfaces.component import Fields


class Images(Protocol):
    """What stands behind a rank's own rows: images, and before these copies of others' rows."""

    @property
    def planes(self) -> list[Plane]:
        """Planes of symmetry."""

    def write_all(self, rows: int, positions: Array, vectors: Array, *tensors: Array) -> None:
        """Write those of positions and vectors, in columns 0 to 2, and of tensors."""

    def write_tensors(self, array: Array, rows: int) -> None:
        """Write those of tensors."""

    def write_values(self, array: Array, rows: int) -> None:
        """Write those of values."""


class Contact(Protocol):
    """Particles that may touch those of a rank: its own, and copies of others behind them."""

    def find(self, places: Array, reach: float) -> tuple[Array, Whole]:
        """Own places (n, 3) m and those within a reach [m], in order; the row of each."""

    def extend(self, *arrays: Array) -> list[Array]:
        """Own rows (n, width) of arrays, then copies as they are now."""


class Ranks(Protocol):
    """The ranks of one solid; of several, each calls every method, in the same order."""

    rank: int  # number of this one

    @property
    def images(self) -> Images:
        """What stands behind own rows."""

    def begin_step(self) -> None:
        """Begin to measure how long this rank computes."""

    def end_step(self) -> None:
        """Stop measuring."""

    def sort(self, state: State, places: Array) -> None:
        """Bring particles that are near, by places (n, 3 or more) m, into near rows."""

    def neighbours(
        self, state: State, team: Team, buffer: NDArray[np.int32]
    ) -> tuple[Array, NeighbourLists]:
        """All points (any, 3) m that lists are made of, by row, and the lists of own particles."""

    def contact(self) -> Contact:
        """Find what may touch own particles, in the order that they have now."""

    def load(self, state: State) -> None:
        """Take over a state of all particles that was loaded."""

    def particles(self, state: State) -> int:
        """Number of particles of all ranks."""

    def greatest(self, numbers: Array) -> Array:
        """Largest of all ranks of each number (k,)."""

    def sums(self, state: State, columns: Sequence[Array]) -> Array:
        """Sums (k,) of columns (n,) over the particles of all ranks; they have no order."""

    def all_rows(self, keys: Whole, rows: Array) -> Array:
        """Rows of all ranks on every rank, in the order of their keys; own ones (k, ...)."""

    def whole(self, state: State, names: Sequence[str] = ()) -> State:
        """All particles on rank 0, or these arrays of them; on others their own."""

    def agree(self, numbers: Array) -> None:
        """Take over numbers, in their array, from rank 0."""

    def owners(self, state: State) -> Fields:
        """Rank of each particle, in the order of birth, for a view; nothing of one rank."""

    def owner(self, state: State, identity: int) -> str:
        """Name the rank that owns a particle, which rank 0 chooses; "" of one rank."""

    def rows_of(self, state: State, identities: Whole) -> State:
        """Particles that were born with some numbers, in that order, on every rank."""


def extremes(ranks: Ranks, low: Array, high: Array) -> tuple[Array, Array]:
    """Smallest (3,) of rows (n, 3) of all ranks, and largest of others."""
    negative_and_high = ranks.greatest(np.concatenate([-low.min(axis=0), high.max(axis=0)]))
    return -negative_and_high[:3], negative_and_high[3:]
