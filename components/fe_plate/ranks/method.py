"""What a structure asks of its ranks, be it one or several."""

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple, Protocol

from quintet.components.fe_plate.build import Structure
from quintet.components.fe_plate.meshes.mesh import Mesh
from quintet.components.fe_plate.state import Array, State, Whole


class Gathering(Protocol):
    """Brings rows of all ranks together."""

    def gather(self, rows: Any) -> Any:
        """All rows (k, ...) on rank 0, of each rank's own; on others something else."""

    def give(self, rows: Sequence[Array]) -> Sequence[Array]:
        """The same of several arrays, with memory that is kept for the next time."""


class Rows(NamedTuple):
    """Nodes, elements or blocks of a list of the whole structure that this rank owns."""

    size: int  # k, of the list
    rows: Whole | slice  # rows of those in this rank's arrays
    ids: Whole | slice  # their places in the list
    gathering: Gathering

    def gather(self, rows: Any) -> Any:
        """All rows (k, ...), floats or ints, in the list's order on rank 0, of each rank's own."""
        return self.gathering.gather(rows)

    def give(self, arrays: Sequence[Array]) -> Sequence[Array]:
        """All rows (k, ...) in the list's order on rank 0, of arrays (n, ...) of this rank."""
        if isinstance(self.rows, slice):
            return self.gathering.give([array[self.rows] for array in arrays])
        # Faster than by brackets.
        return self.gathering.give([array.take(self.rows, axis=0) for array in arrays])


class Ranks(Protocol):
    """The ranks of one structure; of several, each calls every method, in the same order."""

    rank: int  # number of this one
    nodes: Rows  # all nodes
    elements: Rows  # all elements

    def share_out(self, built: Structure) -> Structure:
        """Keep what this rank computes of a structure; called once, before all others."""

    def mesh_to_keep(self, mesh: Mesh) -> Mesh:
        """Return what this rank keeps of the whole mesh, for pictures."""

    def mesh_to_show(self, mesh: Mesh, built: Structure) -> Mesh:
        """Return the whole mesh on rank 0, from what each rank has kept of it."""

    def nodes_of(self, numbers: Whole) -> Rows:
        """Those of a list (k,) of nodes."""

    def elements_of(self, numbers: Whole) -> Rows:
        """Those of a list (k,) of elements."""

    def begin(self, state: State) -> None:
        """Begin to copy positions and mean velocities of nodes that others move."""

    def finish(self, state: State) -> None:
        """Have these copies, and no forces on them."""

    def copy_velocities(self, state: State) -> None:
        """Copy the velocities of nodes that others move."""

    def least(self, numbers: Array) -> Array:
        """Smallest of all ranks of each number (k,)."""

    def greatest(self, numbers: Array) -> Array:
        """Largest of all ranks of each number (k,)."""

    def sums(self, columns: Sequence[Array]) -> Array:
        """Sums (k,) of columns (n,) over the nodes or elements of all ranks; exact."""

    def lowest(self, row: Array) -> Array:
        """Of rows (k,), one of each rank, the one whose first number is the lowest."""

    def whole(self, state: State) -> dict[str, Array]:
        """All arrays to save of the whole structure on rank 0."""

    def restore(self, state: State, saved: Mapping[str, Array]) -> None:
        """Take this rank's part of saved arrays of the whole structure."""
