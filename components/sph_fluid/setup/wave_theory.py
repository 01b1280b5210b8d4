"""Theory of waves and wave makers on water of a level bottom, to second order.

Waves run along x > 0 from a paddle whose displacement is f(z) X(t), f = 1 at still water, z = 0,
and f = 1 + z/D above the depth D of a hinge, 0 below it; without a hinge f = 1. To first order
(Biésel 1951; Dean & Dalrymple (1991), ch. 6), with X = A sin ωt,

    η = A Σ_j Im(i c_j e^{i(ωt - k_j x)}),  ω² = g k_j tanh k_j h,
    c_j = ω²/(g k_j) cosh k_j h ∫f cosh k_j(z+h) dz / ∫cosh² k_j(z+h) dz,

where k_0 is the wave's and k_j = -iκ_j, j > 0, belong to the evanescent modes beside the paddle.

To second order (Schäffer, Ocean Eng. 23 (1996) 47) products of two modes force waves at 2ω, and
what these, and the paddle's displacement from x = 0, lack of the paddle's velocity leaves as a free
wave of 2ω, of another speed. The paddle's motion at 2ω that makes this free wave vanish tends to
that of Madsen (J. Geophys. Res. 76 (1971) 8672) in long waves, to which the DualSPHysics code keeps
(Altomare et al., Coast. Eng. 127 (2017) 37).
"""

import cmath
import math
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from quintet.interfaces.component import Array

MODES = 40  # evanescent modes
NODES = 400  # of Gauss and Legendre over the depth
ITERATIONS = 60
BREAKING = 0.142  # steepness H/L tanh⁻¹(kh) at which regular waves break (Miche 1944)


@lru_cache(maxsize=1)
def _gauss_nodes() -> tuple[Array, Array]:
    """Nodes and weights (n,) of Gauss and Legendre from -1 to 1."""
    return np.polynomial.legendre.leggauss(NODES)


class Paddle(NamedTuple):
    """A paddle in water of a depth."""

    depth: float  # m, of the water
    hinge: float | None  # m, depth of its hinge below still water; None: it is displaced as a whole
    gravity: float  # m/s2

    def shape(self, z: Array) -> Array:
        """Displacement f (n,) at heights (n,) m above still water, over that at still water."""
        if self.hinge is None:
            return np.ones_like(z)
        return np.asarray(np.maximum(1.0 + z / self.hinge, 0.0))

    def slope(self, z: Array) -> Array:
        """Its derivative (n,) 1/m."""
        if self.hinge is None:
            return np.zeros_like(z)
        return np.where(z > -self.hinge, 1.0 / self.hinge, 0.0)

    @property
    def nodes(self) -> tuple[Array, Array]:
        """Heights (n,) m and weights (n,) m of an integral over the depth, split at a kink."""
        x, weight = _gauss_nodes()
        kink = -self.depth if self.hinge is None else max(-self.hinge, -self.depth)
        parts = [(-self.depth, kink), (kink, 0.0)] if kink > -self.depth else [(kink, 0.0)]
        heights = [0.5 * (a + b) + 0.5 * (b - a) * x for a, b in parts]
        return np.concatenate(heights), np.concatenate([0.5 * (b - a) * weight for a, b in parts])


def wave_number(omega: float, depth: float, gravity: float) -> float:
    """Wave number k [1/m] of an angular frequency [1/s]: ω² = g k tanh(k h)."""
    deep = omega * omega * depth / gravity
    y = deep / math.sqrt(math.tanh(deep))  # Eckart's k h, within 5 %
    for _ in range(ITERATIONS):
        t = math.tanh(y)
        change = (y * t - deep) / (t + y * (1.0 - t * t))
        y -= change
        if abs(change) <= 1e-15 * y:
            break
    return y / depth


