"""An isentropic vortex that drifts through a periodic box. Shu, ICASE report 97-65 (1997)."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from quintet.interfaces.component import Array


class Drift(NamedTuple):
    """A vortex and the stream that carries it."""

    centre: Sequence[float]  # (3,) m, at the start
    strength: float  # m/s
    radius: float  # m
    stream: Sequence[float]  # (5,) kg/m3, m/s, Pa
    lengths: Array  # (3,) m, of the box
    gamma: float  # 1


def states(vortex: Drift, positions: Array, time: float) -> Array:
    """States (n, 5) kg/m3, m/s, Pa of nodes at a time [s].

    δv = β/2π exp((1 - r²)/2) (z, -x)/a, δ(p/ρ) = -(γ - 1)/(2γ) (β/2π)² exp(1 - r²), of equal
    entropy; r over the radius a.
    """
    (density, u, v, w, pressure), gamma = vortex.stream, vortex.gamma
    x, z = (
        _wrapped(positions[:, d] - vortex.centre[d] - speed * time, vortex.lengths[d])
        / vortex.radius
        for d, speed in ((0, u), (2, w))
    )
    square = x * x + z * z
    swirl = vortex.strength / (2.0 * np.pi) * np.exp(0.5 * (1.0 - square))
    cold = 0.5 * (gamma - 1.0) / gamma * swirl * swirl * density / pressure
    ratio = (1.0 - cold) ** (1.0 / (gamma - 1.0))
    exact = np.empty((len(positions), 5))
    exact[:, 0], exact[:, 4] = density * ratio, pressure * ratio * (1.0 - cold)
    exact[:, 1], exact[:, 2], exact[:, 3] = u + swirl * z, v, w - swirl * x
    return exact


def _wrapped(x: Array, length: float) -> Array:
    """Nearest of all images."""
    return np.asarray(x - length * np.round(x / length))
