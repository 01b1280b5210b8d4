"""Laws of supersonic flow round blunt bodies: shocks, stagnation points, drag and heat.

Papers: Billig, J. Spacecr. Rockets 4 (1967) 822; Fay & Riddell, J. Aeronaut. Sci. 25 (1958) 73;
Rayleigh, Proc. R. Soc. A 84 (1910) 247.
"""

import math
from typing import NamedTuple

import numpy as np

from quintet.interfaces.component import Array


class ShockShape(NamedTuple):
    """Numbers of a correlation for the bow shock of a sphere or a cylinder."""

    distance: float
    fall: float
    roundness: float
    rise: float
    power: float


SPHERE = ShockShape(0.143, 3.24, 1.143, 0.54, 1.2)
CYLINDER = ShockShape(0.386, 4.67, 1.386, 1.8, 0.75)


def normal_shock(mach: float, gamma: float) -> tuple[float, float]:
    """Ratios of density and pressure across a normal shock.

    References
    ----------
    Rankine-Hugoniot; Anderson, Modern Compressible Flow, eqs. (3.53) and (3.57).
    """
    square = mach * mach
    density = (gamma + 1.0) * square / ((gamma - 1.0) * square + 2.0)
    pressure = 1.0 + 2.0 * gamma / (gamma + 1.0) * (square - 1.0)
    return density, pressure


def pitot_pressure(mach: float, gamma: float) -> float:
    """Pressure behind a normal shock, brought to rest, over the static one ahead of it.

    References
    ----------
    Rayleigh, Proc. R. Soc. A 84 (1910) 247.
    """
    square = mach * mach
    if mach < 1.0:
        return float((1.0 + 0.5 * (gamma - 1.0) * square) ** (gamma / (gamma - 1.0)))
    above = (gamma + 1.0) ** 2 * square / (4.0 * gamma * square - 2.0 * (gamma - 1.0))
    shock = (1.0 - gamma + 2.0 * gamma * square) / (gamma + 1.0)
    return float(above ** (gamma / (gamma - 1.0)) * shock)


def standoff(mach: float, shape: ShockShape = SPHERE) -> float:
    """Distance of the bow shock over the radius, by Billig's fit."""
    return shape.distance * math.exp(shape.fall / mach**2)


def shock_radius(angle: Array, mach: float, shape: ShockShape = SPHERE) -> Array:
    """Distance of the bow shock from the body's centre over its radius.

    Parameters
    ----------
    angle : (n,), rad
        From the direction against the flow; beyond what the shock reaches: infinite.
    mach : float
    shape : ShockShape

    Returns
    -------
    (n,)

    References
    ----------
    Billig, J. Spacecr. Rockets 4 (1967) 822: a hyperbola with the Mach angle as asymptote.
    """
    vertex = 1.0 + standoff(mach, shape)
    curvature = shape.roundness * math.exp(shape.rise / (mach - 1.0) ** shape.power)
    # x = vertex - R_c cot²β [√(1 + y² tan²β / R_c²) - 1] along r (cos θ, sin θ): a quadratic in r
    tangent = math.tan(math.asin(1.0 / mach))
    slope = tangent * tangent
    cosine, sine = np.cos(angle), np.sin(angle)
    shift = vertex + curvature / slope
    a = cosine**2 - sine**2 / slope
    b = -2.0 * shift * cosine
    c = shift**2 - (curvature / slope) ** 2
    root = np.sqrt(np.maximum(b * b - 4.0 * a * c, 0.0))
    with np.errstate(divide="ignore", invalid="ignore"):
        near = 2.0 * c / (-b + root)
    return np.where(near > 0.0, near, np.inf)


class Stream(NamedTuple):
    """A free stream of a perfect gas, and a wall."""

    mach: float
    pressure: float  # Pa
    temperature: float  # K
    gamma: float
    gas_constant: float  # J/kg/K
    prandtl: float
    sutherland: tuple[float, float, float]  # Pa s at K, and Sutherland's temperature K

    @property
    def density(self) -> float:
        """Density [kg/m3]."""
        return self.pressure / (self.gas_constant * self.temperature)


def viscosity(temperature: float, sutherland: tuple[float, float, float]) -> float:
    """Dynamic viscosity [Pa s] by Sutherland's law."""
    at, reference, constant = sutherland
    ratio = temperature / reference
    return at * ratio * math.sqrt(ratio) * (reference + constant) / (temperature + constant)


def fay_riddell(stream: Stream, radius: float, wall: float) -> float:
    """Heat flux at the stagnation point of a sphere of a gas that does not dissociate.

    Parameters
    ----------
    stream : Stream
    radius : float, m
    wall : float, K
        The wall's temperature.

    Returns
    -------
    float, W/m2

    References
    ----------
    Fay & Riddell, J. Aeronaut. Sci. 25 (1958) 73, eq. (63) with Lewis number 1 and the velocity
    gradient of Newtonian theory.
    """
    gamma, r = stream.gamma, stream.gas_constant
    heat = gamma * r / (gamma - 1.0)
    total = stream.temperature * (1.0 + 0.5 * (gamma - 1.0) * stream.mach**2)
    edge_pressure = stream.pressure * pitot_pressure(stream.mach, gamma)
    edge_density, wall_density = edge_pressure / (r * total), edge_pressure / (r * wall)
    edge = edge_density * viscosity(total, stream.sutherland)
    near = wall_density * viscosity(wall, stream.sutherland)
    gradient = math.sqrt(2.0 * (edge_pressure - stream.pressure) / edge_density) / radius
    transfer = 0.763 * stream.prandtl**-0.6 * edge**0.4 * near**0.1 * math.sqrt(gradient)
    return transfer * heat * (total - wall)
