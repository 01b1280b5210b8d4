"""A chain of masses of which one rank fails on purpose."""

import time
from typing import Literal

import numpy as np
from toy_faults import SOON, Cause, due, fail
from toy_ranks import Chain

from quintet.interfaces.params import Count, parameters


class FaultyChain(Chain):
    """Fails on one rank: during its build, before a step, or after it, when others have gone on."""

    @parameters
    class Params:
        items: Count = 7
        pause: float = 0.0
        fails_on: int = 1  # rank
        fails_in: Literal["never", "build", "step", "after"] = "step"
        fails_at: int = -1  # step
        fails_by: Cause = "exception"
        moment: str = ""  # file for the times of the failures
        times: Count = 1000

    def __init__(self, params, resources):
        super().__init__(params, resources)
        self.spoils = False  # whether its rank returns a number that is none
        self.come_to("build")

    def come_to(self, moment):
        """Fail if the parameters ask for a failure at this moment."""
        params = self.params
        if self.rank == params.fails_on and moment == params.fails_in and due(params):
            if moment == "after":
                time.sleep(SOON)
            self.spoils = params.fails_by == "NaN"
            fail(params.fails_by)

    def step(self, dt):
        fails_now = self.steps == self.params.fails_at
        if fails_now:
            self.come_to("step")
        super().step(dt)
        if fails_now:
            self.come_to("after")

    def give(self, wanted):
        position = self.position
        if self.spoils:
            self.position = np.full_like(position, np.nan)
        fields = super().give(wanted)
        self.position = position
        return fields
