"""Nodes that stand still, divided among ranks: each holds its own, and copies of those near."""

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from quintet.components.meshless_gas.build import Domain, Rows
from quintet.components.meshless_gas.parts import NodeMotion, Part
from quintet.components.meshless_gas.ranks.local_rows import local_rows
from quintet.components.meshless_gas.ranks.ordered_sums import ordered_sums
from quintet.components.meshless_gas.ranks.several import (
    Exchanged,
    SeveralRanks,
    part_of,
    shown_parts,
)
from quintet.components.meshless_gas.state import State
from quintet.components.shared.domain.collection import Collection
from quintet.components.shared.domain.exchange import send_rows, share
from quintet.components.shared.domain.halo import Halo
from quintet.components.shared.domain.waiting import wait
from quintet.components.shared.threads import Team
from quintet.interfaces.component import Array

TAG = 29
Whole = NDArray[np.int64]


class DividedNodes(SeveralRanks):
    """A gas of which a rank holds the rows that it needs, by local numbers in the order of all.

    Parameters
    ----------
    communicator : mpi4py communicator
    grain : int
        As of `SeveralRanks`.
    """

    def divide(self, motion: NodeMotion, parts: Sequence[Part], state: State) -> None:
        """Keep only what this rank needs of the domain, of the parts and of the state."""
        domain, rank, size = motion.domain, self._communicator.rank, self._communicator.size
        self._first, last = part_of(len(domain.inner), rank, size, self._grain)
        self._advanced = len(domain.inner)
        parts_shown = shown_parts(domain, size, self._grain)
        answered = domain.every[slice(*parts_shown[rank])]
        read = np.concatenate([np.zeros(0, np.int64), *(part.reads() for part in parts)])
        written = domain.bounding
        if not any(part.couples_walls for part in parts):
            written = written[np.isin(written, answered)]
        held, local, motion.domain, *self._sloped = local_rows(
            domain, answered, domain.inner[self._first : last], written, read
        )
        self._held = held[: motion.domain.cloud.nodes]
        begin = int(local[answered[0]])
        self._answered = slice(begin, begin + len(answered))
        self._collection = Collection(self._communicator, answered.astype(np.int64))
        self._counts = [end - start for start, end in parts_shown]
        begins = np.array([begin for begin, _ in parts_shown])
        self._halo, self._exchanged = self._exchange_of(domain.inner, local, begins)
        follow = np.setdiff1d(domain.bounding, domain.inner)
        if len(written) == len(domain.bounding):
            follow = follow[:0]
        self._boundaries, self._exchanged_boundaries = self._exchange_of(follow, local, begins)
        for part in parts:
            part.renumber(local, motion.domain)
        state.conservative = state.conservative[self._held]
        state.primitive = state.primitive[self._held]

    def _exchange_of(self, nodes: Rows, local: Rows, begins: Whole) -> tuple[Halo, Exchanged]:
        """Ask each rank for those of some nodes that it computes and that this one holds, too."""
        wanted = nodes[local[nodes] >= 0].astype(np.int64)
        owner = np.searchsorted(begins, wanted, side="right") - 1
        ranks = range(self._communicator.size)
        others = [wanted[(owner == rank) & (rank != self._communicator.rank)] for rank in ranks]
        requested = send_rows(self._communicator, others)
        sent = [local[rows].astype(np.int64) for rows in requested]
        received = [local[rows].astype(np.int64) for rows in others]
        rows = Exchanged(*(np.concatenate(lists) for lists in (sent, received)))
        return Halo(self._communicator, sent, received, (5,)), rows

    def exchanged(self, domain: Domain) -> Exchanged:
        """Rows that `exchange` brings."""
        return self._exchanged

    def exchanged_boundaries(self) -> Exchanged:
        """Rows that `exchange_boundaries` brings."""
        return self._exchanged_boundaries

    def advanced(self, domain: Domain) -> int:
        """How many nodes all ranks advance."""
        return self._advanced

    def answered(self, domain: Domain) -> slice:
        """Rows of the nodes that this rank answers for."""
        return self._answered

    def shown(self, domain: Domain) -> Rows:
        """Nodes for which this rank computes what a view shows."""
        return np.arange(self._answered.start, self._answered.stop, dtype=np.int32)

    def around_shown(self, domain: Domain) -> tuple[Rows, Rows | None]:
        """Nodes and ghosts whose gradients a view needs."""
        nodes, ghosts = self._sloped
        return nodes, ghosts

    def collect(self, domain: Domain, array: Array) -> Array:
        """Rows of all nodes, on rank 0, of an array (nodes, *shape); others get their own."""
        return self._collection.gather(array[self._answered])

    def collect_answered(self, values: Array) -> Array:
        """Collect rows of one kind of node on rank 0; each rank passes those of its own nodes."""
        return self.collect_shown(values)

    def rows_of(self, array: Array) -> Array:
        """Rows that this rank holds, of an array (n, *shape) of all nodes."""
        return array[self._held]

    def exchange(self, domain: Domain, primitive: Array) -> None:
        """Bring the states (n, 5) that other ranks advanced, where this rank needs them."""
        self._halo.exchange(primitive)

    def exchange_boundaries(self, primitive: Array) -> None:
        """Bring the states (n, 5) of boundary nodes that other ranks computed."""
        self._boundaries.exchange(primitive)

    def conserved(self, domain: Domain, conservative: Array, team: Team) -> Array:
        """Mass, momentum and energy (5,) kg, N s, J of all nodes."""
        rows = self._answered
        volumes = domain.cloud.volumes[rows]
        columns = [volumes * conservative[rows, q] for q in range(5)]
        return ordered_sums(self._communicator, columns, self._counts)

    def mean(self, domain: Domain, values: Array) -> float:
        """Mean over all nodes that are advanced; each rank gives values (m,) of its own."""
        return self.total(values) / self._advanced

    def total(self, values: Array) -> float:
        """Sum over nodes of all ranks; each gives values (m,)."""
        counts = share(self._communicator, np.array([len(values)]))
        sizes = np.concatenate(counts).tolist()
        return float(ordered_sums(self._communicator, [values], sizes)[0])

    def in_turn(self, add: Callable[[Array], None], sums: Array) -> None:
        """Let one rank after another add to sums (k,), of which rank 0 then has the last."""
        rank, size = self._communicator.rank, self._communicator.size
        if rank:
            wait(self._communicator.Irecv(sums, rank - 1, TAG))
        add(sums)
        sent = self._communicator.Isend(sums.copy(), (rank + 1) % size, TAG)
        wait(*([sent] if rank else [sent, self._communicator.Irecv(sums, size - 1, TAG)]))

    def first(self, domain: Domain) -> int:
        """Index of this rank's first node in the list of all nodes that are advanced."""
        return self._first
