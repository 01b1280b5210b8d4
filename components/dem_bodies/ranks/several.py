"""Rows shared out among several ranks: each moves its own, and sends what pairs need of them."""

import math
from collections.abc import Sequence

import numpy as np

from quintet.components.dem_bodies.kernels import step as kernels
from quintet.components.dem_bodies.kernels.motion_copies import write_motion
from quintet.components.dem_bodies.kernels.reductions import number_pairs
from quintet.components.dem_bodies.ranks.lists import SharedLists
from quintet.components.dem_bodies.ranks.one import FEWEST, OneRank, room_for_motion
from quintet.components.dem_bodies.ranks.rows import RowsOfRank
from quintet.components.dem_bodies.state import (
    DEEPEST,
    DEEPEST_PAIR,
    SUMS,
    TRAVEL,
    BallPairs,
    Model,
    Numbers,
    State,
)
from quintet.components.shared.domain.exchange import share
from quintet.components.shared.domain.extremes import greatest, least
from quintet.components.shared.domain.given_rows import GivenRows
from quintet.components.shared.search.verlet_list import slack
from quintet.components.shared.threads import Team
from quintet.interfaces.component import Fields


class SeveralRanks(OneRank):
    """Steps the rows of one rank.

    All sums are rounded block by block, and a row gets the loads of earlier blocks in the order of
    the pairs: no bit depends on which rank computes a block. Every rank has all bodies that are
    no balls, and computes their contacts; the last one moves them.

    Parameters
    ----------
    rows : RowsOfRank
    lists : SharedLists
    threads : int
        Of each rank.
    """

    lists: SharedLists

    is_alone = False

    def __init__(self, rows: RowsOfRank, lists: SharedLists, threads: int) -> None:
        self.model, self.state, self.rows = rows.model, rows.state, rows
        self.lists, self.shares = lists, rows.shares
        self.answers = self.shares.rank == 0
        self.sums = np.zeros((self.shares.blocks, SUMS))
        several = threads > 1 and len(self.sums) >= 2 * FEWEST * self.shares.size
        self.team = Team(threads if several else 1, FEWEST, 1)
        self.mixed = rows.are_all
        self.given_motion = GivenRows(
            self.shares.communicator, self.shares.rows - 1, room_for_motion(0)
        )

    def advance(self, state: State, dt: float, loaded: bool) -> bool:
        """Advance by dt [s]; return False where a position is not finite."""
        shares, lists = self.shares, self.lists
        shares.work.begin()
        self._blocks(state, kernels.DRIFT, dt, loaded)
        if not self._exchange_motion(state) and not self._renew(state):
            return False
        self._blocks(state, kernels.BALLS, dt, loaded)
        self._number_deepest()
        lists.load_halo.begin(lists.balls.outgoing)
        if self.mixed:
            shares.blocks_everywhere(self.sums)
            self._touch_others(state, dt, loaded)
        lists.load_halo.finish(lists.balls.outgoing)
        self._blocks(state, kernels.KICK, dt, loaded)
        shares.blocks_everywhere(self.sums)
        if self.mixed:
            self._all_blocks(state, kernels.REPORT, dt, loaded)
        else:
            kernels.report_balls(state.report, state.contact_load, self.sums)
        shares.work.end()
        return True

    def _blocks(self, state: State, stage: int, dt: float, loaded: bool) -> None:
        """Run a stage that is done block by block for own blocks."""
        lists, first, last = self.lists, self.shares.first, self.shares.last
        pairs = lists.balls, lists.bodies
        arguments = (self.model, state, *pairs, self.sums, dt, loaded, lists.skin)

        def run(begin: int, end: int) -> int:
            blocks = first + begin, first + end
            return int(kernels.step(*blocks, stage, stage + 1, *arguments))

        self.team.run(run, last - first)

    def _all_blocks(self, state: State, stage: int, dt: float, loaded: bool) -> None:
        """Run a stage of all blocks at once, on every rank."""
        lists = self.lists
        pairs = lists.balls, lists.bodies
        kernels.step(
            0, 0, stage, stage + 1, self.model, state, *pairs, self.sums, dt, loaded, lists.skin
        )

    def _listed_holds(self) -> bool:
        """Whether no sphere of any rank has moved so far that pairs must be listed again."""
        travel = self.sums[self.shares.first : self.shares.last, TRAVEL].max(initial=0.0)
        furthest = travel if math.isfinite(travel) else math.inf
        all_ranks = greatest(self.shares.communicator, np.array([furthest]))
        return bool(slack(self.lists.skin, math.sqrt(all_ranks[0])) >= 0.0)

    def _renew(self, state: State) -> bool:
        """List pairs again; return False if a position is not finite."""
        if not self._list_pairs(state):
            return False
        self.sums[:, TRAVEL] = 0.0
        return True

    def _list_pairs(self, state: State) -> bool:
        """List pairs of the rows on the host; return False if a position is not finite."""
        shares, owned = self.shares, state.position[self.rows.owned]
        finite = np.array([float(np.isfinite(owned).all())])
        if least(shares.communicator, finite)[0] == 0.0:
            return False
        # Blocks may get another owner, who goes on with the works of the drift.
        shares.blocks_everywhere(self.sums)
        self.lists.renew(state)
        return True

    def _exchange_motion(self, state: State) -> bool:
        """Bring up to date what listed pairs need of other ranks' rows; False: lists do not hold.

        Rows travel while ranks wait for the largest displacement of all.
        """
        if self.mixed:
            if listed_holds := self._listed_holds():
                self.rows.exchange_all()
            return listed_holds
        self.lists.motion_halo.begin(state.motion)
        listed_holds = self._listed_holds()
        self.lists.motion_halo.finish(state.motion)
        return listed_holds

    def _number_deepest(self) -> None:
        """Number the pairs of own blocks among those of all ranks."""
        number_pairs(self.sums, self.shares.first, self.shares.last, self.lists.pairs_before)

    def _touch_others(self, state: State, dt: float, loaded: bool) -> None:
        """Contacts of bodies that are no balls, on every rank."""
        ground = self.shares.rows - 1
        if self.shares.rank < self.shares.size - 1:
            state.contact_load[ground] = 0.0  # what the last rank counts
        self._all_blocks(state, kernels.OTHERS, dt, loaded)
        if state.report[DEEPEST] > self.sums[:, DEEPEST].max():
            # Of these pairs, which are numbered after all pairs of balls.
            state.report[DEEPEST_PAIR] += self.lists.pairs - len(self.lists.balls.partner)

    def set_loads(self, load: Numbers) -> None:
        """Set the loads (m, 6) [N, N m] on own bodies, of those on all."""
        owned = slice(self.rows.owned.start, min(self.rows.owned.stop, len(load)))
        self.state.load[owned] = load[self.state.body[owned]]

    def motion(self) -> Sequence[Numbers]:
        """Position, velocity, orientation and angular velocity of all bodies, on rank 0."""
        state, first, work = self.state, self.rows.owned.start, self.shares.work
        last = min(self.rows.owned.stop, self.shares.rows - 1)  # behind it is the ground
        work.begin()
        places, parts = self.given_motion.begin(state.body[first:last])
        write_motion(first, places, state.motion, state.orientation, *parts)
        parts = self.given_motion.finish()
        work.end(steps=0)
        return parts if self.answers else ()

    def whole(self, *names: str) -> tuple[Model, State]:
        """Model and some arrays of the state, or all, of all rows on rank 0."""
        return self.rows.whole(*names)

    def pairs_of_all(self) -> BallPairs:
        """Pairs of balls of all rows."""
        return self.lists.pairs_of_all()

    def shared_text(self, text: str) -> str:
        """Text of rank 0, on all ranks."""
        letters = np.array([ord(letter) for letter in text if self.answers], np.int64)
        return "".join(map(chr, np.concatenate(share(self.shares.communicator, letters))))

    def load(self, saved: Fields) -> None:
        """Restore own rows of a saved state, bit for bit."""
        self.rows.load(saved)
        self.lists.load(saved)
