"""All rows on one rank."""

from collections.abc import Sequence

import numpy as np

from quintet.components.dem_bodies.contact.lists import ContactLists
from quintet.components.dem_bodies.kernels import step as kernels
from quintet.components.dem_bodies.kernels.motion_copies import write_motion
from quintet.components.dem_bodies.state import (
    SUMS,
    TRAVEL,
    BallPairs,
    Model,
    Numbers,
    State,
    blocks_of,
    sort_rows,
)
from quintet.components.shared.threads import Team
from quintet.interfaces.component import Fields

FEWEST = 8  # blocks of rows that are worth handing to another thread
SHARED = (kernels.DRIFT, kernels.BALLS, kernels.KICK)  # stages of a step that threads share out


class OneRank:
    """Steps all rows.

    Parameters
    ----------
    state : State
    lists : ContactLists
    threads : int
    """

    is_alone = True  # whether there is no other rank
    answers = True  # whether the rows of all are here on request

    def __init__(self, state: State, lists: ContactLists, threads: int) -> None:
        self.model, self.state, self.lists = lists.model, state, lists
        self.sums = np.zeros((blocks_of(len(self.model.kind)), SUMS))
        several = threads > 1 and len(self.sums) >= 2 * FEWEST
        self.team = Team(threads if several else 1, FEWEST, 1)

    def advance(self, state: State, dt: float, loaded: bool) -> bool:
        """Advance by dt [s]; return False where a position is not finite."""
        stage = kernels.DRIFT
        while stage != kernels.DONE:
            stage = self._run(state, stage, dt, loaded)
            if stage == kernels.LIST:
                if not np.isfinite(state.position).all():
                    return False
                self.lists.renew(state)
                self.sums[:, TRAVEL] = 0.0
                stage = kernels.BALLS
        return True

    def _run(self, state: State, stage: int, dt: float, loaded: bool) -> int:
        """Run all stages from one on; with several threads, that one. Return the next one."""
        lists = self.lists
        pairs = lists.balls, lists.bodies
        arguments = (self.model, state, *pairs, self.sums, dt, loaded, lists.skin)
        blocks, several = len(self.sums), self.team.size > 1
        stages = stage, stage + 1 if several else kernels.DONE
        if several and stage in SHARED:
            return min(self.team.run(kernels.step, blocks, *stages, *arguments))
        return int(kernels.step(0, blocks, *stages, *arguments))

    def is_finite(self) -> bool:
        """Whether all rotations are known to be finite."""
        return False

    def keep_contact_loads(self) -> None:
        """Keep the loads of contacts as those of the coming step's beginning."""
        self.state.previous_contact_load[:] = self.state.contact_load

    def set_loads(self, load: Numbers) -> None:
        """Set the loads (m, 6) [N, N m] on all bodies."""
        self.state.load[self.state.row[: len(load)]] = load

    def motion(self) -> Sequence[Numbers]:
        """Position, velocity, orientation and angular velocity of all bodies."""
        state, count = self.state, len(self.state.body) - 1  # behind them is the ground
        parts = room_for_motion(count)
        write_motion(0, state.body[:count], state.motion, state.orientation, *parts)
        return parts

    def whole(self, *names: str) -> tuple[Model, State]:
        """Model and state of all rows."""
        return self.model, self.state

    def pairs_of_all(self) -> BallPairs | None:
        """Pairs of balls of all rows."""
        return self.lists.balls

    def shared_text(self, text: str) -> str:
        """Text of an error, the same on all ranks."""
        return text

    def load(self, saved: Fields) -> None:
        """Restore a saved state, bit for bit."""
        state, balls = self.state, np.count_nonzero(self.model.ball)
        sort_rows(self.model, state, state.row[saved["body"][:balls]])
        for name, array in state._asdict().items():
            array[:] = saved[name]
        self.lists.load(saved)


def room_for_motion(count: int) -> Sequence[Numbers]:
    """Room for the position, velocity, orientation and angular velocity of bodies."""
    # One piece of memory: separate ones are requested from the system at every call.
    parts = np.split(np.empty(13 * count), [3 * count, 6 * count, 10 * count])
    return [part.reshape(count, width) for part, width in zip(parts, (3, 3, 4, 3), strict=True)]
