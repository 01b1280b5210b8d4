"""Listed pairs of the rows that a rank owns, and loads that pairs have on rows of other ranks."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from quintet.components.dem_bodies.contact.ball_pairs import ball_pairs
from quintet.components.dem_bodies.contact.ball_search import list_ball_pairs
from quintet.components.dem_bodies.contact.body_search import (
    body_pairs_of,
    list_body_pairs,
    with_sorted_rows,
)
from quintet.components.dem_bodies.contact.lists import ContactLists, history_of
from quintet.components.dem_bodies.kernels.ball_lists import Sorted
from quintet.components.dem_bodies.kernels.contact_counts import count_ball_contacts
from quintet.components.dem_bodies.ranks.loads import link_loads
from quintet.components.dem_bodies.ranks.rows import RowsOfRank
from quintet.components.dem_bodies.state import (
    BLOCK,
    COLUMNS,
    BallPairs,
    State,
    Whole,
    body_pairs,
)
from quintet.components.shared.domain.collection import collect
from quintet.components.shared.domain.exchange import send_rows, share
from quintet.components.shared.domain.extremes import greatest
from quintet.components.shared.domain.halo import Halo
from quintet.components.shared.search.cells import LAYER, ROW, keys_of
from quintet.interfaces.component import Array, Fields


class SharedLists(ContactLists):
    """Pairs of the balls that a rank owns; pairs with other bodies are listed on every rank.

    Parameters
    ----------
    rows : RowsOfRank
    balls : BallPairs
        None yet.
    skin : float, m
        Distance within which pairs are listed.
    records_forces : bool
        Whether the force of each pair is recorded.
    """

    balls: BallPairs

    def __init__(
        self, rows: RowsOfRank, balls: BallPairs, skin: float, records_forces: bool
    ) -> None:
        super().__init__(rows.model, balls, skin, records_forces)
        self.rows, self.shares, self.pairs_before, self.pairs = rows, rows.shares, 0, 0
        self.begin = rows.sparse.zeros((self.shares.balls + 1,), np.int64)
        self.incoming_begin = rows.sparse.zeros((self.shares.rows + 1,), np.int64)
        self.of_balls = rows.sparse.zeros((self.shares.rows,), np.int64)  # contacts of balls alone
        self.listed = slice(0, 0)  # rows in `begin`
        self.motion_halo = Halo(self.shares.communicator, (), (), (COLUMNS,))  # no pairs yet

    def renew(self, state: State) -> None:
        """Sort the rows of all balls, cut them into shares, and list the pairs of own rows."""
        model, shares, before = self.model, self.shares, self.shares.ends()
        cells, order = self._sorted_balls(state)
        touching = self._pairs_in_contact(state)
        shares.cut()
        self.rows.move(order, before)
        self._know_near(state, cells)
        balls = self._begin_rows(), self._at_owners(state, *touching)
        self.balls = list_ball_pairs(
            model, state, cells, balls[1], np.arange(shares.rows), self.skin, self.records_forces,
            self.rows.owned, balls[0],
        )  # fmt: skip
        self.link_ranks()
        if self.rows.are_all:
            self.bodies = with_sorted_rows(self.bodies, order)
            self.bodies = list_body_pairs(model, state, cells, self.bodies, self.skin)
            state.listed_centre[shares.balls :] = state.centre[shares.balls :]
        owned = self.rows.owned_balls
        state.listed_centre[owned] = state.motion[owned, :3]
        self.most_contacts = self.count_contacts(listed=True)

    def _sorted_balls(self, state: State) -> tuple[Sorted, Whole]:
        """Keys of the cells of all ranks' balls, and the present rows of these in their order."""
        width, owned = 2.0 * self.rows.largest + self.skin, self.rows.owned_balls
        own_keys = keys_of(state.motion, np.arange(owned.start, owned.stop), width)
        keys = np.concatenate(share(self.shares.communicator, own_keys))
        order = np.argsort(keys, kind="stable")
        return Sorted(keys[order], width), order

    def _know_near(self, state: State, cells: Sorted) -> None:
        """Get the motion of rows of later ranks that may be near own ones."""
        shares, rows = self.shares, self.rows
        ends = np.minimum(shares.ends(), shares.balls)
        reached = ends[1:].copy()  # by the cells that each rank looks at
        some = np.flatnonzero(ends[1:] > ends[:-1])
        furthest = cells.keys[ends[some + 1] - 1] + LAYER + ROW + 1
        reached[some] = np.searchsorted(cells.keys, furthest, side="right")
        rows.know(int(reached[shares.rank]))
        if rows.are_all:
            rows.exchange_all()
            return
        here, ranks = shares.rank, range(shares.size)

        def near(looking: int, owning: int) -> Whole:
            """Rows of a rank that may be near those of another."""
            low, high = max(ends[looking + 1], ends[owning]), ends[owning + 1]
            return np.arange(low, max(low, min(reached[looking], high)))

        sent = [near(rank, here) for rank in ranks]
        received = [near(here, rank) for rank in ranks]
        Halo(shares.communicator, sent, received, (COLUMNS,)).exchange(state.motion)

    def _begin_rows(self) -> Whole:
        """Room for where the pairs of own rows begin, all zeros."""
        self.begin[self.listed.start : self.listed.stop + 1] = 0
        self.listed = self.rows.owned_balls
        self.begin[self.listed.start : self.listed.stop + 1] = 0
        return self.begin

    def _pairs_in_contact(self, state: State) -> tuple[Whole, Whole, Whole]:
        """Pairs that touch, the body of each, and its partner: a body, or beyond them a plane."""
        old, bodies = self.balls, len(state.body)
        some = np.flatnonzero(old.history[3])
        partner = old.partner[some].astype(np.int64)
        of_ball = partner < bodies
        second = np.where(of_ball, state.body[np.where(of_ball, partner, 0)], partner)
        return some, state.body[old.row[some]], second

    def _at_owners(self, state: State, some: Whole, first: Whole, second: Whole) -> BallPairs:
        """Pairs in contact whose rows are now on this rank; `row` and `partner` are bodies."""
        old, shares = self.balls, self.shares
        row, of_ball = state.row[first], second < len(state.body)
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

    def link_ranks(self) -> None:
        """Prepare the exchange of motion, and of loads on rows of other ranks, of these pairs."""
        shares, pairs = self.shares, self.balls
        all_pairs = np.concatenate(share(shares.communicator, np.array([len(pairs.partner)])))
        self.pairs_before, self.pairs = int(all_pairs[: shares.rank].sum()), int(all_pairs.sum())
        partner = pairs.partner.astype(np.int64)
        beyond = np.unique(partner[(partner >= self.rows.owned.stop) & (partner < shares.rows)])
        owner = shares.owners(beyond)
        self.needed = [beyond[owner == rank] for rank in range(shares.size)]
        self.asked = send_rows(shares.communicator, self.needed)
        self._make_slots()

    def _make_slots(self) -> None:
        """Make slots for motion and loads from other ranks, for loads in the order of all pairs."""
        shares, pairs, rows = self.shares, self.balls, self.rows.owned
        self.motion_halo = Halo(shares.communicator, self.asked, self.needed, (COLUMNS,))
        partner, row = pairs.partner.astype(np.int64), pairs.row.astype(np.int64)
        leaves = ((row // BLOCK + 1) * BLOCK <= partner) & (partner < shares.rows)
        count = int(np.count_nonzero(leaves))
        loads = link_loads(shares, rows, partner[leaves], np.arange(count), count)
        self.incoming_begin[rows.start : rows.stop + 1] = loads.incoming_begin
        arrived_rows = np.concatenate(loads.arrived_rows)
        earliest = pairs.earliest.copy()
        earliest[np.unique(arrived_rows) // BLOCK] = -1  # not before all have come
        self.balls = pairs._replace(
            outgoing=np.zeros((count + len(arrived_rows), 6)),
            incoming=loads.incoming.astype(np.uint32),
            incoming_begin=self.incoming_begin,
            earliest=earliest,
        )
        self.load_halo = Halo(shares.communicator, loads.sent, loads.arrived, (6,))

    def count_contacts(self, listed: bool = False) -> int:
        """Most contacts of any row; with `listed` as if all listed pairs touched."""
        owned, count, pairs = self.rows.owned, self.of_balls, self.balls
        count[owned] = 0
        for rows in self.needed:
            count[rows] = 0
        history = np.ones_like(pairs.history) if listed else pairs.history
        count_ball_contacts(pairs.row, pairs.partner, history, count)
        arrived = send_rows(self.shares.communicator, [count[rows] for rows in self.needed])
        for rows, counts in zip(self.asked, arrived, strict=True):
            count[rows] += counts
        most = count[owned]
        if self.rows.are_all:
            self._count_others(listed)
            most = most + self.contacts[owned]
        return int(greatest(self.shares.communicator, np.array([most.max(initial=0)]))[0])

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
        owned = self.rows.owned_balls
        counts = np.diff(pairs.begin[owned.start : owned.stop + 1])
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
        owned, all_begin = self.rows.owned_balls, np.asarray(saved["balls.begin"])
        some = slice(all_begin[owned.start], all_begin[owned.stop])
        partner = np.asarray(saved["balls.partner"])[some].astype(np.uint32)
        near = partner[partner < self.shares.balls]
        self.rows.know(max(owned.stop, int(near.max(initial=0)) + 1))
        begin = self._begin_rows()
        begin[owned.start : owned.stop + 1] = all_begin[owned.start : owned.stop + 1] - some.start
        self.balls = ball_pairs(self.model, begin, partner, self.records_forces)
        for name, array in history_of(self.balls).items():
            of_all = np.asarray(saved[f"balls.{name}"])
            array[:] = of_all[:, some] if name == "history" else of_all[some]
        self.link_ranks()
        self.most_contacts = self.count_contacts(listed=True)
