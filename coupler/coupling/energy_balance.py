"""Energy and mass of a whole run: how far they rise and fall, told against what was turned over.

What is done on components from outside of the run is no rise, and what they lose there no fall.
"""

from collections.abc import Mapping
from typing import Any

from quintet.coupler.coupling.saved_values import like

KINDS = ("kinetic", "potential", "internal")
# Of the largest energy that a component has: what changes by less is rounding, not turned over.
NEGLIGIBLE = 1e-6


class EnergyBalance:
    """Extremes of every energy of every component, the change of their sum, and of every mass."""

    def __init__(self) -> None:
        self._range: dict[str, list[float]] = {}  # J, by component and kind: least, most
        self._sums: list[float] = []  # J, at the start, the largest since and the last
        self._times = 0  # at which totals were noted
        self._masses: dict[str, list[float]] = {}  # kg, by component: at the start and the last

    def note(self, totals: Mapping[str, Mapping[str, Any]]) -> None:
        """Take down the energies [J] and masses [kg] of all components at one time."""
        total = 0.0
        self._times += 1
        for name, sums in totals.items():
            for kind in KINDS:
                energy = float(sums[kind])
                total += energy
                least, most = self._range.get(f"{name}.{kind}", (energy, energy))
                self._range[f"{name}.{kind}"] = [min(least, energy), max(most, energy)]
            total -= float(sums["work"])
            mass = float(sums["mass"])
            self._masses[name] = [self._masses.get(name, [mass])[0], mass]
        start, largest, _ = self._sums or (total, total, total)
        self._sums = [start, max(largest, total), total]

    def largest(self, *kinds: str) -> float:
        """Largest energy [J] of one of some kinds that any component had, by magnitude."""
        ranges = ((key.rpartition(".")[2], pair) for key, pair in self._range.items())
        return max(
            (abs(value) for kind, pair in ranges if kind in kinds for value in pair), default=0.0
        )

    def change(self) -> dict[str, float] | None:
        """Largest rise and final loss [J] of the sum, less works, and what was turned over.

        Both count from the start. Turned over is the largest change [J] of one kind of energy of
        one component at the `times` at which totals were noted. None where that is rounding.
        """
        turned = max((most - least for least, most in self._range.values()), default=0.0)
        if not turned > NEGLIGIBLE * self.largest(*KINDS):
            return None
        start, largest, last = self._sums
        lost = max(start - last, 0.0)
        gained, times = largest - start, self._times
        return {"gained": gained, "lost": lost, "turned_over": turned, "times": times}

    def drift(self) -> float | None:
        """Largest rise of the sum, less works, above its start over the energy turned over."""
        change = self.change()
        return change["gained"] / change["turned_over"] if change else None

    def mass_drift(self) -> dict[str, dict[str, float | None]]:
        """Change of each component's mass since the start: in kg, and relative.

        Components without a mass are left out; the relative change is None where there was none at
        the start.
        """
        return {
            name: {"kg": last - start, "relative": (last - start) / start if start else None}
            for name, (start, last) in self._masses.items()
            if start or last
        }

    def save(self) -> dict[str, Any]:
        """All of it, for a snapshot."""
        saved = {"range": self._range, "sums": self._sums, "masses": self._masses}
        return {**saved, "times": self._times}

    def load(self, state: Mapping[str, Any]) -> None:
        """Come back to what was saved."""
        self._range = {key: _numbers(pair, 2) for key, pair in state["range"].items()}
        self._sums = _numbers(state["sums"], 3) if state["sums"] else []
        self._times = like(0, state["times"])
        self._masses = {name: _numbers(pair, 2) for name, pair in state["masses"].items()}


def _numbers(values: Any, count: int) -> list[float]:
    """So many numbers of a snapshot, in which anything may be."""
    if len(values) != count:
        raise ValueError(f"{count} numbers expected, found {len(values)}")
    return [like(0.0, value) for value in values]
