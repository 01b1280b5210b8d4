"""Nodes shared out among several ranks: each has the states of all, and stencils of its own."""

from itertools import pairwise
from typing import Any

import numpy as np

from quintet.components.meshless_gas.build import Domain, Rows
from quintet.components.meshless_gas.ranks.part_stencils import part_stencils, unwritten
from quintet.components.shared.domain.extremes import greatest, least
from quintet.components.shared.domain.waiting import wait_for_all
from quintet.interfaces.component import Array


class SeveralRanks:
    """A gas whose rates are computed where its nodes belong.

    Ranks own about as many of the nodes that are advanced, one behind the other in their order.

    Parameters
    ----------
    communicator : mpi4py communicator
    """

    def __init__(self, communicator: Any) -> None:
        self._communicator = communicator
        self._domain: Domain | None = None  # that was shared out
        self._share: Domain | None = None
        self._buffers: dict[int, Array] = {}  # by numbers in a row

    def share(self, domain: Domain) -> Domain:
        """Return a domain of which `inner` and `every` are the nodes that this rank computes."""
        if self._share is None or self._domain is not domain:
            first, last = self._part(domain, self._communicator.rank)
            nodes = domain.inner[first:last]
            needed, ghosts = _needed(domain, nodes)
            self._domain = domain
            self._share = domain._replace(inner=nodes, every=needed, ghosts=ghosts)
            self._buffers = {}
        return self._share

    def room(self, shape: tuple[int, ...]) -> Array:
        """Zeros of a shape, of which rows that are not written take no memory."""
        return unwritten(shape, np.float64)

    def divide(self, domain: Domain) -> Domain:
        """Return the domain with only the stencils that this rank needs."""
        computed = np.union1d(self.share(domain).every, self.shown(domain))
        self._domain = self._share = None  # they hold all stencils
        return domain._replace(stencils=part_stencils(domain, computed))

    def shown(self, domain: Domain) -> Rows:
        """Nodes, of `every`, for which this rank computes what a view shows."""
        first, last = self._shown_part(domain)[self._communicator.rank]
        return domain.every[first:last]

    def gather_shown(self, domain: Domain, array: Array) -> None:
        """Bring rows of an array (n, width), from the ranks that compute them for a view."""
        rows, parts = array[self.shown(domain)], self._shown_part(domain)
        received = np.empty((len(domain.every), array.shape[1]))
        self._receive(rows, received, parts)
        array[domain.every] = received

    def _shown_part(self, domain: Domain) -> list[tuple[int, int]]:
        """First and last place of each rank's nodes among all; boundary nodes go with others."""
        size = self._communicator.size
        begins = [self._part(domain, rank)[0] for rank in range(1, size)]
        starts = np.append(domain.inner, len(domain.cloud.positions))[begins]
        cuts = [0, *np.searchsorted(domain.every, starts).tolist(), len(domain.every)]
        return list(pairwise(cuts))

    def _part(self, domain: Domain, rank: int) -> tuple[int, int]:
        """First and last place of a rank's nodes among those that are advanced."""
        count, size = len(domain.inner), self._communicator.size
        return rank * count // size, (rank + 1) * count // size

    def first(self, domain: Domain) -> int:
        """Place of this rank's first node among those that are advanced."""
        return self._part(domain, self._communicator.rank)[0]

    def gather(self, domain: Domain, *arrays: Array) -> None:
        """Bring rows of nodes that are advanced, of arrays (n, 5), from the rank that did it."""
        nodes, whole = self.share(domain).inner, _as_slice(domain.inner)
        size = self._communicator.size
        for array in arrays:
            if isinstance(whole, slice) and array.flags.c_contiguous:  # without a buffer
                parts = [self._part(domain, rank) for rank in range(size)]
                self._receive(array.take(nodes, axis=0), array[whole], parts)
                continue
            received = self._gathered(domain, array.take(nodes, axis=0))
            for rank in range(size):
                if rank != self._communicator.rank:
                    first, last = self._part(domain, rank)
                    array[_as_slice(domain.inner[first:last])] = received[first:last]

    def gather_values(self, domain: Domain, values: Array) -> None:
        """Bring values (m,) of the nodes that are advanced, those of this rank in their places."""
        first, last = self._part(domain, self._communicator.rank)
        values[:] = self._gathered(domain, values[first:last, np.newaxis])[:, 0]

    def _gathered(self, domain: Domain, rows: Array) -> Array:
        """Rows (m, width) of all ranks, from those of this one."""
        width = rows.shape[1]
        if width not in self._buffers:
            self._buffers[width] = np.empty((len(domain.inner), width))
        received, size = self._buffers[width], self._communicator.size
        self._receive(rows, received, [self._part(domain, rank) for rank in range(size)])
        return received

    def _receive(self, rows: Array, received: Array, parts: list[tuple[int, int]]) -> None:
        """Write rows (m, width) of all ranks, from those of this one and places of each."""
        counts = [rows.shape[1] * (last - first) for first, last in parts]
        target, others = [received.reshape(-1), counts], received.nbytes - rows.nbytes
        wait_for_all(self._communicator.Iallgatherv(rows.reshape(-1), target), others)

    def least(self, number: float) -> float:
        """Smallest number of all ranks."""
        return float(least(self._communicator, np.array([number]))[0])

    def greatest(self, number: float) -> float:
        """Largest number of all ranks."""
        return float(greatest(self._communicator, np.array([number]))[0])


def _as_slice(rows: Array) -> Array | slice:
    """Rows that rise, or the range that they are: it is written many times faster."""
    if len(rows) and rows[-1] - rows[0] + 1 == len(rows):
        return slice(int(rows[0]), int(rows[-1]) + 1)
    return rows


def _needed(domain: Domain, nodes: Array) -> tuple[Rows, Rows]:
    """Nodes and ghosts whose gradients the fluxes of some nodes need: these, and all neighbours.

    A ghost has the gradient of the node that it is an image of.
    """
    cloud = domain.cloud
    is_needed = np.zeros(len(cloud.positions), bool)
    is_needed[nodes] = True
    is_needed[domain.stencils.neighbours[nodes]] = True
    ghosts = np.flatnonzero(is_needed[cloud.nodes :])
    is_needed[cloud.owner[ghosts]] = True
    return domain.every[is_needed[domain.every]], ghosts.astype(np.int32)