def modes(omega: float, paddle: Paddle, count: int = MODES) -> Array:
    """Wave numbers (1 + count,) 1/m, complex: the wave's, and -iκ of evanescent modes."""
    ratio = omega * omega * paddle.depth / paddle.gravity
    numbers = [complex(wave_number(omega, paddle.depth, paddle.gravity))]
    for j in range(1, count + 1):
        # -κh tan κh = ω²h/g has one root from (j - ½)π to jπ: κh = jπ - arctan(ratio / κh).
        y = j * math.pi
        for _ in range(ITERATIONS):
            y = j * math.pi - math.atan(ratio / y)
        numbers.append(-1j * y / paddle.depth)
    return np.array(numbers)


def transfer(omega: float, paddle: Paddle, count: int = MODES) -> tuple[Array, Array]:
    """Wave numbers k (1 + count,) 1/m and factors c (1 + count,) of the wave and other modes.

    The height of the wave is c_0 times the paddle's stroke at still water.
    """
    k = modes(omega, paddle, count)
    z, weight = paddle.nodes
    f = weight * paddle.shape(z)
    factors = []
    for number in k.tolist():
        profile = _profile(number, z, paddle.depth)  # cosh k(z + h) / cosh kh
        ratio = (f * profile).sum() / (weight * profile * profile).sum()
        factors.append(omega * omega / (paddle.gravity * number) * ratio)
    return k, np.array(factors)


def _profile(k: complex, z: Array, depth: float, sign: float = 1.0) -> Array:
    """Profile cosh k(z + h) / cosh kh (n,) without overflow; with a sign of -1 sinh / cosh."""
    rise, whole = np.exp(k * z), cmath.exp(-2.0 * k * depth)
    return np.asarray(rise * (1.0 + sign * np.exp(-2.0 * k * (z + depth))) / (1.0 + whole))


def bound_amplitude(height: float, k: float, depth: float) -> float:
    """Amplitude [m] of the second harmonic of a Stokes wave of a height [m]; Dean & Dalrymple."""
    t = math.tanh(k * depth)
    return height * height * k / 16.0 * (3.0 - t * t) / t**3


def second_order(amplitude: float, omega: float, paddle: Paddle) -> complex:
    """Y [m] of Im(Y e^{2iωt}), that a paddle's motion A sin ωt lacks to make no free wave of 2ω.

    Parameters
    ----------
    amplitude : float, m
        A, at still water.
    omega : float, 1/s
    paddle : Paddle
    """
    g, h = paddle.gravity, paddle.depth
    k, factors = transfer(omega, paddle)
    # With X = Re(A e^{iωt}): η_j = i A c_j, φ_j = i g η_j / ω at x = 0 and z = 0.
    phi = 1j * g / omega * (1j * amplitude * factors)
    free = wave_number(2.0 * omega, h, g)
    z, weight = paddle.nodes
    test = weight * _profile(complex(free), z, h).real
    f, slope, nu = paddle.shape(z), paddle.slope(z), omega * omega / g
    remainder = 0.0j
    for number, phase in zip(k.tolist(), phi.tolist(), strict=True):
        profile = _profile(number, z, h)
        rise = number * _profile(number, z, h, -1.0)
        moved = slope * rise + f * number * number * profile
        remainder += 0.5 * amplitude * phase * (test * moved).sum()
    sums = k[:, np.newaxis] + k  # wave numbers of the waves forced by pairs of modes
    squares = k * k
    forcing = 0.5j * omega * phi[:, np.newaxis] * phi
    forcing *= 0.5 * (squares[:, np.newaxis] + squares) + 2.0 * k[:, np.newaxis] * k - 3.0 * nu * nu
    level = sums * np.tanh(sums * h)
    bound = forcing / (g * level - 4.0 * omega * omega)
    # ∫ cosh K(z+h) cosh k(z+h) dz over both values at z = 0, with 4ω² = g k tanh kh.
    shared = (level - free * math.tanh(free * h)) / (sums * sums - free * free)
    remainder += (1j * sums * bound * shared).sum()
    # Of X = A sin ωt, a quarter of a period later, and in Im(Y e^{2iωt}).
    return complex(remainder / (2.0 * omega * (test * f).sum()))
