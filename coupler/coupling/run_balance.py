"""The balance of a run: all that was ever given, against all that was ever applied.

A window that is lost between two components, or carried twice, closes in itself: only the
sums over the whole run show it.
"""

from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from quintet.coupler.coupling.exchange import Exchange
from quintet.interfaces.component import Array, Fields
from quintet.interfaces.sums import column_sums, size

Gap = tuple[str, str, set[int], Array, float]  # taker, field, transfers, difference, scale


@dataclass(slots=True)
class RunningSum:
    """What one transfer's giver gave of one impulse."""

    total: Array = field(default_factory=lambda: np.zeros(1))  # since the start
    last: Array = field(default_factory=lambda: np.zeros(1))  # in the last window
    scale: float = 0.0  # sum of the sizes

    def add(self, array: Array) -> None:
        """Add a window."""
        self.last = np.asarray(column_sums(array))
        self.total = self.total + self.last
        self.scale += size(array)


class RunBalance:
    """Sums over the run of every impulse whose sum a mapping keeps."""

    def __init__(self, exchange: Exchange) -> None:
        self.exchange = exchange
        # by taker and its field: number of the transfer, the giver's field, sums
        self._given: dict[tuple[str, str], list[tuple[int, str, RunningSum]]] = {}
        self._applied: dict[tuple[str, str], Array] = {}
        for number, transfer in enumerate(exchange.transfers):
            for before, after in exchange.sums[number]:
                place = transfer.taker, after
                self._given.setdefault(place, []).append((number, before, RunningSum()))

    def book_given(self, number: int, outputs: Fields) -> None:
        """Add what the giver of a transfer gave in a window, as it arrived."""
        for entries in self._given.values():
            for transfer, before, running in entries:
                if transfer == number:
                    running.add(self.exchange.rows(number, outputs)[before])

    def applied(self, name: str, sums: Mapping[str, list[float]]) -> None:
        """Add what a component says it applied in a window."""
        for taker, key in self._given:
            if taker == name:
                before = self._applied.get((taker, key), 0.0)
                self._applied[taker, key] = before + np.asarray(sums.get(key, 0.0))

    def save(self) -> dict[str, Any]:
        """All sums, for a snapshot."""
        entries = [entry for entries in self._given.values() for entry in entries]
        sums = [[run.total.tolist(), run.last.tolist(), run.scale] for *_, run in entries]
        applied = [[*place, np.asarray(sums).tolist()] for place, sums in self._applied.items()]
        return {"given": sums, "applied": applied}

    def load(self, state: Mapping[str, Any]) -> None:
        """Come back to saved sums."""
        entries = [entry for entries in self._given.values() for entry in entries]
        for (*_, run), (total, last, scale) in zip(entries, state["given"], strict=True):
            run.total, run.last, run.scale = np.array(total), np.array(last), scale
        self._applied = {(name, key): np.array(sums) for name, key, sums in state["applied"]}

    def gaps(
        self, late: Collection[int], in_transit: Mapping[tuple[str, str], Array]
    ) -> Iterator[Gap]:
        """Yield what is missing of every impulse; late ones are still on their way."""
        for (taker, key), entries in self._given.items():
            due: Array = np.zeros(1)
            for number, _, running in entries:
                due = due + running.total
                if number in late:
                    due = due - running.last
            if (taker, key) in in_transit:
                due = due - column_sums(in_transit[taker, key])
            scale = sum(running.scale for *_, running in entries)
            numbers = {number for number, *_ in entries}
            yield taker, key, numbers, due - self._applied.get((taker, key), 0.0), scale
