"""Whether the start of a run is resolved where loads reach their taker a window late.

In staggered windows the first loads act in the second window. A motion that they cause begins a
window late, and stays so on its way to rest, although every later window is right.
"""

from collections.abc import Iterable, Mapping
from typing import Any

from quintet.coupler.coupling.judgement.time_error import Key
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

    def check(self, coupling: Coupling, moves: Iterable[Key]) -> None:
        """Note what the first two windows of a run change of some positions."""
        dt = coupling.last_dt
        for name, path in moves:
            change = coupling.outputs[name][path] - coupling.previous[name][path]
            if coupling.windows.done == 1:
                self._changes[name, path] = dt, change
            elif (name, path) in self._changes and _is_pushed_late(coupling, name):
                former, first = self._changes.pop((name, path))
                self._late[name, path] = norm(change - dt / former * first) * former / dt

    def warning(self, key: Key, extent: float, window: float) -> str:
        """Warn of a position by its range in the run and the window [s]; "" if it is resolved."""
        if not self._late.get(key, 0.0) > LATE_LIMIT * extent > 0.0:
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
        return {"changes": dict(self._changes), "late": dict(self._late)}

    def load(self, state: Mapping[str, Any]) -> None:
        """Come back to what was saved."""
        self._changes, self._late = dict(state["changes"]), dict(state["late"])


def _is_pushed_late(coupling: Coupling, name: str) -> bool:
    """Whether loads reach a component a window late."""
    return any(coupling.exchange.transfers[number].taker == name for number in coupling.late)
