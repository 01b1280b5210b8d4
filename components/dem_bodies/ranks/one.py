"""All rows on one rank."""

import numpy as np

from quintet.components.dem_bodies.contact.lists import ContactLists
from quintet.components.dem_bodies.kernels import step as kernels
from quintet.components.dem_bodies.state import (
    SUMS,
    TRAVEL,
    BallPairs,
    Model,
    State,
    blocks_of,
)
from quintet.components.shared.threads import Team

FEWEST = 8  # blocks of rows that are worth handing to another thread
SHARED = (kernels.DRIFT, kernels.BALLS, kernels.KICK)  # stages of a step that threads share out


class OneRank:
    """Steps all rows.

    Parameters
    ----------
    model : Model
    lists : ContactLists
    threads : int
    """

    def __init__(self, model: Model, lists: ContactLists, threads: int) -> None:
        self.model, self.lists = model, lists
        self.sums = np.zeros((blocks_of(len(model.kind)), SUMS))
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

    def gather(self, state: State, *names: str) -> None:
        """Nothing to do: all rows are here."""

    def pairs_of_all(self) -> BallPairs | None:
        """Pairs of balls of all rows."""
        return self.lists.balls

    def load(self, state: State) -> None:
        """Nothing to do: all rows are here."""
