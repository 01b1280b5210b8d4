"""The error that the coupling makes in single windows, sampled through a run for its error bars.

A sampled window is stepped as it counts, and in 2 and in 4 shorter windows; both trials are undone.
The three results are extrapolated to windows of no length (Hairer, Nørsett and Wanner, Solving
Ordinary Differential Equations I, II.9); the error is the window's own result less that one.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field
from typing import Any, Protocol

import numpy as np

from quintet.coupler.coupling.judgement.error_growth import (
    DIFFERENCES,
    error_weights,
    rest_of,
)
from quintet.coupler.coupling.judgement.time_error import Key, same_branch
from quintet.coupler.coupling.judgement.trial_window import Outputs, step_in_pieces
from quintet.coupler.coupling.participant import TrialFailed
from quintet.coupler.coupling.saved_values import attributes_like, like
from quintet.coupler.coupling.schedule import Coupling
from quintet.interfaces.component import Array, Fields
from quintet.interfaces.sums import dot, norm

GOLDEN = 0.5 * (math.sqrt(5.0) - 1.0)
SAME = 1e-9  # by which windows of one length may differ, relative
PIECES = 2, 4
STARTING = 4  # windows after which the start of a staggered scheme has decayed
HIGHEST = 4  # order of the error that is looked for


class Quantity(Protocol):
    """A quantity whose error is estimated."""

    @property
    def component(self) -> str:
        """Component that gives its field."""

    @property
    def field(self) -> str:
        """Its field, ``"port.field"``."""

    @property
    def rate(self) -> str:
        """Field of its rate, by which a rest of the rate moves it on; "" if it has none."""

    def values(self, output: Array, window: float) -> Array:
        """Its values, from the field at the end of a window [s]."""


@dataclass(frozen=True, slots=True)
class WindowError:
    """Estimated errors of one window.

    Parameters
    ----------
    window : int
        Number of the window, from 1.
    errors : list of floats
        Of each watched quantity, in its unit; of several values their root mean square.
    weights : list of floats
        The error of the state as a combination of its next changes (`error_growth`).
    rests : list of floats
        Of each watched quantity, what the combination leaves of its error.
    drifts : list of floats
        The same of its rate.
    """

    window: int
    errors: list[float]
    weights: list[float]
    rests: list[float]
    drifts: list[float]


def sampled_window(stratum: int, every: int) -> int:
    """Number, from 1, of the window that is sampled in a stratum of `every` windows, from 0.

    The places in the strata have low discrepancy (multiples of the golden section): samples at
    equal distances could keep step with an oscillation. The first window stands for itself alone:
    in staggered schemes no load has arrived yet.
    """
    return 2 + stratum * every + int(every * math.fmod((stratum + 1) * GOLDEN, 1.0))


class Orders:
    """Order of the error in the window's length, measured for each field over all samples."""

    def __init__(self) -> None:
        self.products: dict[Key, float] = {}
        self.squares: dict[Key, float] = {}

    def extrapolated(self, key: Key, whole: Array, halves: Array, quarters: Array) -> Array:
        """Result for windows of no length, from those of a window, its halves and quarters."""
        first, second = whole - halves, halves - quarters
        self.products[key] = self.products.get(key, 0.0) + dot(first, second)
        self.squares[key] = self.squares.get(key, 0.0) + norm(first) ** 2
        order = self.order(key)
        # Neville's table of an error C h^p + D h^(p+1).
        coarse = halves - first / (2**order - 1)
        fine = quarters - second / (2**order - 1)
        return np.asarray(fine + (fine - coarse) / (2 ** (order + 1) - 1))

    def order(self, key: Key) -> int:
        """Order of the error left at the end of a fixed time: its halves' is 2^-p of it."""
        product, square = self.products[key], self.squares[key]
        if not product > 0.0:
            return HIGHEST if square > 0.0 else 1
        return min(HIGHEST, max(1, round(math.log2(square / product))))


@dataclass(slots=True)
class Pending:
    """A sampled window whose error awaits the states that follow.

    Parameters
    ----------
    window : int
        Its number, from 1.
    errors : mapping
        Error of each output at its end.
    lengths : list of floats, s
        Of itself and of the windows since.
    states : list of mappings
        Outputs of all components at the end of each; after the first window, of later ones.
    """

    window: int
    errors: dict[Key, Array]
    lengths: list[float]
    states: list[dict[str, Fields]]


