"""Spheres shared out among several ranks."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from quintet.components.particle_dynamics.spheres.state import Spheres, State
from quintet.components.shared.domain.bisection import bisect
from quintet.components.shared.domain.collection import Collection
from quintet.components.shared.domain.extremes import added, greatest, least
from quintet.components.shared.domain.given_rows import Giving
from quintet.components.shared.domain.migration import migrate
from quintet.components.shared.domain.replication import Replication
from quintet.components.shared.exact_sums import bounds, sum_parts, total
from quintet.interfaces.component import Array, Fields

Whole = NDArray[np.int64]


class SeveralRanks:
    """The spheres of this rank; every method is called on all ranks in the same order.

    Parameters
    ----------
    communicator : mpi4py communicator
    spheres : Spheres
        All.
    state : State
        Of all, as it starts.
    width : float or None
        Edge [m] of the cells between which space is cut; None: spheres are shared out in blocks of
        their numbers, as they do not strike each other.
    """

    def __init__(
        self, communicator: Any, spheres: Spheres, state: State, width: float | None
    ) -> None:
        self.communicator, self.count, self._width = communicator, len(spheres.mass), width
        mine = np.flatnonzero(self._owners(state.position) == communicator.rank)
        self.spheres = Spheres(*(rows[mine] for rows in spheres))
        self.state = State._make([*(rows[mine] for rows in state[:-1]), state.sums])
        self._giving = Giving(communicator, self.count)
        self._set_ids(mine)

    def _set_ids(self, ids: Whole) -> None:
        self.ids = ids  # (m,) numbers of the spheres of this rank, rising
        self._collection = Collection(self.communicator, ids)

    def _owners(self, position: Array) -> Whole:
        """Rank (n,) that owns each of all spheres at positions (n, 3) m."""
        ranks = self.communicator.size
        if self._width is None:
            return np.arange(self.count) * ranks // self.count
        return bisect(np.floor(position / self._width), np.ones(self.count), ranks)

    def share_out(self) -> None:
        """Cut space again; bring all spheres to their owners."""
        position = Replication(self.communicator, self.ids, 3).gather(self.state.position)
        owner = self._owners(position)[self.ids]
        moved = *self.spheres, *self.state[:-1]
        numbers = tuple(np.asarray(rows, np.float64) for rows in moved)
        ids, arrays = migrate(self.communicator, owner, self.ids, numbers)
        first = len(self.spheres)
        state = State._make([*arrays[first:], self.state.sums])
        self.spheres = Spheres(*arrays[:first])
        self.state = state._replace(launched=state.launched != 0.0)
        self._set_ids(ids)

    def greatest(self, number: float) -> float:
        """Largest of all ranks of a number."""
        return float(greatest(self.communicator, np.array([number]))[0])

    def added(self, numbers: Array) -> Array:
        """Sums over all ranks of numbers (k,) whose sums are exact."""
        return added(self.communicator, numbers)

    def sums(self, columns: Sequence[Array]) -> Array:
        """Sums (k,) of columns (n,) over the spheres of all ranks; they have no order."""
        largest = greatest(self.communicator, bounds(columns))
        return total(added(self.communicator, sum_parts(columns, largest, self.count)))

    def not_finite(self, rows: Array) -> int:
        """Lowest number of a sphere whose row (n, 3) is not finite; their count if all are."""
        finite, lowest = np.isfinite(rows), self.count
        if not finite.all():
            lowest = int(self.ids[np.argmin(finite.all(axis=1))])
        return int(least(self.communicator, np.array([lowest]))[0])

    def here(self, rows: Array) -> Array:
        """Rows of this rank, of those of all spheres."""
        return rows[self.ids]

    def whole(self, rows: Array) -> Array:
        """Copy of the rows of all ranks on rank 0, in order; on others their own."""
        return self._collection.gather(rows)

    def give(self, rows: Sequence[Array]) -> Sequence[Array]:
        """Copies of some arrays of the rows of all ranks on rank 0, in memory that is kept."""
        return self._giving.give(self.ids, rows)

    def load(self, state: Fields) -> None:
        """Restore a state of all spheres, by as many ranks or others."""
        for name, array in self.state._asdict().items():
            array[:] = state[name] if name == "sums" else state[name][self.ids]
