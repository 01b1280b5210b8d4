"""Harmonics of a known period in a curve, in least squares, with a mean.

What a wave of known period makes swing, as a floating body, answers with that period; its amplitude
is that of the first harmonic. Two overtones are fitted beside it, so that a curve that holds no
whole number of periods gives the same amplitude.
"""

import math

import numpy as np

from quintet.coupler.measures.time_series import Curve
from quintet.interfaces.component import Array

HARMONICS = 3  # that are fitted in time
CYCLES = 0.99  # that a curve must hold


def factors(curve: Curve, period: float) -> Array | None:
    """Mean, cosines and sines (1 + 2n, k) of a curve, values (m, k); None of less than a period."""
    times = curve.times - curve.times[0]
    if len(times) < 4 * HARMONICS or times[-1] < CYCLES * period:
        return None
    omega = 2.0 * math.pi / period
    return np.asarray(np.linalg.lstsq(columns(omega * times), curve.values, rcond=None)[0])


def amplitude(curve: Curve, period: float) -> float:
    """Amplitude of the first harmonic of a curve, values (m,); nan of less than a period."""
    fitted = factors(curve, period)
    return math.nan if fitted is None else math.hypot(float(fitted[1]), float(fitted[2]))


def columns(phases: Array) -> Array:
    """One, cosines and sines (m, 1 + 2n) of phases (m,) rad and of their multiples."""
    parts = [np.ones_like(phases)]
    for n in range(1, HARMONICS + 1):
        parts += [np.cos(n * phases), np.sin(n * phases)]
    return np.stack(parts, axis=1)
