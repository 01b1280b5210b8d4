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