@dataclass(slots=True)
class ErrorBar:
    """Samples windows of a run for the errors of watched quantities.

    Parameters
    ----------
    quantities : sequence
    every : int
        Windows of a stratum, of which one is sampled.
    needs : mapping
        Outputs of each component that make up the state, in which an error goes on.
    """

    quantities: Sequence[Quantity]
    every: int
    needs: Mapping[str, set[str]]
    samples: list[WindowError] = field(default_factory=list)
    orders: Orders = field(default_factory=Orders)
    due: bool = True  # whether the next window that can be is sampled
    skipped: str = ""  # why no more windows are sampled
    _lengths: tuple[float, float] = (0.0, 0.0)  # s, of the last two windows
    _pending: list[Pending] = field(default_factory=list)
    _pieces: list[Outputs] | None = None

    def before(self, coupling: Coupling) -> None:
        """Step the coming window in shorter ones, if it is due."""
        windows, number = coupling.windows, coupling.windows.done + 1
        stratum = max(0, number - 2) // self.every
        self.due = (self.due or sampled_window(stratum, self.every) == number) and not self.skipped
        if not self.due:
            return
        saved = windows.save()
        ticks = windows.next(coupling.allowed())
        windows.load(saved)
        dt = ticks * windows.tick
        if windows.done and any(abs(length - dt) > SAME * dt for length in self._lengths):
            return  # what is late belongs to windows of another length, or to none
        self.due = False
        try:
            self._pieces = step_in_pieces(coupling, ticks, PIECES, extrapolate=True)
        except TrialFailed as error:
            self.skipped = str(error)

    def check(self, coupling: Coupling) -> None:
        """Compare a window with the same in shorter ones, if it was stepped so."""
        dt, outputs = coupling.last_dt, dict(coupling.outputs)
        for pending in self._pending:
            pending.lengths.append(dt)
            # How a staggered scheme starts is no part of the motion.
            if pending.window > 1 or coupling.windows.done > STARTING:
                pending.states.append(outputs)
        if self._pieces is not None:
            number = coupling.windows.done
            errors = self._errors(coupling, self._pieces, Orders() if number == 1 else self.orders)
            self._pending.append(Pending(number, errors, [dt], [outputs] if number > 1 else []))
        self._pieces, self._lengths = None, (self._lengths[1], dt)
        while self._pending and len(self._pending[0].states) > DIFFERENCES:
            self.samples.append(self._judged(coupling, self._pending.pop(0)))

    def _errors(
        self, coupling: Coupling, pieces: Sequence[Outputs], orders: Orders
    ) -> dict[Key, Array]:
        """Errors of all outputs at the end of a window."""
        errors = {}
        for key in pieces[0]:
            whole = coupling.outputs[key[0]][key[1]]
            results = [outputs[key] for outputs in pieces]
            if coupling.exchange.output(*key).kind == "rotation":
                results = [same_branch(whole, result) for result in results]
            errors[key] = whole - orders.extrapolated(key, whole, *results)
        return errors

    def _judged(self, coupling: Coupling, pending: Pending) -> WindowError:
        """Errors of the watched quantities in a window, and how they go on."""
        errors, states, dt = pending.errors, pending.states, pending.lengths[0]
        weights = [0.0] * DIFFERENCES
        if all(abs(length - dt) <= SAME * dt for length in pending.lengths):
            weights = error_weights(coupling.exchange, errors, states)
        sample = WindowError(pending.window, [], weights, [], [])
        for quantity in self.quantities:
            name, key = quantity.component, quantity.field
            error, output = errors[name, key], states[0][name][key]
            rest = rest_of(error, weights, [state[name][key] for state in states])
            sample.errors.append(mean_size(_change(quantity, output, error, dt)))
            sample.rests.append(_one(_change(quantity, output, rest, dt)))
            drift = np.zeros(1)
            if quantity.rate:
                rates = [state[name][quantity.rate] for state in states]
                rest = rest_of(errors[name, quantity.rate], weights, rates)
                drift = _change(quantity, rates[0], rest, dt)
            sample.drifts.append(_one(drift))
        return sample

    def save(self) -> dict[str, Any]:
        """All that counts, for a snapshot."""
        pending = {
            str(number): {
                "window": each.window,
                "errors": each.errors,
                "lengths": each.lengths,
                "states": {str(n): state for n, state in enumerate(each.states)},
            }
            for number, each in enumerate(self._pending)
        }
        return {
            "samples": [asdict(sample) for sample in self.samples],
            "products": dict(self.orders.products),
            "squares": dict(self.orders.squares),
            "due": self.due,
            "skipped": self.skipped,
            "lengths": list(self._lengths),
            "pending": pending,
        }

    def load(self, state: Mapping[str, Any]) -> None:
        """Come back to what was saved."""
        pattern = WindowError(0, [], [], [], [])
        self.samples = [
            WindowError(**attributes_like(pattern, sample)) for sample in state["samples"]
        ]
        self.orders.products = dict(state["products"])
        self.orders.squares = dict(state["squares"])
        self.due, self.skipped = like(False, state["due"]), like("", state["skipped"])
        before, last = state["lengths"]
        self._lengths = like(0.0, before), like(0.0, last)
        self._pending = [
            Pending(
                like(0, each["window"]),
                dict(each["errors"]),
                [like(0.0, length) for length in each["lengths"]],
                list(each["states"].values()),
            )
            for each in state["pending"].values()
        ]


def mean_size(values: Array) -> float:
    """Root mean square of some values; of one its magnitude."""
    return norm(values) / max(1.0, float(values.size)) ** 0.5


def _change(quantity: Quantity, output: Array, error: Array, dt: float) -> Array:
    """What an error of its field makes of a quantity."""
    return quantity.values(output, dt) - quantity.values(output - error, dt)


def _one(values: Array) -> float:
    """A single value with its sign; of several the root mean square."""
    return float(values[0]) if len(values) == 1 else mean_size(values)
