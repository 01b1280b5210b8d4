"""Acceleration of iterated windows: the next guess, from what was guessed and what was found.

A window is repeated until the interface residual r(x) = x̃(x) - x vanishes, where x are the
guessed inputs and x̃ those that the components then gave. Residuals are scaled per field before
they enter a norm, and what outlives a window is kept as rates (`residual_scaling`).

Literature: Küttler and Wall (2008), Comput. Mech. 43, 61 (Aitken); Degroote, Bathe and Vierendeels
(2009), Comput. Struct. 87, 793 (IQN-ILS, reuse of columns over windows); Mehl et al. (2016),
Comput. Math. Appl. 71, 869.
"""

import math
from collections.abc import Callable, Mapping
from typing import Protocol

import numpy as np

from quintet.coupler.coupling.iteration.least_squares import combination, filtered_least_squares
from quintet.coupler.coupling.iteration.residual_scaling import Guess, Key, ResidualScaling
from quintet.coupler.coupling.iteration.settings import IterationSettings
from quintet.interfaces.component import Array, Fields
from quintet.interfaces.sums import dot, norm

GROWTH = 4.0  # of the residual in a window, from which on former windows' columns are dropped
Allowed = Mapping[Key, float]  # norm of the residual [of rates] below which a field has converged


class Acceleration(Protocol):
    """How guesses follow one another. Impulses come and go as integrals over the window."""

    def begin_window(self, length: float) -> None:
        """Begin a window of a length [s]."""

    def next(self, guess: Guess, result: Guess, allowed: Allowed) -> dict[Key, Array]:
        """Return the next guess, after one that has not converged."""

    def end_window(self, guess: Guess, result: Guess) -> None:
        """End a window with its last guess, which needed no next."""

    def save(self) -> dict[str, Array]:
        """All that outlives a window, for a snapshot at its end."""

    def load(self, state: Fields) -> None:
        """Come back to what was saved, bit for bit."""


def make(settings: IterationSettings, is_impulse: Callable[[str, str], bool]) -> Acceleration:
    """Make what the settings name; `is_impulse` tells of a taker's field how it is centred."""
    if settings.acceleration == "constant":
        return Constant(settings.relaxation)
    scaling = ResidualScaling(is_impulse)
    if settings.acceleration == "aitken":
        return Aitken(settings.relaxation, scaling)
    return IqnIls(settings.relaxation, settings.reuse, settings.filter, scaling)


class Constant:
    """Relaxation by a constant factor: x + ω r."""

    def __init__(self, factor: float) -> None:
        self.factor = factor

    def begin_window(self, length: float) -> None:
        """Nothing changes."""

    def next(self, guess: Guess, result: Guess, allowed: Allowed) -> dict[Key, Array]:
        """Return the next guess."""
        return _relaxed(guess, result, self.factor)

    def end_window(self, guess: Guess, result: Guess) -> None:
        """Nothing is kept."""

    def save(self) -> dict[str, Array]:
        """Nothing."""
        return {}

    def load(self, state: Fields) -> None:
        """Nothing was kept."""


class Aitken:
    """Relaxation by a factor found from the last two residuals (Küttler and Wall 2008, eq. 44)."""

    def __init__(self, most: float, scaling: ResidualScaling) -> None:
        self.most = most  # of the first factor in a window
        self.factor = most
        self.scaling = scaling
        self._last: Array | None = None  # residual of this window

    def begin_window(self, length: float) -> None:
        """Begin with the last factor, bounded (Degroote et al. 2009)."""
        self.scaling.begin_window(length)
        self.factor = math.copysign(min(abs(self.factor), self.most), self.factor)
        self._last = None

    def next(self, guess: Guess, result: Guess, allowed: Allowed) -> dict[Key, Array]:
        """Return the next guess."""
        residual = self.scaling.vector(result) - self.scaling.vector(guess)
        weights = self.scaling.weights(residual, guess, allowed)
        if self._last is not None:
            change = weights * (residual - self._last)
            square = dot(change, change)
            factor = -self.factor * dot(weights * self._last, change) / square if square else 0.0
            if factor:  # with 0 no guess would ever change again
                self.factor = factor
        self._last = residual
        return _relaxed(guess, result, self.factor)

    def end_window(self, guess: Guess, result: Guess) -> None:
        """The factor stays for the next window."""

    def save(self) -> dict[str, Array]:
        """The factor, and the fields' scales."""
        return {"factor": np.array([self.factor]), "sizes": self.scaling.sizes.copy()}

    def load(self, state: Fields) -> None:
        """Come back to them."""
        self.factor = float(state["factor"][0])
        self.scaling.sizes = np.array(state["sizes"])


