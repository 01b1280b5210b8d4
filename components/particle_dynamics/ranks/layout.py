"""Lists of a rank: the pairs of its points, and whose copies they need."""

from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from quintet.components.particle_dynamics.kernels.forces import Pairs
from quintet.components.particle_dynamics.kernels.pair_lists import keep_pairs_of
from quintet.components.particle_dynamics.neighbours import images, pairs_within, wrapped
from quintet.components.particle_dynamics.state import Whole
from quintet.components.shared.domain.borders import around, rows_near_others
from quintet.components.shared.domain.exchange import send_rows
from quintet.components.shared.domain.extremes import greatest, least
from quintet.components.shared.search.cells import corners, keys_of
from quintet.interfaces.component import Array


class Layout(NamedTuple):
    """The points of a rank and copies of those near them, in the order of their numbers."""

    ids: Whole  # (m,) numbers among all points
    owned: Whole  # (k,) rows of its points
    copies: Whole  # (m - k,) rows of the copies
    listed: Array  # (m, 3) m
    pairs: Pairs  # each pair of its points once, by rows
    sent: list[Whole]  # for each rank, the rows that it gets
    received: list[Whole]  # for each rank, the rows that it fills

    def rows(self, ids: Whole) -> Whole:
        """Rows of points that are here."""
        return np.searchsorted(self.ids, ids)

    def spread(self, array: Array) -> Array:
        """Rows (m, *shape) with those of its points (k, *shape); 0 for copies."""
        rows = np.zeros((len(self.ids), *array.shape[1:]), array.dtype)
        rows[self.owned] = array
        return rows


def lay_out(
    communicator: Any, ids: Whole, listed: Array, reach: float, lowest: Array, period: Array | None
) -> Layout:
    """List the pairs within a reach [m] of this rank's points, as one rank would.

    Parameters
    ----------
    communicator : mpi4py communicator
    ids : (k,) int array
        Numbers of its points, rising.
    listed : (k, 3) float array, m
        Where they are.
    reach, lowest, period
        As in `neighbours.pairs_within`.
    """
    points = wrapped(listed, lowest, period)
    bounds = corners(points)
    bounds = least(communicator, bounds[0]), greatest(communicator, bounds[1])
    near = around(_keys(np.concatenate([points, images(points, reach, lowest, period)[0]]), reach))
    sent = rows_near_others(communicator, _keys(points, reach), near)
    coming = send_rows(communicator, [np.column_stack([ids[rows], listed[rows]]) for rows in sent])
    copies = np.concatenate(coming)
    all_ids = np.concatenate([ids, copies[:, 0].astype(np.int64)])
    order = np.argsort(all_ids)
    position = np.concatenate([listed, copies[:, 1:]])[order]
    is_own = order < len(ids)
    pairs, is_near = _pairs_of(is_own, pairs_within(reach, position, lowest, period, bounds))
    # Copies that pair with no point of this rank are not sent again.
    place = np.empty(len(order), np.int64)
    place[order] = np.arange(len(order))
    cuts = len(ids) + np.cumsum([0, *map(len, coming)])
    rows = [place[first:last] for first, last in pairwise(cuts)]
    needed = send_rows(communicator, [np.flatnonzero(is_near[copied]) for copied in rows])
    stays = is_own | is_near
    row_of = np.cumsum(stays) - 1
    return Layout(
        ids=all_ids[order][stays],
        owned=row_of[place[: len(ids)]],
        copies=np.flatnonzero(~is_own[stays]),
        listed=position[stays],
        pairs=Pairs(
            np.append(pairs.begin[:-1][stays], pairs.begin[-1:]),
            row_of[pairs.neighbour].astype(np.int32),
        ),
        sent=[
            row_of[place[of_rank[rows_needed]]]
            for of_rank, rows_needed in zip(sent, needed, strict=True)
        ],
        received=[row_of[copied[is_near[copied]]] for copied in rows],
    )


def _keys(points: Array, width: float) -> Whole:
    return keys_of(points, np.arange(len(points)), width)


def _pairs_of(is_own: NDArray[np.bool_], pairs: Pairs) -> tuple[Pairs, NDArray[np.bool_]]:
    """Pairs that hold a point of this rank, and which points stand in such a pair."""
    is_near = np.zeros(len(is_own), bool)
    count = keep_pairs_of(is_own, pairs.begin, pairs.neighbour, is_near)
    return Pairs(pairs.begin, pairs.neighbour[:count].copy()), is_near
