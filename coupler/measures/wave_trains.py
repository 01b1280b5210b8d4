"""Height, length and reflection of waves along a line, from levels at several places.

At each place the harmonic of a known period is fitted in least squares, with two overtones and a
mean. Its complex amplitudes are those of two wave trains that run against each other,

    B(x) = A e^{-ikx} + R e^{ikx},

in least squares over the places (Mansard & Funke, Proc. 17th Int. Conf. Coast. Eng. (1980) 154;
with two places Goda & Suzuki, Proc. 15th (1976) 828). Where k is not known it is the one that fits
best; this needs three places. There is no value where the trains cannot be told apart: where all
places lie about multiples of half a length apart (Goda & Suzuki ask for a distance of 0.05 to 0.45
lengths), or where the length that fits best is an end of those tried.

The height, from trough to crest, is that of the fitted curve at each place, with its overtones,
times |A|/|B|; its mean over the places, with weights |B|², counts, since near a node of standing
waves overtones are all that is seen.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from pydantic import NonNegativeInt

from quintet.coupler.measures.harmonic import fit_harmonics, harmonics
from quintet.coupler.measures.time_series import Curve
from quintet.interfaces.component import Array
from quintet.interfaces.params import Number, Positive, parameters

FEWEST = 2  # places; 3 where the length is sought
PHASES = 720  # of a period, at which the fitted curve is looked at
APART = 0.3  # |sin k dx| of the best two places: of a distance of 0.05 or 0.45 lengths 0.31
TRIALS = 400  # lengths that are looked at, before the best one is refined
SHARPENED = 60  # steps of the golden section
Complex = NDArray[np.complex128]


@parameters
class WaveLine:
    """Levels along a line in which waves run, for the measures of waves.

    Parameters
    ----------
    items : 1
        Numbers of the items, from 0.
    places : m
        Of each along the line, in the direction of the waves.
    period : s
        Of the waves.
    length : m
        Of the waves; if not given, the one that fits best.
    """

    items: tuple[NonNegativeInt, ...]
    places: tuple[Number, ...]
    period: Positive
    length: Positive | None = None

    def __post_init__(self) -> None:
        fewest = FEWEST if self.length else FEWEST + 1
        if len(self.items) < fewest or len(self.items) != len(self.places):
            raise ValueError(
                f"waves must have {fewest} items or more, and a place for each; found "
                f"{len(self.items)} items and {len(self.places)} places. Correct them."
            )
        if any(b <= a for a, b in zip(self.places, self.places[1:], strict=False)):
            raise ValueError(
                f"waves.places must increase; found {self.places} m. Put them in order."
            )


class Train(NamedTuple):
    """Two wave trains that run against each other; nan where no fit was found."""

    height: float  # of the train along the line, in the unit of the curves
    reflection: float  # amplitude of the other one over that of the first
    length: float  # m


NONE = Train(math.nan, math.nan, math.nan)


def fit(curves: Curve, line: WaveLine) -> Train:
    """Fit two wave trains to curves, values (m, k), at the places of a line."""
    fitted = fit_harmonics(curves, line.period)
    if fitted is None:
        return NONE
    amplitudes = fitted[1] - 1j * fitted[2]  # (k,) B
    places = np.array(line.places)
    length = line.length or _best_length(places, amplitudes)
    if math.isnan(length) or not _tell_apart(places, length):
        return NONE
    forth, back = _trains(places, amplitudes, length)[0].tolist()
    if not forth:
        return Train(0.0, math.nan, length)
    sizes = np.abs(amplitudes)
    height = abs(forth) * float(_ranges(fitted) @ sizes / (sizes @ sizes))
    return Train(height, abs(back) / abs(forth), length)


def _tell_apart(places: Array, length: float) -> bool:
    """Whether two of the places see waves of a length [m] in phases that differ enough."""
    distances = places[:, np.newaxis] - places
    return bool(np.abs(np.sin(2.0 * math.pi / length * distances)).max() >= APART)


def _ranges(fitted: Array) -> Array:
    """From the lowest to the highest value (k,) of harmonics with factors (1 + 2n, k)."""
    phases = np.linspace(0.0, 2.0 * math.pi, PHASES, endpoint=False)
    return np.asarray(np.ptp(harmonics(phases) @ fitted, axis=0))


def _trains(places: Array, amplitudes: Complex, length: float) -> tuple[Complex, float]:
    """A and R (2,) of a wave length [m], and the square of the misfit."""
    phase = 2j * math.pi / length * (places - places.mean())
    both = np.stack([np.exp(-phase), np.exp(phase)], axis=1)
    trains = np.asarray(np.linalg.lstsq(both, amplitudes, rcond=None)[0], np.complex128)
    misfit = amplitudes - both @ trains
    return trains, float((misfit * misfit.conj()).real.sum())


def _best_length(places: Array, amplitudes: Complex) -> float:
    """Length [m] that fits best, from twice the least to four times the whole distance.

    It is nan where one of these two fits best.
    """
    shortest, longest = 2.0 * float(np.diff(places).min()), 4.0 * float(np.ptp(places))
    numbers = np.linspace(1.0 / longest, 1.0 / shortest, TRIALS)
    misfits = [_trains(places, amplitudes, 1.0 / number)[1] for number in numbers]
    k = int(np.argmin(misfits))
    if k in (0, TRIALS - 1):
        return math.nan
    low, high = float(numbers[k - 1]), float(numbers[k + 1])
    golden = 0.5 * (math.sqrt(5.0) - 1.0)
    for _ in range(SHARPENED):
        inner = high - golden * (high - low), low + golden * (high - low)
        first, second = (_trains(places, amplitudes, 1.0 / number)[1] for number in inner)
        low, high = (low, inner[1]) if first < second else (inner[0], high)
    return 2.0 / (low + high)
