"""Irregular waves: amplitudes and phases of components of a spectrum of the surface."""

import math

import numpy as np

from quintet.interfaces.component import Array

LOWEST, HIGHEST = 0.5, 3.0  # frequencies over that of the peak
WIDTHS = 0.07, 0.09  # of the JONSWAP peak, below and above its frequency


def jonswap(ratio: Array, enhancement: float) -> Array:
    """Spectral density (n,), not scaled, at frequencies (n,) over that of the peak.

    S ~ r⁻⁵ exp(-5/4 r⁻⁴) γ^exp(-(r - 1)²/2σ²) (Hasselmann et al. 1973); with γ = 1 the spectrum
    of Pierson & Moskowitz (1964).
    """
    width = np.where(ratio <= 1.0, *WIDTHS)
    peak = np.exp(-0.5 * ((ratio - 1.0) / width) ** 2)
    return np.asarray(ratio**-5.0 * np.exp(-1.25 * ratio**-4.0) * enhancement**peak)


def components(
    height: float, period: float, enhancement: float, count: int, seed: int
) -> tuple[Array, Array, Array]:
    """Amplitudes (n,) m, angular frequencies (n,) 1/s and phases (n,) rad of a sea.

    Bands of equal width from half to three times the frequency of the peak have one component
    each, at a random frequency in the band, so that the sea does not repeat; phases are random.
    Amplitudes √(2 S Δf) are scaled to the significant height: 4 √m₀ of all of them is exact.

    Parameters
    ----------
    height : float, m
        Significant height.
    period : float, s
        Of the peak.
    enhancement : float, 1
        γ of the peak.
    count, seed : int
    """
    random = np.random.default_rng(seed)
    place, phase = random.random(count), 2.0 * math.pi * random.random(count)
    ratio = LOWEST + (HIGHEST - LOWEST) * (np.arange(count) + place) / count
    amplitude = np.sqrt(jonswap(ratio, enhancement))
    amplitude *= height / 4.0 / math.sqrt(0.5 * float((amplitude**2).sum()))
    return amplitude, 2.0 * math.pi * ratio / period, phase
