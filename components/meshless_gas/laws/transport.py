"""Transport in a perfect gas.

Papers: Sutherland, Phil. Mag. 36 (1893) 507.
"""

import math
from typing import NamedTuple

from numba import njit

from quintet.components.shared.numba_options import INNER


class Transport(NamedTuple):
    """Numbers of viscosity and conduction."""

    viscosity: float  # Pa s, at the reference temperature
    reference: float  # K
    sutherland: float  # K; negative: the viscosity is constant
    conduction: float  # J/kg/K, c_p / Pr: conductivity over viscosity
    gas_constant: float  # J/kg/K


def fastest_spread(law: Transport, gamma: float) -> Transport:
    """Law whose conduction spreads heat no slower than friction spreads waves of compression.

    These spread with 4/3 μ/ρ, heat with γ μ/(Pr ρ): with a Prandtl number above 3/4 γ slower.
    """
    heat = gamma * law.gas_constant / (gamma - 1.0)  # J/(kg K), c_p
    return law._replace(conduction=max(law.conduction, 4.0 / 3.0 * heat / gamma))


@njit(**INNER)
def sutherland(temperature, law):  # type: ignore[no-untyped-def]
    """Dynamic viscosity of a gas.

    Parameters
    ----------
    temperature : float, K
    law : Transport

    Returns
    -------
    float, Pa s

    References
    ----------
    Sutherland, Phil. Mag. 36 (1893) 507.
    """
    if law.sutherland < 0.0:
        return law.viscosity
    ratio = temperature / law.reference
    rise = (law.reference + law.sutherland) / (temperature + law.sutherland)
    return law.viscosity * ratio * math.sqrt(ratio) * rise
