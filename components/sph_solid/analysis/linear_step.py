"""The step of a solid linearised at its state, and the largest Courant number that is stable.

Two steps from states that differ by ±δ give the derivative J of the step. The steepest wave leaves
the unit circle at -1, so that the eigenvalue of J - I that is largest by magnitude, found by power
iteration, is -2 at the limit. The step holds all of the scheme: the material, neighbours as they
lie, and viscosity with predicted velocities, which acts on pairs that come nearer: in a shock on
all pairs of a wave, at rest on half of them.
"""

import math

import numpy as np

from quintet.components.sph_solid.component import SphSolid
from quintet.components.sph_solid.state import Array

VARIED = (  # what a wave changes; strains and damage only follow it
    "position", "velocity", "acceleration", "heating", "deviator", "density_ratio", "pressure",
    "energy",
)  # fmt: skip
SMALL = 1e-6  # of the speed of sound: the velocities of δ
ITERATIONS, AVERAGED = 240, 40
BISECTIONS = 8
LEAST, MOST = 0.25, 8.0  # Courant numbers

Wave = dict[str, Array]


class LinearStep:
    """The step of a solid linearised at the state that it has now.

    Parameters
    ----------
    solid : SphSolid
        On one rank; its state is changed by every call.
    """

    def __init__(self, solid: SphSolid) -> None:
        state = solid.state
        if not solid.lists.are_for_good:  # lists that hold for the longest step from here
            solid.lists.sort(state, MOST * state.bound)
        self.before = state.save()
        solid.load(self.before)
        self.solid, self.speed = solid, SMALL * float(state.sound.max())
        extents = np.ptp(self.before["position"], axis=0)
        self.axes = extents > 0.0  # none across a plane

    def growth(self, dt: float) -> float:
        """Magnitude of the largest eigenvalue of J - I of a step of dt [s]; above 2 is unstable."""
        random = np.random.default_rng(0)
        wave = {name: np.zeros_like(self.before[name]) for name in VARIED}
        wave["velocity"] = random.normal(size=wave["velocity"].shape) * self.axes
        growths = []
        for _ in range(ITERATIONS):
            factor = self.speed / _greatest(wave)
            wave = self.change({name: factor * wave[name] for name in VARIED}, dt)
            growths.append(_greatest(wave) / self.speed)
        return float(np.exp(np.mean(np.log(growths[-AVERAGED:]))))

    def change(self, wave: Wave, dt: float) -> Wave:
        """(J - I) times a wave, for a step of dt [s]."""
        above, below = self._step(wave, 1.0, dt), self._step(wave, -1.0, dt)
        return {name: 0.5 * (above[name] - below[name]) - wave[name] for name in VARIED}

    def _step(self, wave: Wave, sign: float, dt: float) -> Wave:
        """State after a step from the state before, disturbed by a wave times a sign."""
        state = self.solid.state
        for name, value in self.before.items():
            if value.ndim:
                getattr(state, name)[...] = value  # in place: materials hold the arrays
            else:
                setattr(state, name, value.item())
        for name in VARIED:
            getattr(state, name)[...] += sign * wave[name]
        self.solid.step(dt)
        return {name: getattr(state, name).copy() for name in VARIED}


def largest_courant(solid: SphSolid) -> float:
    """Largest Courant number with which steps from the present state are stable."""
    bound = solid.state.bound
    step, low, high = LinearStep(solid), LEAST, MOST
    for _ in range(BISECTIONS):
        courant = math.sqrt(low * high)
        if step.growth(courant * bound) > 2.0:
            high = courant
        else:
            low = courant
    return math.sqrt(low * high)


def _greatest(wave: Wave) -> float:
    return float(np.abs(wave["velocity"]).max())
