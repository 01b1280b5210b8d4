"""What a component is given at each of its steps, from what came at the ends of a window.

Impulses become the constant rate that has the same integral. Instants are taken at the
middle of each step: between two known ends linearly, or by a cubic Hermite polynomial when
their rate comes with them; beyond the last known end by their rate. A velocity that comes
with a position is given as the mean over the step, so that displacements add up to rounding.

Rotations go the same ways on the sphere: beyond the known end exp(ω t) q₀, between two known
ends exp(φ(t)) q₀ with a cubic Hermite polynomial φ whose end is, of all rotation vectors that
lead to the end, the one nearest to the mean angular velocity times the window.
"""

import reprlib
from collections.abc import Collection, Iterable
from typing import NamedTuple

import numpy as np

from quintet.interfaces import rotation
from quintet.interfaces.component import Array, Fields, Port
from quintet.interfaces.errors import PortError

FLOAT = np.dtype(float)


class KnownEnds(NamedTuple):
    """An instant and its rate at the beginning of a window, and at its end where it is known."""

    first: Array
    first_rate: Array | None = None
    last: Array | None = None
    last_rate: Array | None = None


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
            if array.dtype != FLOAT:
                array = array.astype(FLOAT)
            if key in self.impulses:
                self.rate[key] = array / window
            elif key in ends and key in self.start:
                self.end[key] = array
            else:
                self.start[key] = array

    def _check(self, key: str, array: Array) -> None:
        shape = self.fields[key].shape
        rows = self.rows.setdefault(key, len(array)) if array.ndim else 0
        if array.shape != (rows, *shape):
            raise PortError(f"field {key} must have shape {(rows, *shape)}; found {array.shape}.")

    @property
    def constant(self) -> bool:
        """Whether every step of the window gets the same."""
        return not self.start

    def over(self, begin: float, end: float, window: float) -> dict[str, Array]:
        """Inputs for the step from `begin` to `end`, both in s from the window's beginning."""
        middle = 0.5 * (begin + end)
        values = dict(self.rate)
        moves = {rate: key for key, rate in self.rates.items() if key in self.start}
        for key in self.start:
            if key in moves:
                values[key] = self._mean_rate(moves[key], key, begin, end, window)
            else:
                values[key] = self._at(key, middle, window)
        for array in values.values():
            array.flags.writeable = False
        return values

    def at_start(self) -> dict[str, Array]:
        """Instants as they are at the window's beginning."""
        values = {key: array.view() for key, array in self.start.items()}
        for array in values.values():
            array.flags.writeable = False
        return values

    def _mean_rate(self, key: str, rate: str, begin: float, end: float, window: float) -> Array:
        if self.fields[key].kind != "rotation":
            moved = self._at(key, end, window) - self._at(key, begin, window)
            return np.asarray(moved / (end - begin))
        if key not in self.end:
            return self.start[rate].view()
        near = self._turn(key, end, window) - self._turn(key, begin, window)
        ends = self._at(key, begin, window), self._at(key, end, window)
        return np.asarray(rotation.vector_between(*ends, near) / (end - begin))

    def _at(self, key: str, time: float, window: float) -> Array:
        return value_at(self.fields[key].kind, self._ends(key), time, window)

    def value(self, key: str, time: float, window: float) -> Array:
        """Value of an instant at a time [s] of the window."""
        return self._at(key, time, window)

    def _turn(self, key: str, time: float, window: float) -> Array:
        return turn_at(self._ends(key), time, window)

    def _ends(self, key: str) -> KnownEnds:
        rate = self.rates.get(key, "")
        ends = self.start.get(rate), self.end.get(key), self.end.get(rate)
        return KnownEnds(self.start[key], *ends)

    def save(self) -> dict[str, Array]:
        """What must come back with a component's state."""
        arrays = {f"start/{key}": array for key, array in self.start.items()}
        arrays |= {f"end/{key}": array for key, array in self.end.items()}
        return arrays | {f"rate/{key}": array for key, array in self.rate.items()}

    def load(self, state: Fields) -> None:
        """Come back to a saved state."""
        parts: dict[str, dict[str, Array]] = {"start": {}, "end": {}, "rate": {}}
        for name, array in state.items():
            part, _, key = name.partition("/")
            if part not in parts or key not in self.fields:
                raise PortError(f"inputs have no {reprlib.repr(name)}; a saved state was expected.")
            self._check(key, array)
            parts[part][key] = np.array(array, float)
        self.start, self.end, self.rate = parts["start"], parts["end"], parts["rate"]


def value_at(kind: str, ends: KnownEnds, time: float, window: float) -> Array:
    """Value of an instant at a time [s] of a window, from what is known at its two ends."""
    first, first_rate, last, last_rate = ends
    if kind == "flag" and time < window:
        return first.view()
    if kind == "rotation":
        if time in (0.0, window) and (last is not None or time == 0.0):
            return (first if time == 0.0 or last is None else last).view()
        turn = turn_at(ends, time, window)
        return rotation.product(rotation.exponential(turn), first)
    if last is None:
        return first + time * first_rate if first_rate is not None else first.view()
    if time in (0.0, window):  # exactly the ends, whatever rounding does between
        return (first if time == 0.0 else last).view()
    s = time / window
    straight = last - first
    if first_rate is not None and last_rate is not None:
        straight += (1.0 - s) * _hermite_correction(straight, first_rate, last_rate, s, window)
    straight *= s  # in place: fields may be large
    straight += first
    return straight


def turn_at(ends: KnownEnds, time: float, window: float) -> Array:
    """Rotation vector (n, 3) that leads from a quaternion to where it is at a time [s]."""
    first, first_rate, last, last_rate = ends
    if last is None:
        return np.zeros((len(first), 3)) if first_rate is None else time * first_rate
    s = time / window
    near = np.zeros((len(first), 3))
    if first_rate is not None:
        near = 0.5 * window * (first_rate + (first_rate if last_rate is None else last_rate))
    whole = rotation.vector_between(first, last, near)
    if first_rate is None or last_rate is None:
        return np.asarray(s * whole)
    end_rate = rotation.rate_of_vector(whole, last_rate)
    return np.asarray(
        s * (whole + (1.0 - s) * _hermite_correction(whole, first_rate, end_rate, s, window))
    )


def _hermite_correction(
    straight: Array, first_rate: Array, last_rate: Array, s: float, window: float
) -> Array:
    """The Hermite basis, written as a correction of the straight line between the ends."""
    correction = window * ((1.0 - s) * first_rate - s * last_rate)
    correction -= (1.0 - 2.0 * s) * straight
    return correction
