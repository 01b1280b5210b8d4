"""Listed pairs of the rows that a rank owns, and loads that pairs have on rows of other ranks."""

from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from quintet.components.dem_bodies.contact.ball_pairs import ball_pairs
from quintet.components.dem_bodies.contact.ball_search import list_ball_pairs, sorted_balls
from quintet.components.dem_bodies.contact.body_search import (
    body_pairs_of,
    list_body_pairs,
    with_sorted_rows,
)
from quintet.components.dem_bodies.contact.lists import ContactLists, history_of
from quintet.components.dem_bodies.kernels.contact_counts import count_ball_contacts
from quintet.components.dem_bodies.ranks.shares import Shares
from quintet.components.dem_bodies.state import (
    BLOCK,
    COLUMNS,
    BallPairs,
    Model,
    State,
    Whole,
    body_pairs,
    sort_rows,
)
from quintet.components.shared.domain.collection import collect
from quintet.components.shared.domain.exchange import send_rows, share
from quintet.components.shared.domain.extremes import counted
from quintet.components.shared.domain.halo import Halo
from quintet.interfaces.component import Array, Fields

# Of a row that moves to another rank, with their widths. Loads from outside are known everywhere.
MOVED = {"motion": COLUMNS, "orientation": 4, "contact_load": 6, "previous_contact_load": 6}


