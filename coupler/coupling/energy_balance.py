"""The energy of a whole run: whether it rises, told against all that was turned over.

What is done on components from outside of the run is no rise, and what they lose there no fall.
"""

from collections.abc import Mapping
from typing import Any

KINDS = ("kinetic", "potential", "internal")
# Of the largest energy that a component has: what changes by less is rounding, not turned over.
NEGLIGIBLE = 1e-6


class EnergyBalance:
    """Extremes of every energy of every component, and the rise of their sum."""

    def __init__(self) -> None:
        self._range: dict[str, list[float]] = {}  # J, by component and kind: least, most
        self._sums: list[float] = []  # J, at the start and the largest since

    def note(self, totals: Mapping[str, Mapping[str, Any]]) -> None:
        """Take down the energies [J] of all components at one time."""
        total = 0.0
        for name, one in totals.items():
            for kind in KINDS:
                energy = float(one[kind])
                total += energy
                least, most = self._range.get(f"{name}.{kind}", (energy, energy))
                self._range[f"{name}.{kind}"] = [min(least, energy), max(most, energy)]
            total -= float(one["work"])
        start, largest = self._sums or (total, total)
        self._sums = [start, max(largest, total)]

    def largest(self, *kinds: str) -> float:
        """Largest energy [J] of one of some kinds that any component had, by magnitude."""
        ranges = ((key.rpartition(".")[2], pair) for key, pair in self._range.items())
        return max(
            (abs(one) for kind, pair in ranges if kind in kinds for one in pair), default=0.0
        )

    def drift(self) -> float | None:
        """Largest rise of the sum, less works, above its start over the largest energy turned over.

        That is the largest change of one kind of energy of one component. None where nothing was
        turned over but rounding: there is nothing to tell a rise against.
        """
        turned = max((most - least for least, most in self._range.values()), default=0.0)
        if not turned > NEGLIGIBLE * self.largest(*KINDS):
            return None
        start, largest = self._sums
        return (largest - start) / turned

    def save(self) -> dict[str, Any]:
        """All of it, for a snapshot."""
        return {"range": self._range, "sums": self._sums}

    def load(self, state: Mapping[str, Any]) -> None:
        """Come back to what was saved."""
        self._range = {key: list(pair) for key, pair in state["range"].items()}
        self._sums = list(state["sums"])
