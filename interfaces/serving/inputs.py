"""What a component is given at each of its steps, from what came at the ends of a window.

Impulses become the constant rate that has the same integral. Instants are taken at the
middle of each step: between two known ends linearly, or by a cubic Hermite polynomial when
their rate comes with them; beyond the last known end by their rate. A velocity that comes
with a position is given as the mean over the step, so that displacements add up to rounding.
"""

from collections.abc import Collection, Iterable

import numpy as np

from quintet.interfaces.component import Array, Fields, Port
from quintet.interfaces.errors import PortError


class Inputs:
    """The inputs of one component through a window."""

    def __init__(self, takes: Iterable[Port]) -> None:
        fields = [(f"{port.name}.", field) for port in takes for field in port.fields]
        self.fields = {head + field.name: field for head, field in fields}
        self.rates = {head + f.name: head + f.rate for head, f in fields if f.rate}
        self.impulses = {k for k, f in self.fields.items() if f.centring == "impulse"}
        self.rows: dict[str, int] = {}  # of each field, from its first arrival
        self.start: dict[str, Array] = {}  # instants at the window's beginning
        self.end: dict[str, Array] = {}  # and at its end, where known
        self.rate: dict[str, Array] = {}  # impulses / window

    def arrive(self, fields: Fields, ends: Collection[str], window: float) -> None:
        """Take what came for this window; instants named in `ends` hold at its end."""
        self.start.update(self.end)  # what was an end is now a beginning
        self.end = {}
        for key, array in fields.items():
            if key not in self.fields:
                known = ", ".join(self.fields) or "nothing"
                raise PortError(f"field {key} is not taken here; the ports take {known}.")
            self._check(key, array)
            if key in self.impulses:
                self.rate[key] = array / window
            elif key in ends and key in self.start:
                self.end[key] = array
            else:
                self.start[key] = array

    def _check(self, key: str, array: Array) -> None:
        shape, rows = self.fields[key].shape, self.rows.setdefault(key, len(array))
        if array.shape != (rows, *shape):
            raise PortError(f"field {key} must have shape {(rows, *shape)}; found {array.shape}.")

    @property
    def constant(self) -> bool:
        """Whether every step of the window gets the same."""
        return not self.start

    def over(self, begin: float, end: float, window: float) -> dict[str, Array]:
        """Inputs for the step from `begin` to `end`, both in s from the window's beginning."""
        middle = 0.5 * (begin + end)
        given = dict(self.rate)
        for key in self.start:
            given[key] = self._at(key, middle, window)
        for key, rate in self.rates.items():
            if key in self.start and rate in self.start:
                moved = self._at(key, end, window) - self._at(key, begin, window)
                given[rate] = moved / (end - begin)
        for array in given.values():
            array.flags.writeable = False
        return given

    def _at(self, key: str, time: float, window: float) -> Array:
        first, rate = self.start[key], self.rates.get(key, "")
        hermite = rate in self.start
        if key not in self.end:
            return first + time * self.start[rate] if hermite else first.view()
        if time in (0.0, window):  # exactly the ends, whatever rounding does between
            return (first if time == 0.0 else self.end[key]).view()
        s = time / window
        straight = self.end[key] - first
        if hermite and rate in self.end:
            # The Hermite basis, written as a correction of the straight line between the ends.
            bow = window * ((1.0 - s) * self.start[rate] - s * self.end[rate])
            bow -= (1.0 - 2.0 * s) * straight
            straight += (1.0 - s) * bow
        straight *= s  # in place: fields may be large
        straight += first
        return straight

    def save(self) -> dict[str, Array]:
        """What must come back with a component's state."""
        kept = {f"start/{key}": array for key, array in self.start.items()}
        kept |= {f"end/{key}": array for key, array in self.end.items()}
        return kept | {f"rate/{key}": array for key, array in self.rate.items()}

    def load(self, state: Fields) -> None:
        """Come back to a saved state."""
        parts: dict[str, dict[str, Array]] = {"start": {}, "end": {}, "rate": {}}
        for name, array in state.items():
            part, _, key = name.partition("/")
            parts[part][key] = np.array(array)
        self.start, self.end, self.rate = parts["start"], parts["end"], parts["rate"]
