"""Rows shared out among several ranks: each moves its own, and sends what pairs need of them."""

import math

import numpy as np

from quintet.components.dem_bodies.kernels import step as kernels
from quintet.components.dem_bodies.ranks.lists import SharedLists
from quintet.components.dem_bodies.ranks.one import FEWEST, OneRank
from quintet.components.dem_bodies.state import (
    DEEPEST,
    DEEPEST_PAIR,
    SUMS,
    TRAVEL,
    BallPairs,
    Model,
    State,
)
from quintet.components.shared.domain.extremes import greatest
from quintet.components.shared.search.verlet_list import slack
from quintet.components.shared.threads import Team


class SeveralRanks(OneRank):
    """Steps the rows of one rank.

    All sums are rounded block by block, and a row gets the loads of earlier blocks in the order of
    the pairs: no bit depends on which rank computes a block. Every rank has all bodies that are
    no balls, and computes their contacts; the last one moves them.

    Parameters
    ----------
    model : Model
    lists : SharedLists
    threads : int
        Of each rank.
    """

    lists: SharedLists

    def __init__(self, model: Model, lists: SharedLists, threads: int) -> None:
        self.model, self.lists, self.shares = model, lists, lists.shares
        self.sums = np.zeros((self.shares.blocks, SUMS))
        several = threads > 1 and len(self.sums) >= 2 * FEWEST * self.shares.size
        self.team = Team(threads if several else 1, FEWEST, 1)
        self.mixed = len(model.others) > 0  # whether all ranks need all balls

    def advance(self, state: State, dt: float, loaded: bool) -> bool:
        """Advance by dt [s]; return False where a position is not finite."""
        shares, lists = self.shares, self.lists
        shares.work.begin()
        self._blocks(state, kernels.DRIFT, dt, loaded)
        if not self._listed_holds():
            if not self._renew(state):
                return False
        else:
            self._exchange_motion(state)
        self._blocks(state, kernels.BALLS, dt, loaded)
        self._number_deepest()
        lists.load_halo.begin(lists.balls.outgoing)
        if self.mixed:
            shares.blocks_everywhere(self.sums)
            self._touch_others(state, dt, loaded)
        lists.load_halo.finish(lists.balls.outgoing)
        self._blocks(state, kernels.KICK, dt, loaded)
        shares.blocks_everywhere(self.sums)
        if not self.mixed:
            self._all_blocks(state, kernels.OTHERS, dt, loaded)
        self._all_blocks(state, kernels.REPORT, dt, loaded)
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
        shares = self.shares
        position = np.ascontiguousarray(state.position)
        shares.everywhere(position)
        state.position[:] = position
        if not np.isfinite(position).all():
            return False
        if self.mixed:
            self._exchange_motion(state)
        # Blocks may get another owner, who goes on with the works of the drift.
        shares.blocks_everywhere(self.sums)
        self.lists.renew(state)
        self._exchange_motion(state)
        self.sums[:, TRAVEL] = 0.0
        return True

    def _exchange_motion(self, state: State) -> None:
        """Bring up to date what own pairs need of other ranks' rows."""
        if not self.mixed:
            self.lists.motion_halo.exchange(state.motion)
            return
        self.shares.everywhere(state.motion)
        self.shares.from_last(state)
        balls = self.shares.balls
        state.centre[:balls] = state.motion[:balls, :3]

    def _number_deepest(self) -> None:
        """Number the pairs of own blocks among those of all ranks."""
        block_sums = self.sums[self.shares.first : self.shares.last]
        block_sums[block_sums[:, DEEPEST_PAIR] >= 0.0, DEEPEST_PAIR] += self.lists.pairs_before

    def _touch_others(self, state: State, dt: float, loaded: bool) -> None:
        """Contacts of bodies that are no balls, on every rank."""
        ground = self.shares.rows - 1
        if self.shares.rank < self.shares.size - 1:
            state.contact_load[ground] = 0.0  # what the last rank counts
        self._all_blocks(state, kernels.OTHERS, dt, loaded)
        if state.report[DEEPEST] > self.sums[:, DEEPEST].max():
            # Of these pairs, which are numbered after all pairs of balls.
            state.report[DEEPEST_PAIR] += self.lists.pairs - len(self.lists.balls.partner)

    def gather(self, state: State, *names: str) -> None:
        """Bring the rows of all ranks in some arrays up to date on rank 0; in all, if none."""
        self.shares.gather(state, *names)

    def pairs_of_all(self) -> BallPairs:
        """Pairs of balls of all rows."""
        return self.lists.pairs_of_all()

    def load(self, state: State) -> None:
        """Prepare exchanges for pairs that were loaded."""
        self.lists.link_ranks(state)
        self.lists.most_contacts = self.lists.count_contacts(listed=True)
