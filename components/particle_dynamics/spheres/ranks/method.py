"""What spheres ask of their ranks, be it one or several."""

from collections.abc import Sequence
from typing import Protocol

from quintet.components.particle_dynamics.spheres.state import Spheres, State
from quintet.interfaces.component import Array, Fields


class Ranks(Protocol):
    """The ranks of one set of spheres; of several, each calls every method, in the same order."""

    count: int  # spheres of all ranks
    spheres: Spheres  # of this rank
    state: State  # of this rank
    ids: Array  # (m,) numbers of the spheres of this rank

    def greatest(self, number: float) -> float:
        """Largest of all ranks of a number."""

    def added(self, numbers: Array) -> Array:
        """Sums over all ranks of numbers (k,) whose sums are exact."""

    def sums(self, columns: Sequence[Array]) -> Array:
        """Sums (k,) of columns (n,) over the spheres of all ranks; they have no order."""

    def not_finite(self, rows: Array) -> int:
        """Lowest number of a sphere whose row (n, 3) is not finite; their count if all are."""

    def here(self, rows: Array) -> Array:
        """Rows of this rank, of those of all spheres."""

    def whole(self, rows: Array) -> Array:
        """Copy of the rows of all ranks on rank 0, in order; on others of their own."""

    def give(self, rows: Sequence[Array]) -> Sequence[Array]:
        """Copies of some arrays of the rows of all ranks, as `whole`, in memory that is kept."""

    def load(self, state: Fields) -> None:
        """Restore a state of all spheres."""
