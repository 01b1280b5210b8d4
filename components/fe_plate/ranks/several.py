"""Elements shared out among several ranks."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from quintet.components.fe_plate.build import Structure
from quintet.components.fe_plate.meshes.mesh import Mesh
from quintet.components.fe_plate.ranks.method import Rows
from quintet.components.fe_plate.ranks.partition import Part, at_once, cut, owners, part_of
from quintet.components.fe_plate.state import Array, State, Whole
from quintet.components.shared.domain.collection import Collection
from quintet.components.shared.domain.exchange import send_rows, share
from quintet.components.shared.domain.extremes import added, greatest, least
from quintet.components.shared.domain.halo import Halo
from quintet.components.shared.exact_sums import bounds, sum_parts, total

OF_BLOCKS = ("points", "springs")
MOST = 0.5  # of each rank's blocks: fewer are not stepped while copies travel


class SeveralRanks:
    """A structure of which each rank computes a part, the same one to the end.

    Parameters
    ----------
    communicator : mpi4py communicator
    ends : function
        Ends of the shares of a number of blocks among threads, from 0 on.
    """

    def __init__(self, communicator: Any, ends: Callable[[int], list[int]]) -> None:
        self._communicator, self._ends = communicator, ends
        self.rank = communicator.rank

    def share_out(self, built: Structure) -> Structure:
        """Return the part of a structure that this rank computes."""
        owner = owners(built, self._communicator.size)
        self._part, inner, border = part_of(built, owner, self.rank)
        part = self._part
        # Large messages arrive only while their sender waits too: all wait late, or none does.
        early = sum(span.last - span.first for span in inner) / len(part.block)
        if least(self._communicator, np.array([early]))[0] < MOST:
            inner, border = [], at_once(inner, border)
        self.nodes = self._rows(len(built.mesh.node), part.node[: part.moving], slice(part.moving))
        self.elements = self._rows(len(built.mesh.corner), part.element, slice(None))
        self._blocks = self._rows(
            len(built.model.filled), part.block[part.own_blocks], part.own_blocks
        )
        sent, received = self._neighbours(part, owner.node)
        self._motion = Halo(self._communicator, sent, received, (3, 3))
        self._velocity = Halo(self._communicator, sent, received, (3,))
        return cut(built, part, inner, border, self._ends)

    def _rows(self, count: int, ids: Whole, rows: Whole | slice) -> Rows:
        return Rows(count, rows, ids, Collection(self._communicator, ids))

    def _neighbours(self, part: Part, owner: Whole) -> tuple[list[Whole], list[Whole]]:
        """Rows of nodes that each rank gets from this one, and that it gives."""
        copies = part.node[part.moving :]
        received = [
            part.moving + np.flatnonzero(owner[copies] == rank)
            for rank in range(self._communicator.size)
        ]
        wanted = send_rows(self._communicator, [part.node[rows] for rows in received])
        return [np.searchsorted(part.node[: part.moving], nodes) for nodes in wanted], received

    def mesh_to_keep(self, mesh: Mesh) -> Mesh:
        """Return outer faces and sets of nodes on rank 0: all else can be gathered."""
        none: Whole = np.zeros(0, np.int64)  # a slice would hold the whole array
        side, owner, sets = (none.reshape(0, 4), none, {}) if self.rank else mesh[3:6]
        return Mesh(
            np.zeros((0, 3)), none.reshape(0, mesh.corner.shape[1]), none, side, owner, sets, {}
        )

    def mesh_to_show(self, mesh: Mesh, built: Structure) -> Mesh:
        """Return the mesh with the nodes and corners of all ranks on rank 0, but without parts."""
        corner = self._part.node[built.corners(slice(None))]
        return mesh._replace(
            node=self.nodes.gather(built.mesh.node[self.nodes.rows]),
            corner=self.elements.gather(corner),
        )

    def nodes_of(self, numbers: Whole) -> Rows:
        """Those of a list (k,) of nodes that this rank owns."""
        return self._among(self._part.node[: self._part.moving], numbers)

    def elements_of(self, numbers: Whole) -> Rows:
        """Those of a list (k,) of elements that this rank owns."""
        return self._among(self._part.element, numbers)

    def _among(self, owned: Whole, numbers: Whole) -> Rows:
        """Those of a list (k,) that are among the sorted numbers (n,) that this rank owns."""
        rows = np.searchsorted(owned, numbers)
        here = np.flatnonzero(np.append(owned, -1)[rows] == numbers)
        return self._rows(len(numbers), here, rows[here])

    def begin(self, state: State) -> None:
        """Begin to copy positions and mean velocities of nodes that others move."""
        self._motion.begin(state.position, state.mean_velocity)

    def finish(self, state: State) -> None:
        """Have these copies, and no forces on them."""
        self._motion.finish(state.position, state.mean_velocity)
        state.internal[self._part.moving :] = 0.0

    def copy_velocities(self, state: State) -> None:
        """Copy the velocities of nodes that others move."""
        self._velocity.exchange(state.velocity)

    def least(self, numbers: Array) -> Array:
        """Smallest of all ranks of each number (k,)."""
        return least(self._communicator, numbers)

    def greatest(self, numbers: Array) -> Array:
        """Largest of all ranks of each number (k,)."""
        return greatest(self._communicator, numbers)

    def sums(self, columns: Sequence[Array]) -> Array:
        """Sums (k,) of columns (n,) over the nodes or elements of all ranks; exact."""
        largest = greatest(self._communicator, bounds(columns))
        parts = sum_parts(columns, largest, self.nodes.size + self.elements.size)
        return total(added(self._communicator, parts))

    def lowest(self, row: Array) -> Array:
        """Of rows (k,), one of each rank, the one whose first number is the lowest."""
        return min(share(self._communicator, row), key=lambda numbers: float(numbers[0]))

    def whole(self, state: State) -> dict[str, Array]:
        """All arrays to save of the whole structure on rank 0."""
        arrays = {}
        for name, array in state.to_save().items():
            rows = self._blocks if name in OF_BLOCKS else self.nodes
            arrays[name] = rows.gather(array[rows.rows]) if len(array) else array.copy()
        return arrays

    def restore(self, state: State, saved: Mapping[str, Array]) -> None:
        """Take this rank's part of saved arrays of the whole structure."""
        for name, array in state.to_save().items():
            numbers = self._part.block if name in OF_BLOCKS else self._part.node
            array[:] = saved[name][numbers] if len(array) else saved[name]
