"""Returns its inputs; on request, fails in each way that a solver can."""

import os
import signal

import numpy as np

from quintet.components.stand_ins.params import PASSED, RETURNED, EchoParams
from quintet.interfaces.component import Component, Fields, Keys


class Echo(Component):
    """A component that computes nothing, so that only the exchange takes time."""

    takes = (PASSED,)
    gives = (RETURNED,)

    def __init__(self, params: EchoParams) -> None:
        self.params = params
        self.value = np.zeros((params.items, 3))
        self.steps = 0

    def stable_dt(self) -> float:
        """Allow any step."""
        return float("inf")

    def take(self, fields: Fields) -> None:
        """Keep the value."""
        if "passed.value" in fields:
            self.value = np.array(fields["passed.value"])

    def step(self, dt: float) -> None:
        """Compute nothing; fail at the given step."""
        if self.steps == self.params.fails_at:
            self._fail()
        self.steps += 1

    def _fail(self) -> None:
        match self.params.fails_by:
            case "raise":
                raise ArithmeticError("asked to raise")
            case "exit":
                os._exit(0)
            case "kill":
                os.kill(os.getpid(), signal.SIGKILL)
            case "stop":
                os.kill(os.getpid(), signal.SIGSTOP)
            case "nan":
                self.value = np.full_like(self.value, np.nan)

    def give(self, wanted: Keys) -> Fields:
        """Return the last value."""
        return {key: self.value.copy() for key in wanted}

    def save(self) -> Fields:
        """Copy out the last value and the count."""
        return {"value": self.value.copy(), "steps": np.array([self.steps])}

    def load(self, state: Fields) -> None:
        """Restore them."""
        self.value, self.steps = np.array(state["value"]), int(state["steps"][0])

    def items(self) -> int:
        """Count the items."""
        return len(self.value)
