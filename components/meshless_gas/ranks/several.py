"""Nodes shared out among several ranks, each of which has them all."""

from typing import Any

import numpy as np

from quintet.components.meshless_gas.build import Domain
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
            needed = _needed(domain, nodes)
            self._domain, self._share = domain, domain._replace(inner=nodes, every=needed)
            self._buffers = {}
        return self._share

    def _part(self, domain: Domain, rank: int) -> tuple[int, int]:
        """First and last place of a rank's nodes among those that are advanced."""
        count, size = len(domain.inner), self._communicator.size
        return rank * count // size, (rank + 1) * count // size

    def first(self, domain: Domain) -> int:
        """Place of this rank's first node among those that are advanced."""
        return self._part(domain, self._communicator.rank)[0]

    def gather(self, domain: Domain, *arrays: Array) -> None:
        """Bring rows of nodes that are advanced, of arrays (n, 5), from the rank that did it."""
        nodes = self.share(domain).inner
        for array in arrays:
            received = self._gathered(domain, array.take(nodes, axis=0))
            for rank in range(self._communicator.size):
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
        parts = [self._part(domain, rank) for rank in range(size)]
        counts = [width * (last - first) for first, last in parts]
        target, others = [received.reshape(-1), counts], received.nbytes - rows.nbytes
        wait_for_all(self._communicator.Iallgatherv(rows.reshape(-1), target), others)
        return received

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


def _needed(domain: Domain, nodes: Array) -> Array:
    """Nodes whose gradients the fluxes of some nodes need: these, and all neighbours.

    A ghost has the gradient of the node that it is an image of.
    """
    cloud = domain.cloud
    is_needed = np.zeros(len(cloud.positions), bool)
    is_needed[nodes] = True
    is_needed[domain.stencils.neighbours[nodes]] = True
    ghosts = np.flatnonzero(is_needed[cloud.nodes :])
    is_needed[cloud.owner[ghosts]] = True
    return domain.every[is_needed[domain.every]]
