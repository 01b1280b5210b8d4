"""Which loads of pairs act on rows of other ranks, and in which order each row adds them up."""

from itertools import pairwise
from typing import NamedTuple

import numpy as np

from quintet.components.dem_bodies.ranks.shares import Shares
from quintet.components.dem_bodies.state import Whole
from quintet.components.shared.domain.exchange import send_rows


class Loads(NamedTuple):
    """Where loads are stored: first those of this rank's pairs, then those received."""

    sent: list[Whole]  # for each rank, the slots of the loads that it gets
    arrived: list[Whole]  # for each rank, the slots into which its loads go
    arrived_rows: list[Whole]  # rows on which these act
    incoming: Whole  # slots of the loads on own rows, by row, in the order of one rank's pairs
    incoming_begin: Whole  # (rows + 1,) where those of each own row begin


def link_loads(shares: Shares, rows: slice, target: Whole, slot: Whole, room: int) -> Loads:
    """Tell each rank which loads its rows receive from earlier ranks; collective.

    Parameters
    ----------
    shares : Shares
    rows : slice
        Own rows.
    target, slot : (k,) int arrays
        Row on which each load of own pairs acts, own or of a later rank, and its slot; in the
        order of the pairs.
    room : int
        How many slots this rank's own loads have; received loads follow them.
    """
    owner = shares.owners(target)
    sent = [slot[owner == rank] for rank in range(shares.size)]
    rows_of_ranks = [target[owner == rank] for rank in range(shares.size)]
    sent[shares.rank] = rows_of_ranks[shares.rank] = np.zeros(0, np.int64)
    arrived_rows = send_rows(shares.communicator, rows_of_ranks)
    ends = room + np.cumsum([0, *map(len, arrived_rows)])
    arrived = [np.arange(first, last) for first, last in pairwise(ends.tolist())]
    here = owner == shares.rank
    # Pairs of earlier ranks are earlier pairs: their loads come first.
    all_targets = np.concatenate([*arrived_rows, target[here]])
    all_slots = np.concatenate([*arrived, slot[here]])
    counts = np.bincount(all_targets - rows.start, minlength=rows.stop - rows.start)
    return Loads(
        sent,
        arrived,
        arrived_rows,
        all_slots[np.argsort(all_targets, kind="stable")],
        np.concatenate([[0], np.cumsum(counts)]),
    )
