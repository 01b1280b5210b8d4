"""Whether the start of a run is resolved where loads reach their taker a window late.

In staggered windows the first loads act in the second window. A motion that they cause begins a
window late, and stays so on its way to rest, although every later window is right.
"""

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from quintet.coupler.coupling.judgement.time_error import Key
from quintet.coupler.coupling.saved_values import like
from quintet.coupler.coupling.schedule import Coupling
from quintet.interfaces.component import Array
from quintet.interfaces.sums import norm

LATE_LIMIT = 0.1  # of a motion's range: change that the first loads bring in one window
AIM = 0.01


class StartCheck:
    """Compares what the first two windows change: the loads act in the second only."""

    def __init__(self) -> None:
        self._changes: dict[Key, tuple[float, Array]] = {}  # window [s], change in the first one
        self._late: dict[Key, float] = {}  # norm of what the second one changed more
        self._ranges: dict[Key, tuple[Array, Array]] = {}  # least and largest positions, of late

    def check(self, coupling: Coupling, moves: Iterable[Key]) -> None:
        """Note what the first two windows of a run change of some positions, and their ranges."""
        if coupling.windows.done > 2:
            for key, (low, high) in self._ranges.items():
                position = coupling.outputs[key[0]][key[1]]
                self._ranges[key] = np.minimum(low, position), np.maximum(high, position)
            return
        dt = coupling.last_dt
        for name, path in moves:
            position, former = coupling.outputs[name][path], coupling.previous[name][path]
            change = position - former
            if coupling.windows.done == 1:
                self._changes[name, path] = dt, change
            elif (name, path) in self._changes and _is_pushed_late(coupling, name):
                length, first = self._changes.pop((name, path))
                self._late[name, path] = norm(change - dt / length * first) * length / dt
                places = np.array([former - first, former, position])
                self._ranges[name, path] = places.min(axis=0), places.max(axis=0)

    def warning(self, key: Key, window: float) -> str:
        """Warn of a position by its range in the run; "" if it is resolved in windows of so many s.

        The range is that at the windows' ends.
        """
        if key not in self._late:
            return ""
        low, high = self._ranges[key]
        extent = norm(high - low)
        if not self._late[key] > LATE_LIMIT * extent > 0.0:
            return ""
        share = self._late[key] / extent
        return (
            f"the loads of the first window act in the second, so that {'.'.join(key)} moves a "
            f"window of {window:.3g} s late; in the second window they change it by "
            f"{100.0 * share:.0f} % of its range in the run. Set window to "
            f"{window * AIM / share:.1g} s or less."
        )

    def save(self) -> dict[str, Any]:
        """All of it, for a snapshot."""
        ranges = {key: list(ends) for key, ends in self._ranges.items()}
        return {"changes": dict(self._changes), "late": dict(self._late), "ranges": ranges}

    def load(self, state: Mapping[str, Any]) -> None:
        """Come back to what was saved."""
        numbers = np.zeros(0)
        self._changes = {
            key: (like(0.0, length), like(numbers, change))
            for key, (length, change) in state["changes"].items()
        }
        self._late = {key: like(0.0, late) for key, late in state["late"].items()}
        self._ranges = {
            key: (like(numbers, low), like(numbers, high))
            for key, (low, high) in state["ranges"].items()
        }


def _is_pushed_late(coupling: Coupling, name: str) -> bool:
    """Whether loads of the first window reach a component in the second."""
    gives = coupling.exchange.gives
    for transfer in (coupling.exchange.transfers[number] for number in coupling.late):
        outputs = coupling.previous[transfer.giver]
        loads = [key for key in transfer.reads if gives[transfer.giver][key].centring == "impulse"]
        if transfer.taker == name and any(outputs[key].any() for key in loads):
            return True
    return False
