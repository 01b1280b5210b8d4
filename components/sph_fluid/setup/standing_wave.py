"""A standing wave to start from: level water in the velocity field of linear theory.

Lamb, Hydrodynamics (1932), articles 228 and 348, for water of depth d above z = 0, k = 2π/λ:

    η  = A cos kx sin ωt                                      elevation
    φ  = (A g/ω) cosh kz / cosh kd · cos kx cos ωt            potential; u = ∇φ
    ω² = g k tanh kd                                          frequency
    A ~ e^{-2νk²t}                                            amplitude, ν small

At t = 0 the surface is level and rises at x = 0, the lower end of the water.
"""

import math

import numpy as np
from numpy.typing import NDArray

from quintet.interfaces.params import Positive, Vector, parameters

Array = NDArray[np.float64]
ROUNDING = 1e-6  # of a length


@parameters
class StandingWave:
    """A standing wave along x.

    Parameters
    ----------
    amplitude : m
        A.
    length : m
        λ, of which whole halves make up the water's extent along x.
    """

    amplitude: Positive
    length: Positive

    def check(self, boxes: tuple[tuple[Vector, Vector], ...], gravity: Vector) -> None:
        """Refuse water on which the wave cannot stand."""
        if gravity[0] or gravity[1] or not gravity[2] < 0.0:
            raise ValueError(f"wave needs gravity along -z; found {gravity} m/s2. Turn it.")
        if len(boxes) != 1:
            raise ValueError(f"wave needs one box of fluid; found {len(boxes)}. Join them.")
        (low, *_), (high, *_) = boxes[0]
        halves = 2.0 * (high - low) / self.length
        if round(halves) < 1 or abs(halves - round(halves)) > ROUNDING * halves:
            raise ValueError(
                "wave.length must divide the fluid's extent along x into whole half waves; found "
                f"{halves:.4g} in {high - low:.4g} m. Use 2 · extent / n."
            )

    def frequency(self, depth: float, g: float) -> float:
        """ω [rad/s]."""
        number = 2.0 * math.pi / self.length
        return math.sqrt(g * number * math.tanh(number * depth))

    def velocity(self, points: Array, box: tuple[Vector, Vector], gravity: Vector) -> Array:
        """Velocity (n, 3) m/s at points (n, 3) m at t = 0."""
        low, depth, g = np.array(box[0]), box[1][2] - box[0][2], -gravity[2]
        number = 2.0 * math.pi / self.length
        size = self.amplitude * g * number / self.frequency(depth, g)
        along, up = number * (points[:, 0] - low[0]), number * (points[:, 2] - low[2])
        velocities = np.zeros_like(points)
        velocities[:, 0] = -size * np.cosh(up) / math.cosh(number * depth) * np.sin(along)
        velocities[:, 2] = size * np.sinh(up) / math.cosh(number * depth) * np.cos(along)
        return velocities