class SharedLists(ContactLists):
    """Pairs of the balls that a rank owns; pairs with other bodies are listed on every rank.

    Parameters
    ----------
    model : Model
    balls : BallPairs
        None yet.
    skin : float, m
        Distance within which pairs are listed.
    records_forces : bool
        Whether the force of each pair is recorded.
    shares : Shares
    """

    balls: BallPairs

    def __init__(
        self, model: Model, balls: BallPairs, skin: float, records_forces: bool, shares: Shares
    ) -> None:
        super().__init__(model, balls, skin, records_forces)
        self.shares, self.pairs_before, self.pairs = shares, 0, 0

    def renew(self, state: State) -> None:
        """Sort the rows of all balls, cut them into shares, and list the pairs of own rows."""
        model, shares, body = self.model, self.shares, state.body.copy()
        cells, order = sorted_balls(model, state, self.skin)
        owner = shares.owners(order)  # before; in the new order
        sort_rows(model, state, order)
        shares.cut()
        self._move_rows(state, owner)
        known = self._pairs_by_body(state, body)
        rows = shares.rows_of(shares.rank)
        all_bodies = np.arange(shares.rows)
        self.balls = list_ball_pairs(
            model, state, cells, known, all_bodies, self.skin, self.records_forces, rows
        )
        self.link_ranks(state)
        self.bodies = with_sorted_rows(self.bodies, order)
        self.bodies = list_body_pairs(model, state, cells, self.bodies, self.skin)
        state.listed_centre[:] = state.centre
        state.listed_centre[: shares.balls] = state.motion[: shares.balls, :3]
        self.most_contacts = self.count_contacts(listed=True)

    def _move_rows(self, state: State, before: Whole) -> None:
        """Send what moves of a row to its new owner; `before` holds the old owner of each ball."""
        shares, rank = self.shares, self.shares.rank
        after = shares.owners(np.arange(len(before)))
        leaving = [
            np.flatnonzero((before == rank) & (after == other) & (before != after))
            for other in range(shares.size)
        ]
        arrays = [getattr(state, name) for name in MOVED]
        packed = [np.concatenate([array[rows] for array in arrays], axis=1) for rows in leaving]
        arrived = send_rows(shares.communicator, packed)
        ends = np.cumsum(list(MOVED.values()))[:-1]
        for other, rows in enumerate(arrived):
            to = np.flatnonzero((after == rank) & (before == other) & (before != after))
            for array, part in zip(arrays, np.split(rows, ends, axis=1), strict=True):
                array[to] = part

    def _pairs_by_body(self, state: State, body: Whole) -> BallPairs:
        """Pairs in contact whose rows are now on this rank; `row` and `partner` are bodies."""
        old, shares = self.balls, self.shares
        some, bodies = np.flatnonzero(old.history[3]), len(body)
        first, partner = body[old.row[some]], old.partner[some].astype(np.int64)
        of_ball = partner < bodies
        second = np.where(of_ball, body[np.where(of_ball, partner, 0)], partner)
        row = state.row[first]
        row[of_ball] = np.minimum(row[of_ball], state.row[second[of_ball]])
        owner = shares.owners(row)
        columns = [first[:, None].astype(float), second[:, None].astype(float)]
        columns.append(old.history[:, some].T)
        if old.rolling_moment is not None:
            columns.append(old.rolling_moment[some])
        packed = np.concatenate(columns, axis=1)
        parts = [packed[owner == rank] for rank in range(shares.size)]
        arrived = np.concatenate(send_rows(shares.communicator, parts))
        rolling = None if old.rolling_moment is None else np.ascontiguousarray(arrived[:, 6:])
        return old._replace(
            row=arrived[:, 0].astype(np.uint32),
            partner=arrived[:, 1].astype(np.uint32),
            history=np.ascontiguousarray(arrived[:, 2:6].T),
            rolling_moment=rolling,
        )

    def link_ranks(self, state: State) -> None:
        """Prepare the exchange of motion, and of loads on rows of other ranks, of these pairs."""
        shares, pairs = self.shares, self.balls
        rows = shares.rows_of(shares.rank)
        all_pairs = np.concatenate(share(shares.communicator, np.array([len(pairs.partner)])))
        self.pairs_before, self.pairs = int(all_pairs[: shares.rank].sum()), int(all_pairs.sum())
        self._link_motion(rows)
        self._link_loads()

    def _link_motion(self, rows: slice) -> None:
        shares = self.shares
        partner = self.balls.partner.astype(np.int64)
        beyond = np.unique(partner[(partner >= rows.stop) & (partner < shares.rows)])
        owner = shares.owners(beyond)
        needed = [beyond[owner == rank] for rank in range(shares.size)]
        asked = send_rows(shares.communicator, needed)
        self.motion_halo = Halo(shares.communicator, asked, needed, (COLUMNS,))

    def _link_loads(self) -> None:
        """Put the loads of other ranks' pairs behind own ones, in the order of one rank's pairs."""
        shares, pairs = self.shares, self.balls
        partner, row = pairs.partner.astype(np.int64), pairs.row.astype(np.int64)
        leaves = ((row // BLOCK + 1) * BLOCK <= partner) & (partner < shares.rows)
        target = partner[leaves]  # row of each outgoing load
        owner = shares.owners(target)
        sent = [np.flatnonzero(owner == rank) for rank in range(shares.size)]
        sent[shares.rank] = np.zeros(0, np.int64)
        arrived = send_rows(shares.communicator, [target[slots] for slots in sent])
        ends = len(target) + np.cumsum([0, *map(len, arrived)])
        slots = [np.arange(a, b) for a, b in pairwise(ends)]
        here = np.flatnonzero(owner == shares.rank)
        # Blocks of earlier ranks are earlier blocks: their loads come first.
        all_targets = np.concatenate([*arrived, target[here]])
        all_slots = np.concatenate([*slots, here])
        order = np.argsort(all_targets, kind="stable")
        counts = np.bincount(all_targets, minlength=shares.rows)
        earliest = pairs.earliest.copy()
        earliest[np.unique(np.concatenate(arrived)) // BLOCK] = -1  # not before all have come
        self.balls = pairs._replace(
            outgoing=np.zeros((int(ends[-1]), 6)),
            incoming=all_slots[order].astype(np.uint32),
            incoming_begin=np.concatenate([[0], np.cumsum(counts)]),
            earliest=earliest,
        )
        self.load_halo = Halo(shares.communicator, sent, slots, (6,))

    def _add_balls(self, listed: bool) -> None:
        of_balls, balls = np.zeros_like(self.contacts), self.balls
        history = np.ones_like(balls.history) if listed else balls.history
        count_ball_contacts(balls.row, balls.partner, history, of_balls)
        self.contacts += counted(self.shares.communicator, of_balls)

    def pairs_of_all(self) -> BallPairs:
        """Pairs of all ranks, on every rank."""
        pairs, communicator = self.balls, self.shares.communicator

        def of_all(array: NDArray[Any]) -> NDArray[Any]:
            flat = np.concatenate(share(communicator, array.reshape(-1)))
            return flat.reshape(-1, *array.shape[1:])

        return pairs._replace(
            row=of_all(pairs.row.astype(np.int64)),
            partner=of_all(pairs.partner.astype(np.int64)),
            history=np.ascontiguousarray(of_all(np.ascontiguousarray(pairs.history.T)).T),
            force=of_all(pairs.force),
        )

    def save(self) -> dict[str, Array]:
        """Copy out the listed pairs of all ranks on rank 0."""
        pairs, communicator = self.balls, self.shares.communicator
        rows = self.shares.rows_of(self.shares.rank)
        stop = min(rows.stop, self.shares.balls)
        counts = np.diff(pairs.begin)[rows.start : stop]
        begin = np.concatenate([[0], np.cumsum(collect(communicator, counts))])
        partner = collect(communicator, pairs.partner.astype(np.int64))
        arrays = {
            "others.key": self.bodies.key.copy(),
            "others.history": self.bodies.history.copy(),
        }
        arrays |= {"balls.begin": begin, "balls.partner": partner}
        for name, array in history_of(pairs).items():
            by_pair = np.ascontiguousarray(array.T) if name == "history" else array
            of_all = collect(communicator, by_pair)
            arrays[f"balls.{name}"] = (
                np.ascontiguousarray(of_all.T) if name == "history" else of_all
            )
        return arrays

    def load(self, saved: Fields) -> None:
        """Restore the saved pairs of own rows, bit for bit."""
        pairs = body_pairs(len(saved["others.key"]))
        pairs.key[:] = saved["others.key"]
        pairs.history[:] = saved["others.history"]
        self.bodies = body_pairs_of(pairs.key, pairs)
        rows, begin = self.shares.rows_of(self.shares.rank), np.array(saved["balls.begin"])
        balls = self.shares.balls
        some = slice(begin[min(rows.start, balls)], begin[min(rows.stop, balls)])
        partner = np.asarray(saved["balls.partner"])[some].astype(np.uint32)
        begin = np.clip(begin - some.start, 0, len(partner))
        self.balls = ball_pairs(self.model, begin, partner, self.records_forces)
        for name, array in history_of(self.balls).items():
            of_all = np.asarray(saved[f"balls.{name}"])
            array[:] = of_all[:, some] if name == "history" else of_all[some]
