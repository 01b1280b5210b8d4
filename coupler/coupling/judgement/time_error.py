"""The error that the coupling makes in time, estimated from windows that were stepped twice.

A window is stepped as it counts, and in `PIECES` shorter ones. For a scheme of first order, whose
error in a window of length h is C h², the pieces have C h²/4, so that both differ by three quarters
of it; for one of second order by fifteen sixteenths (Hairer, Nørsett and Wanner, Solving Ordinary
Differential Equations I, II.4: step size control by extrapolation).

Two estimates are made of the differences, relative to what a field changes in the run:

- local: the size of the differences, whatever their direction; with the noise of particles and
  contacts, which adds up to nothing in a run;
- bias: their part along the change, where it has the same sign from window to window: what makes a
  load too large in every window, or delays a motion. Of a motion to and fro it adds up over the
  whole way, to the drift.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from quintet.coupler.coupling.saved_values import attributes_like, like
from quintet.interfaces.component import Array
from quintet.interfaces.sums import dot, norm

PIECES = 4
EVERY = 512  # windows between two that are looked at, in long runs
NEGLIGIBLE = 1e-7  # of a field's magnitude: what changes by less in all is rounding
COHERENT = 0.7  # mean over root mean square, of errors of one sign from sample to sample
SIGNIFICANT = 3.0  # standard deviations of a mean of many samples that is no noise
Key = tuple[str, str]  # component and field


@dataclass(slots=True)
class Sample:
    """What one window and its pieces came to, for one field.

    Parameters
    ----------
    difference, change : of the field
        Norms of the difference at the window's end, and of the change in the window; of an impulse
        of the impulse itself.
    along : 1
        The difference along the change, over the change.
    magnitude : of the field
        Norm of the field.
    low, high : (n, ...) arrays or None
        Least and largest values at the window's two ends; None of impulses.
    """

    difference: float
    change: float
    along: float
    magnitude: float
    low: Array | None = None
    high: Array | None = None


@dataclass(slots=True)
class FieldError:
    """What was found of one field so far, each sample weighted by the windows it stands for."""

    difference: float = 0.0
    change: float = 0.0
    along: float = 0.0
    squares: float = 0.0  # of changes
    magnitude: float = 0.0  # the largest
    relative: float = 0.0  # sums over samples of `Sample.along` and of its square
    relative_squares: float = 0.0
    samples: int = 0
    low: Array = field(default_factory=lambda: np.zeros(0))
    high: Array = field(default_factory=lambda: np.zeros(0))

    def add(self, weight: int, sample: Sample) -> None:
        """Add a window that stands for so many."""
        self.difference += weight * sample.difference
        self.change += weight * sample.change
        self.along += weight * sample.along * sample.change**2
        self.relative += sample.along
        self.relative_squares += sample.along**2
        self.squares += weight * sample.change**2
        self.magnitude = max(self.magnitude, sample.magnitude)
        if sample.low is not None and sample.high is not None:
            self.low = np.minimum(self.low, sample.low) if self.samples else sample.low
            self.high = np.maximum(self.high, sample.high) if self.samples else sample.high
        self.samples += 1

    @property
    def local(self) -> float:
        """Error of the windows, relative to what the field changes in them."""
        if self.change <= NEGLIGIBLE * self.magnitude:
            return 0.0
        return self.difference / self.change

    @property
    def motion(self) -> float:
        """Error of a motion: local, or added up over its way."""
        return max(self.local, self.drift)

    @property
    def bias(self) -> float:
        """Error along the change, relative to it, if it has one sign from sample to sample."""
        scatter = math.sqrt(self.relative_squares)
        needed = min(COHERENT * math.sqrt(self.samples), SIGNIFICANT) * scatter
        if self.change <= NEGLIGIBLE * self.magnitude or not abs(self.relative) >= needed > 0.0:
            return 0.0
        return abs(self.along) / self.squares

    @property
    def drift(self) -> float:
        """Bias of a motion added up over its way, relative to its range."""
        extent = self.extent
        return self.bias * max(1.0, self.change / extent) if extent > 0.0 else 0.0

    @property
    def extent(self) -> float:
        """Norm of the range that a motion had at the ends of the windows looked at."""
        return norm(self.high - self.low)


class TimeErrors:
    """Estimates for all fields, over the windows looked at so far."""

    def __init__(self) -> None:
        self.fields: dict[Key, FieldError] = {}
        self.window = 0  # number of the last one that was looked at, from 1
        self.due = False  # whether the next window that can be is to be looked at
        self.skipped = ""  # why no more windows are looked at

    def add(self, window: int, samples: Mapping[Key, Sample]) -> None:
        """Add a window, by its number from 1."""
        weight = window - self.window
        self.window = window
        for key, sample in samples.items():
            if math.isfinite(sample.difference + sample.change):
                self.fields.setdefault(key, FieldError()).add(weight, sample)

    def save(self) -> dict[str, Any]:
        """All of it, for a snapshot."""
        fields = {
            key: {name: getattr(error, name) for name in FieldError.__slots__}
            for key, error in self.fields.items()
        }
        flags = {"due": self.due, "skipped": self.skipped}
        return {"window": self.window, **flags, "fields": fields}

    def load(self, state: Mapping[str, Any]) -> None:
        """Come back to what was saved."""
        self.window = like(0, state["window"])
        self.due, self.skipped = like(False, state["due"]), like("", state["skipped"])
        self.fields = {
            key: FieldError(**attributes_like(FieldError(), values))
            for key, values in state["fields"].items()
        }
        if any(error.low.shape != error.high.shape for error in self.fields.values()):
            raise ValueError("the ends of a range must have one shape")

    def summary(self) -> list[dict[str, Any]]:
        """What ``results.json`` has of it."""
        return [
            {
                "component": name,
                "field": path,
                "local": error.local,
                "bias": error.bias,
                "drift": error.drift,
                "samples": error.samples,
            }
            for (name, path), error in self.fields.items()
        ]


def is_sampled(window: int) -> bool:
    """Whether a window is looked at, by its number from 1: powers of 2, and one in `EVERY`."""
    return window % EVERY == 0 or window & (window - 1) == 0


def sample(whole: Array, pieces: Array, start: Array | None, kind: str) -> Sample:
    """Compare a field after a window with the same after its pieces.

    Parameters
    ----------
    whole, pieces : (n, ...) arrays
        At the end of the window as it counts, and in pieces; impulses of the window.
    start : (n, ...) array or None
        At its start; None of impulses.
    kind : str
        Of the field (`Field.kind`); q and -q are the same rotation.
    """
    if kind == "rotation":
        pieces = same_branch(whole, pieces)
        start = None if start is None else same_branch(whole, start)
    difference = whole - pieces
    change = whole if start is None else whole - start
    size = norm(change)
    along = dot(difference, change) / size**2 if size**2 > 0.0 else 0.0
    ends = (None, None) if start is None else (np.minimum(start, whole), np.maximum(start, whole))
    return Sample(norm(difference), size, along, norm(whole), *ends)


def same_branch(ahead: Array, rotation: Array) -> Array:
    """A rotation as the quaternion, of its two, that is nearer to another."""
    flipped = np.sum(ahead * rotation, axis=-1, keepdims=True) < 0.0
    return np.where(flipped, -rotation, rotation)
