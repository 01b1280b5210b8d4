"""Every rank holds the states of all nodes, and computes the rates of its own."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from quintet.components.meshless_gas.build import Domain, Rows
from quintet.components.meshless_gas.parts import NodeMotion, Part
from quintet.components.meshless_gas.ranks.part_stencils import needed, part_stencils
from quintet.components.meshless_gas.ranks.several import (
    Exchanged,
    SeveralRanks,
    part_of,
    shown_parts,
)
from quintet.components.meshless_gas.state import State
from quintet.components.shared.domain.waiting import wait_for_all
from quintet.interfaces.component import Array


class WholeCloud(SeveralRanks):
    """A gas whose rates are computed where its nodes belong; all else every rank computes.

    Parameters
    ----------
    communicator : mpi4py communicator
    grain : int
        As of `SeveralRanks`.
    """

    def __init__(self, communicator: Any, grain: int = 1) -> None:
        super().__init__(communicator, grain)
        self._domain: Domain | None = None  # that was shared out
        self._share: Domain | None = None
        self._buffers: dict[int, Array] = {}  # by numbers in a row

    def divide(self, motion: NodeMotion, parts: Sequence[Part], state: State) -> None:
        """Keep only the stencils that this rank needs, where nodes stand still."""
        motion.divide(self._with_part)

    def _with_part(self, domain: Domain) -> Domain:
        """Return the domain with only the stencils that this rank needs."""
        around, _ = self.around_shown(domain)
        computed = np.union1d(self.share(domain).every, around)
        self._domain = self._share = None  # they hold all stencils
        return domain._replace(stencils=part_stencils(domain, computed))

    def share(self, domain: Domain) -> Domain:
        """Return a domain of which `inner` and `every` are the nodes that this rank computes."""
        if self._share is None or self._domain is not domain:
            first, last = self._part(domain, self._communicator.rank)
            nodes = domain.inner[first:last]
            every, ghosts = needed(domain, nodes)
            self._domain = domain
            self._share = domain._replace(inner=nodes, every=every, ghosts=ghosts)
            self._buffers = {}
        return self._share

    def shown(self, domain: Domain) -> Rows:
        """Nodes, of `every`, for which this rank computes what a view shows."""
        first, last = shown_parts(domain, self._communicator.size, self._grain)[
            self._communicator.rank
        ]
        return domain.every[first:last]

    def around_shown(self, domain: Domain) -> tuple[Rows, Rows | None]:
        """Nodes and ghosts whose gradients a view needs."""
        return needed(domain, self.shown(domain))

    def exchange(self, domain: Domain, primitive: Array) -> None:
        """Bring the states (n, 5) of all nodes that are advanced."""
        nodes, whole = self.share(domain).inner, _as_slice(domain.inner)
        size = self._communicator.size
        if isinstance(whole, slice) and primitive.flags.c_contiguous:  # without a buffer
            parts = [self._part(domain, rank) for rank in range(size)]
            self._receive(primitive.take(nodes, axis=0), primitive[whole], parts)
            return
        received = self._gathered(domain, primitive.take(nodes, axis=0))
        for rank in range(size):
            if rank != self._communicator.rank:
                first, last = self._part(domain, rank)
                primitive[_as_slice(domain.inner[first:last])] = received[first:last]

    def exchange_conserved(self, domain: Domain, conservative: Array) -> None:
        """Bring the conserved states (n, 5) of all nodes that are advanced."""
        self.exchange(domain, conservative)

    def exchanged(self, domain: Domain) -> Exchanged:
        """Rows that `exchange` brings."""
        first, last = self._part(domain, self._communicator.rank)
        nodes = domain.inner
        return Exchanged(nodes[first:last], np.concatenate([nodes[:first], nodes[last:]]))

    def exchanged_boundaries(self) -> Exchanged:
        """Return none: every rank computes all boundary states."""
        none = np.zeros(0, np.int32)
        return Exchanged(none, none)

    def mean(self, domain: Domain, values: Array) -> float:
        """Mean over all nodes that are advanced; each rank gives values (m,) of its own."""
        return float(self._gathered(domain, values[:, np.newaxis])[:, 0].mean())

    def first(self, domain: Domain) -> int:
        """Index of this rank's first node in the list of all nodes that are advanced."""
        return self._part(domain, self._communicator.rank)[0]

    def _part(self, domain: Domain, rank: int) -> tuple[int, int]:
        return part_of(len(domain.inner), rank, self._communicator.size, self._grain)

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


def _as_slice(rows: Array) -> Array | slice:
    """Rows that rise, or the range that they are: it is written many times faster."""
    if len(rows) and rows[-1] - rows[0] + 1 == len(rows):
        return slice(int(rows[0]), int(rows[-1]) + 1)
    return rows
