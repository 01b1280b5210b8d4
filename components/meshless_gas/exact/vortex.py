"""An isentropic vortex that drifts through a periodic box. Shu, ICASE report 97-65 (1997)."""

import numpy as np

from quintet.components.meshless_gas.params import MeshlessGasParams
from quintet.interfaces.component import Array


def states(params: MeshlessGasParams, positions: Array, time: float) -> Array:
    """States (n, 5) kg/m3, m/s, Pa of nodes at a time [s].

    δv = β/2π exp((1 - r²)/2) (z, -x)/a, δ(p/ρ) = -(γ - 1)/(2γ) (β/2π)² exp(1 - r²), of equal
    entropy; r over the radius a.
    """
    vortex, box, gamma = params.vortex, params.box, params.gas.gamma
    assert vortex is not None and params.initial is not None and box is not None
    density, u, v, w, pressure = params.initial.primitive(params.gas)
    x, z = (
        _wrapped(positions[:, d] - vortex.centre[d] - speed * time, box.highest[d] - box.lowest[d])
        / vortex.radius
        for d, speed in ((0, u), (2, w))
    )
    square = x * x + z * z
    swirl = vortex.strength / (2.0 * np.pi) * np.exp(0.5 * (1.0 - square))
    cold = 0.5 * (gamma - 1.0) / gamma * swirl * swirl * density / pressure
    ratio = (1.0 - cold) ** (1.0 / (gamma - 1.0))
    found = np.empty((len(positions), 5))
    found[:, 0], found[:, 4] = density * ratio, pressure * ratio * (1.0 - cold)
    found[:, 1], found[:, 2], found[:, 3] = u + swirl * z, v, w - swirl * x
    return found


def _wrapped(x: Array, length: float) -> Array:
    """Nearest of all images."""
    return np.asarray(x - length * np.round(x / length))
