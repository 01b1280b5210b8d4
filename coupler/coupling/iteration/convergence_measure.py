"""Convergence measures of repeated windows: which field still lacks how much."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from quintet.coupler.coupling.iteration.residual_scaling import Guess, Key
from quintet.interfaces.component import Array, Fields
from quintet.interfaces.sums import norm

FLOOR = 1e-3  # of the largest norm that agreed so far: below it no agreement is asked for
# Of the largest norm of all fields, in SI: below it there is only rounding, as in the torque on a
# body that water pushes evenly.
ROUNDING = 1e-12


@dataclass(frozen=True, slots=True)
class Residual:
    """What one field lacks, in Euclidean norms; impulses as rates."""

    norm: float  # of found - guess
    allowed: float  # the largest that counts as converged
    relative: float  # to the field's own norm, 0 where both are

    @property
    def converged(self) -> bool:
        """Whether the field agrees; numbers too large for a norm never do."""
        return self.norm <= self.allowed < math.inf


class ConvergenceMeasure:
    """Relative and absolute tolerances, of which the wider holds, field by field.

    Parameters
    ----------
    tolerance : float, 1
        Of the field's norm.
    absolute : mapping of "component.port.field" to float, in the unit of the field's rate
        Of the residual's root mean square.
    is_impulse : callable
        Whether a taker's field is an integral over the window.
    """

    def __init__(
        self,
        tolerance: float,
        absolute: Mapping[str, float],
        is_impulse: Callable[[str, str], bool],
    ) -> None:
        self.tolerance, self.absolute, self.is_impulse = tolerance, absolute, is_impulse
        self.largest: dict[Key, float] = {}  # norms so far, of repetitions that agreed

    def compare(self, guess: Guess, result: Guess, length: float) -> dict[Key, Residual]:
        """Residual of each field, after one repetition of a window of a length [s]."""
        spans = {key: length if self.is_impulse(*key) else 1.0 for key in result}
        norms = {key: norm(array) / spans[key] for key, array in result.items()}
        rounding = ROUNDING * max(norms.values(), default=0.0)
        residuals = {}
        for key in result:
            least = max(norms[key], FLOOR * self.largest.get(key, 0.0))
            lack = norm(result[key] - guess[key]) / spans[key]
            mean = self.absolute.get(".".join(key), 0.0)
            wide = mean * math.sqrt(result[key].size)
            allowed = max(self.tolerance * least, wide, rounding)
            share = lack / least if least else math.inf
            residuals[key] = Residual(lack, allowed, share if lack else 0.0)
        if converged(residuals):  # a guess that overshot sets no floor for the windows after it
            for key, size in norms.items():
                self.largest[key] = max(self.largest.get(key, 0.0), size)
        return residuals

    def save(self) -> dict[str, Array]:
        """The largest norms, for a snapshot."""
        return {"/".join(key): np.array([size]) for key, size in self.largest.items()}

    def load(self, state: Fields) -> None:
        """Come back to them."""
        self.largest = {}
        for path, size in state.items():
            name, _, field = path.partition("/")
            self.largest[name, field] = float(size[0])


def converged(residuals: Mapping[Key, Residual]) -> bool:
    """Whether every field agrees."""
    return all(residual.converged for residual in residuals.values())


def allowed(residuals: Mapping[Key, Residual]) -> dict[Key, float]:
    """What convergence allows each field, for the scales of an acceleration."""
    return {key: residual.allowed for key, residual in residuals.items()}
