"""Particles shared out among several ranks."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from quintet.components.shared.domain.collection import collect
from quintet.components.shared.domain.copies import CopiesAndImages, Extended, Group
from quintet.components.shared.domain.exchange import share
from quintet.components.shared.domain.extremes import added, greatest
from quintet.components.shared.domain.owner import owner_of
from quintet.components.shared.domain.sorting import grid_of_all, sort_by_cell
from quintet.components.shared.domain.waiting import wait_for_all
from quintet.components.shared.domain.work import Work
from quintet.components.shared.exact_sums import bounds, sum_parts, total
from quintet.components.shared.search.neighbours import NeighbourLists, neighbours_among
from quintet.components.shared.symmetry import Plane
from quintet.components.shared.threads import Team
from quintet.components.sph_solid.ranks.contact import ContactCopies
from quintet.components.sph_solid.state import OF_PARTICLES, Array, State, Whole, chosen
from quintet.interfaces.component import Fields
from quintet.interfaces.ports import RANK


class SeveralRanks:
    """A solid of which each rank has all until it is sorted for the first time, then its part.

    Parameters
    ----------
    communicator : mpi4py communicator
    planes : list of Plane
        Of symmetry.
    """

    def __init__(self, communicator: Any, planes: list[Plane]) -> None:
        self._communicator, self._work = communicator, Work()
        self.rank = communicator.rank
        self.images = CopiesAndImages(communicator, planes)
        self._shared = False  # whether each rank has its part alone
        self._particles = 0  # of all ranks
        self._keys: Whole = np.zeros(0, np.int64)

    def begin_step(self) -> None:
        """Begin to measure how long this rank computes."""
        self._work.begin()

    def end_step(self) -> None:
        """Stop measuring."""
        self._work.end()

    def sort(self, state: State, places: Array) -> None:
        """Bring particles to the ranks that own their cells, and near ones into near rows."""
        state.reference = np.ascontiguousarray(places[:, :3])
        if not self._shared:
            self._share_out(state)
        grid = grid_of_all(self._communicator, state.reference, state.reach)
        weights = self._work.weights(state.particles)
        arrays = [getattr(state, name) for name in OF_PARTICLES]
        self._keys, arrays, _ = sort_by_cell(
            self._communicator, grid, state.reference, self._keys, weights, arrays
        )
        for name, array in zip(OF_PARTICLES, arrays, strict=True):
            setattr(state, name, array)

    def _share_out(self, state: State) -> None:
        """Keep but a part of a state of which every rank has all."""
        rank, size, count = self._communicator.rank, self._communicator.size, state.particles
        self._shared, self._particles = True, count
        self._keys = np.arange(rank * count // size, (rank + 1) * count // size)
        state.reorder(self._keys)

    def neighbours(
        self, state: State, team: Team, buffer: NDArray[np.int32]
    ) -> tuple[Array, NeighbourLists]:
        """Places of particles, copies and images, and the lists of own particles."""
        places, reach = state.reference, state.reach
        extended = [self.copy(state)]
        points, (rows,) = self.images.find_images(extended, reach)
        nothing = np.zeros(0, np.int64)
        grid = grid_of_all(self._communicator, points.take(rows, axis=0), reach)
        count = state.particles
        lists = neighbours_among(reach, points, rows, nothing, places, count, team, buffer, grid)
        return points, lists

    def copy(self, state: State) -> Extended:
        """Find what other ranks have within the reach of lists, and copy it behind own rows."""
        group = Group(state.reference, self._keys, state.reference)
        return self.images.copy([group], state.reach)[0]

    def contact(self) -> ContactCopies:
        """Own particles, and copies of those that come near."""
        return ContactCopies(self._communicator, self._keys)

    def load(self, state: State) -> None:
        """Keep a part of a state of all particles."""
        self._share_out(state)

    def particles(self, state: State) -> int:
        """Number of particles of all ranks."""
        return self._particles if self._shared else state.particles

    def greatest(self, numbers: Array) -> Array:
        """Largest of all ranks of each number (k,)."""
        return greatest(self._communicator, numbers)

    def sums(self, state: State, columns: Sequence[Array]) -> Array:
        """Sums (k,) of columns (n,) over the particles of all ranks; they have no order."""
        largest = greatest(self._communicator, bounds(columns))
        parts = sum_parts(columns, largest, self.particles(state))
        return total(added(self._communicator, parts) if self._shared else parts)

    def all_rows(self, keys: Whole, rows: Array) -> Array:
        """Rows of all ranks on every rank, in the order of their keys; own ones (k, ...)."""
        if not self._shared:
            return rows
        order = np.argsort(np.concatenate(share(self._communicator, keys)), kind="stable")
        of_all = np.concatenate(share(self._communicator, rows.reshape(-1)))
        return of_all.reshape(-1, *rows.shape[1:])[order]

    def whole(self, state: State, names: Sequence[str] = ()) -> State:
        """All particles on rank 0, or these arrays of them; on others their own."""
        if not self._shared:
            return state
        order = np.argsort(collect(self._communicator, self._keys), kind="stable")
        arrays = {
            name: collect(self._communicator, getattr(state, name))
            for name in names or OF_PARTICLES
        }
        if self._communicator.rank:
            return state
        in_order: dict[str, Any] = {name: a.take(order, axis=0) for name, a in arrays.items()}
        return replace(state, **in_order)

    def agree(self, numbers: Array) -> None:
        """Take over numbers, in their array, from rank 0."""
        wait_for_all(self._communicator.Ibcast(numbers, 0))

    def owners(self, state: State) -> Fields:
        """Rank of each particle, in the order of birth."""
        ranks = np.full(state.particles, float(self.rank))
        return {RANK.name: self.all_rows(state.identity, ranks)}

    def owner(self, state: State, identity: int) -> str:
        """Name the rank that owns a particle, which rank 0 chooses; "" before they are shared."""
        return owner_of(self._communicator, state.identity, identity) if self._shared else ""

    def rows_of(self, state: State, identities: Whole) -> State:
        """Particles that were born with some numbers, in that order, on every rank."""
        # One particle may have several numbers in the list.
        each = [np.flatnonzero(state.identity == number) for number in identities]
        part = chosen(state, np.concatenate(each))
        numbers = np.repeat(np.arange(len(each)), [len(rows) for rows in each])
        arrays: dict[str, Any] = {
            name: self.all_rows(numbers, getattr(part, name)) for name in OF_PARTICLES
        }
        return replace(part, **arrays)
