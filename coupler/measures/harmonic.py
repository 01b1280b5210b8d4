"""Harmonics of a known period in a curve, in least squares, with a mean.

What a wave of known period makes swing, as a floating body, answers with that period; its amplitude
is that of the first harmonic. Two overtones are fitted beside it, and a drift at constant speed, so
that the amplitude is the same where a curve ends between two periods, or drifts away.
"""

import math

import numpy as np

from quintet.coupler.measures.time_series import Curve
from quintet.interfaces.component import Array

HARMONICS = 3  # that are fitted in time
CYCLES = 0.99  # that a curve must hold
VALUES = 4 * HARMONICS  # that it must have in a period


def fit_harmonics(curve: Curve, period: float, *, drifts: bool = False) -> Array | None:
    """Mean, cosines and sines (1 + 2n, k) of a curve, values (m, k); then its drift, if asked for.

    None if it holds less than a period, or has fewer than `VALUES` in each.
    """
    times = curve.times - curve.times[0]
    cycles = times[-1] / period
    if cycles < CYCLES or len(times) < VALUES * cycles:
        return None
    phases = 2.0 * math.pi * times / period
    terms = harmonics(phases)
    if drifts:
        terms = np.column_stack([terms, phases])
    return np.asarray(np.linalg.lstsq(terms, curve.values, rcond=None)[0])


def amplitude(curve: Curve, period: float) -> float:
    """Amplitude of the first harmonic of a curve, values (m,); nan where none can be fitted."""
    fitted = fit_harmonics(curve, period, drifts=True)
    return math.nan if fitted is None else math.hypot(float(fitted[1]), float(fitted[2]))


def harmonics(phases: Array) -> Array:
    """One, cosines and sines (m, 1 + 2n) of phases (m,) rad and of their multiples."""
    parts = [np.ones_like(phases)]
    for n in range(1, HARMONICS + 1):
        parts += [np.cos(n * phases), np.sin(n * phases)]
    return np.stack(parts, axis=1)
