"""Spheres in impacts and all near these, gathered on every rank."""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from quintet.components.particle_dynamics.spheres.kernels import list_marked
from quintet.components.particle_dynamics.spheres.sweeps import Moving
from quintet.components.shared.domain.exchange import share
from quintet.components.shared.search.sphere_pairs import Pairs
from quintet.components.shared.search.verlet_list import furthest, slack
from quintet.interfaces.component import Array

Whole = NDArray[np.int64]
Marks = NDArray[np.bool_]


class Cluster(NamedTuple):
    """Spheres of all ranks that are in impacts, and those near them, by rising numbers."""

    ids: Whole  # (n,)
    marked: Marks  # (n,) those in impacts: all that are near them are here
    moving: Moving
    pairs: Pairs  # those with a marked sphere


def gather(
    communicator: Any, ids: Whole, moving: Moving, pairs: Pairs, marks: Marks, count: int
) -> Cluster:
    """Gather marked spheres, and all near these, on every rank.

    Parameters
    ----------
    communicator : mpi4py communicator
    ids : (n,) int array
        Numbers of this rank's m spheres, then of its copies.
    moving : Moving
        Of the same.
    pairs : Pairs
        Those of this rank's spheres, by rows.
    marks : (n,) bool array
    count : int
        Spheres of all ranks.
    """
    first, second = _marked_pairs(pairs, marks)
    taken = marks.copy()
    taken[first] = taken[second] = True
    rows = np.flatnonzero(taken)
    table = np.column_stack([ids[rows], marks[rows], *(array[rows] for array in moving)])
    tables = np.concatenate(share(communicator, table.astype(np.float64).reshape(-1)))
    tables = tables.reshape(-1, table.shape[1])
    # A copy is not marked where another rank alone knows of its impact: the marked ones first.
    order = np.lexsort((-tables[:, 1], tables[:, 0]))
    numbers = tables[order[np.diff(tables[order, 0], prepend=-1.0) > 0.0]]  # each once
    number, marked = numbers[:, 0].astype(np.int64), numbers[:, 1] != 0.0
    lower, higher = np.minimum(ids[first], ids[second]), np.maximum(ids[first], ids[second])
    both = np.sort(np.concatenate(share(communicator, lower * count + higher)))
    both = both[np.diff(both, prepend=-1) > 0]  # each once
    lower, higher = np.searchsorted(number, both // count), np.searchsorted(number, both % count)
    return Cluster(
        number,
        marked,
        Moving(
            np.ascontiguousarray(numbers[:, 2:5]),
            np.ascontiguousarray(numbers[:, 5:8]),
            np.ascontiguousarray(numbers[:, 8:11]),
            np.ascontiguousarray(numbers[:, 11]),
            np.ascontiguousarray(numbers[:, 12]),
            numbers[:, 13] != 0.0,
        ),
        Pairs(np.searchsorted(lower, np.arange(len(number) + 1)), higher),
    )


def _marked_pairs(pairs: Pairs, marks: Marks) -> tuple[Whole, Whole]:
    """Rows (k,) of the spheres of pairs that hold a marked one."""
    nothing = np.zeros(0, np.int64)
    room = np.zeros(list_marked(*pairs, marks, nothing, nothing), np.int64)
    first, second = room, room.copy()
    list_marked(*pairs, marks, first, second)
    return first, second


class ListedPairs:
    """Pairs of a cluster, which hold as long as its spheres have not moved too far.

    Parameters
    ----------
    cluster : Cluster
    skin : float, m
        By which the list reaches beyond contact.
    moved : float, m
        Furthest that a sphere is from where it was listed.
    """

    def __init__(self, cluster: Cluster, skin: float, moved: float) -> None:
        self._pairs, self._before = cluster.pairs, cluster.moving.position.copy()
        self._skin, self._moved = skin, moved
        self.hold = True  # whether no pair that overlapped may have been missed

    def at(self, position: Array) -> Pairs:
        """Pairs of the cluster; see whether they still hold."""
        moved = self._moved + furthest(position, self._before)
        self.hold &= slack(self._skin, moved) > 0.0
        return self._pairs
