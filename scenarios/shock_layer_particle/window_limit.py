"""Longest window for a light sphere in gas at rest.

    python -m quintet.scenarios.shock_layer_particle.window_limit RATIO...

RATIO is the density of the sphere over that of the gas. One that begins to move at t = 0 is held
back by Z v exp(-at/R) cos(at/R), Z = 4/3 π R² ρ a: Longhorn, Q. J. Mech. Appl. Math. 5 (1952) 64.
The gas is told a velocity for a window and gives back the mean force in it, which the sphere takes
for the next: v[n+1] = v[n] - w Z/m Σ_j (v[n-j] - v[n-j-1]) K_j.
"""

import sys

import numpy as np

RATE = -1.0 + 1.0j  # times a/R
WINDOWS = 200  # that are remembered


def growth(window: float, ratio: float) -> float:
    """Greatest factor per window of a velocity; `window` in R/a."""
    window_numbers = np.arange(min(WINDOWS, int(12.0 / window) + 2))
    whole = np.exp(RATE * window * window_numbers) * np.expm1(RATE * window) / RATE
    shares = whole.real / window  # K_j
    # z^(J+1) + w Z/m Σ_j K_j z^(J-j) = 0, without the root z = 1 of a sphere that coasts.
    return float(np.abs(np.roots(np.concatenate([[1.0], window / ratio * shares]))).max())


def longest(ratio: float) -> float:
    """Longest window in R/a at which velocities do not grow; infinite above half the density."""
    low, high = ratio, 20.0
    if growth(high, ratio) <= 1.0:
        return float("inf")
    while high - low > 1e-3 * high:
        middle = float(np.sqrt(low * high))
        low, high = (middle, high) if growth(middle, ratio) <= 1.0 else (low, middle)
    return low


if __name__ == "__main__":
    for text in sys.argv[1:]:
        print(f"density ratio {text}: {longest(float(text)):.3f} R/a")