class IqnIls:
    """Interface quasi-Newton, its inverse Jacobian from least squares (Degroote et al. 2009).

    Columns are the changes of residual and of found values from repetition to repetition, of this
    window and of former ones: x + r + W c, where c makes the norm of V c + r smallest. Both are
    kept unscaled, as rates, so that weights may change from window to window.
    """

    def __init__(
        self, relaxation: float, reuse: int, limit: float, scaling: ResidualScaling
    ) -> None:
        self.relaxation = relaxation  # of a guess for which there are no columns yet
        self.reuse = reuse  # former windows
        self.limit = limit  # of the filter of columns
        self.scaling = scaling
        self.residual_changes: list[Array] = []  # columns of V, each (n,), the newest first
        self.found_changes: list[Array] = []  # of W
        self.ages: list[int] = []  # windows since each was made
        self._last: tuple[Array, Array] | None = None  # residual and found values of this window
        self._first = 0.0  # scaled norm of this window's first residual

    def begin_window(self, length: float) -> None:
        """Begin a window of a length [s]."""
        self.scaling.begin_window(length)
        self._last, self._first = None, 0.0

    def next(self, guess: Guess, result: Guess, allowed: Allowed) -> dict[Key, Array]:
        """Return the next guess."""
        residual = self._observe(guess, result)
        weights = self.scaling.weights(residual, guess, allowed)
        self._distrust(norm(weights * residual))
        if not self.ages:
            return _relaxed(guess, result, self.relaxation)
        scaled = np.array([weights * column for column in self.residual_changes])
        factors, is_used = filtered_least_squares(scaled, -weights * residual, self.limit)
        change = residual + combination(factors, self.found_changes)
        self._keep(is_used.tolist())
        if not self.ages:
            return _relaxed(guess, result, self.relaxation)
        moved = self.scaling.fields(change, guess)
        return {key: guess[key] + moved[key] for key in guess}

    def end_window(self, guess: Guess, result: Guess) -> None:
        """Take the last column, and drop those of windows too long ago."""
        self._observe(guess, result)
        self._last = None
        if 0 in self.ages:  # windows that needed no repetition do not count
            self.ages = [age + 1 for age in self.ages]
        self._keep([age <= self.reuse for age in self.ages])

    def _distrust(self, size: float) -> None:
        """Drop former windows' columns once the residual has grown far: they no longer hold."""
        if not self._first:
            self._first = size
        elif size > GROWTH * self._first:
            self._keep([age == 0 for age in self.ages])

    def _observe(self, guess: Guess, result: Guess) -> Array:
        """Return the residual; make a column of what changed since the last."""
        values = self.scaling.vector(result)
        residual = values - self.scaling.vector(guess)
        if self._last is not None:
            self.residual_changes.insert(0, residual - self._last[0])
            self.found_changes.insert(0, values - self._last[1])
            self.ages.insert(0, 0)
        self._last = residual, values
        return residual

    def _keep(self, is_used: list[bool]) -> None:
        chosen = [number for number, used in enumerate(is_used) if used]
        self.residual_changes = [self.residual_changes[number] for number in chosen]
        self.found_changes = [self.found_changes[number] for number in chosen]
        self.ages = [self.ages[number] for number in chosen]

    def save(self) -> dict[str, Array]:
        """The columns and their ages, and the fields' scales."""
        return {
            "residual_changes": np.array(self.residual_changes, dtype=float),  # (k, n)
            "found_changes": np.array(self.found_changes, dtype=float),  # (k, n)
            "ages": np.array(self.ages, dtype=np.int64),  # (k,)
            "sizes": self.scaling.sizes.copy(),  # (fields,)
        }

    def load(self, state: Fields) -> None:
        """Come back to them."""
        self.residual_changes = list(np.array(state["residual_changes"]))
        self.found_changes = list(np.array(state["found_changes"]))
        self.ages = np.asarray(state["ages"]).tolist()
        self.scaling.sizes = np.array(state["sizes"])
        self._last = None


def _relaxed(guess: Guess, result: Guess, factor: float) -> dict[Key, Array]:
    return {key: guess[key] + factor * (result[key] - guess[key]) for key in guess}
