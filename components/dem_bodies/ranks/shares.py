"""Which rank owns which rows: blocks of rows one after another, cut by measured time.

Rows are sorted by cell, layer after layer, so that the rows of a rank fill a slab of space.
"""

from typing import Any

import numpy as np
from mpi4py import MPI

from quintet.components.dem_bodies.state import BLOCK, Numbers, State, Whole, blocks_of
from quintet.components.shared.domain.exchange import share
from quintet.components.shared.domain.waiting import wait, wait_for_all
from quintet.components.shared.domain.work import Work


class Shares:
    """Rows of each rank.

    Parameters
    ----------
    communicator : mpi4py communicator
    rows : int
        Of all bodies and the ground.
    balls : int
        First rows, with the first spheres.
    """

    def __init__(self, communicator: Any, rows: int, balls: int) -> None:
        self.communicator, self.rows, self.balls = communicator, rows, balls
        self.work, self.rank, self.size = Work(), communicator.rank, communicator.size
        self.blocks = blocks_of(rows)
        inner = self.blocks * np.arange(1, self.size) // self.size
        self.cuts = self._between(inner)  # (size + 1,), between blocks

    @property
    def first(self) -> int:
        """First block of this rank."""
        return int(self.cuts[self.rank])

    @property
    def last(self) -> int:
        """Block behind the last one of this rank."""
        return int(self.cuts[self.rank + 1])

    def ends(self) -> Whole:
        """Where the rows of each rank begin and end (size + 1,)."""
        return np.minimum(BLOCK * self.cuts, self.rows)

    def rows_of(self, rank: int) -> slice:
        """Rows of a rank."""
        ends = self.ends()
        return slice(int(ends[rank]), int(ends[rank + 1]))

    def owners(self, rows: Whole) -> Whole:
        """Ranks that own rows (k,)."""
        return np.searchsorted(self.ends()[1:-1], rows, side="right")

    def cut(self) -> None:
        """Cut by the time that blocks took since the last cut; every rank gets the same cuts."""
        weights = np.concatenate(
            share(self.communicator, self.work.weights(self.last - self.first))
        )
        sums = np.cumsum(weights)
        shares = sums[-1] * np.arange(1, self.size) / self.size
        inner = np.searchsorted(sums - 0.5 * weights, shares)
        self.cuts = self._between(inner)

    def _between(self, inner: Whole) -> Whole:
        """Cuts of all ranks: the last one has all bodies that are no balls, and the ground."""
        return np.concatenate([[0], np.minimum(inner, self.balls // BLOCK), [self.blocks]])

    def everywhere(self, array: Numbers) -> None:
        """Bring the rows (n, width) of all ranks up to date on every rank."""
        self._everywhere(array, *self._counts(array.shape[1], self.rows, self.rows))

    def blocks_everywhere(self, sums: Numbers) -> None:
        """Bring the sums (blocks, width) of all ranks up to date on every rank."""
        width = sums.shape[1]
        counts, begins = (width * np.diff(self.cuts)).tolist(), (width * self.cuts[:-1]).tolist()
        self._everywhere(sums, counts, begins)

    def _everywhere(self, array: Numbers, counts: list[int], begins: list[int]) -> None:
        """Send the numbers of each rank in an array to all."""
        target, others = [array.reshape(-1), (counts, begins)], sum(counts) - counts[self.rank]
        wait_for_all(self.communicator.Iallgatherv(MPI.IN_PLACE, target), 8 * others)

    def gathered(self, array: Numbers, of_spheres: bool = False) -> Numbers:
        """Rows (n, width) of all ranks on rank 0; on others the array itself.

        An array of spheres has a row for each sphere, others one for each row of bodies.
        """
        width = int(np.prod(array.shape[1:]))
        rows = self.balls if of_spheres else self.rows
        counts, begins = self._counts(width, rows, len(array))
        begin, count = begins[self.rank], counts[self.rank]
        sent = array.reshape(-1)[begin : begin + count]
        if self.rank:
            wait_for_all(self.communicator.Igatherv(sent, None))
            return array
        of_all = np.empty_like(array)
        target = [of_all.reshape(-1), (counts, begins)]
        wait_for_all(self.communicator.Igatherv(sent, target), 8 * (sum(counts) - count))
        return of_all

    def from_last(self, state: State) -> None:
        """Bring bodies that are no balls, which the last rank moves, up to date on every rank."""
        rows, spheres = slice(self.balls, self.rows), slice(self.balls, len(state.centre))
        arrays = [state.axes[rows], state.centre[spheres], state.angular_momentum[rows]]
        arrays += [state.world_inverse_inertia[rows], state.orientation[rows]]
        wait(*(self.communicator.Ibcast(array, self.size - 1) for array in arrays))

    def _counts(self, width: int, rows: int, length: int) -> tuple[list[int], list[int]]:
        """Numbers of each rank, and where they begin, in an array (length, width).

        Only the first rows of it are shared out as rows of bodies; the last rank has the others.
        """
        ends = np.minimum(self.ends(), rows)
        ends[-1] = length
        return (width * np.diff(ends)).tolist(), (width * ends[:-1]).tolist()
