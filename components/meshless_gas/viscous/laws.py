"""Slopes at a wall, and what a rarefied gas does there.

Papers: Maxwell, Phil. Trans. R. Soc. 170 (1879) 231; Smoluchowski, Ann. Phys. 300 (1898) 101;
Kennard, Kinetic Theory of Gases (1938), sections 178 and 181.
"""

import math

from numba import njit

from quintet.components.shared.numba_options import INNER


@njit(**INNER)
def wall_slope(at_wall, first, second, near, far):  # type: ignore[no-untyped-def]
    """Slope at a wall of the parabola through it and two values above it.

    Parameters
    ----------
    at_wall, first, second : float
        Values on the wall and at the two distances.
    near, far : float, m

    Returns
    -------
    float, 1/m times the value's unit
        Of first order where there is no second, 0 where there is none.
    """
    if not far > near:
        return (first - at_wall) / near if near > 0.0 else 0.0
    return ((first - at_wall) * far / near - (second - at_wall) * near / far) / (far - near)


@njit(**INNER)
def slope_shares(near, far):  # type: ignore[no-untyped-def]
    """Shares (3,) 1/m of the values at the wall and at two distances in `wall_slope`."""
    if not far > near:
        return (-1.0 / near, 1.0 / near, 0.0) if near > 0.0 else (0.0, 0.0, 0.0)
    first, second = far / near / (far - near), -near / far / (far - near)
    return -first - second, first, second


@njit(**INNER)
def mean_free_path(viscosity, pressure, temperature, gas_constant):  # type: ignore[no-untyped-def]
    """Mean free path λ = μ/p √(π R T/2) of a gas.

    Parameters
    ----------
    viscosity : float, Pa s
    pressure : float, Pa
    temperature : float, K
    gas_constant : float, J/(kg K)

    Returns
    -------
    float, m

    References
    ----------
    Maxwell, Phil. Trans. R. Soc. 170 (1879) 231.
    """
    return viscosity / pressure * math.sqrt(0.5 * math.pi * gas_constant * temperature)


def slip_length(momentum: float) -> float:
    """Slip velocity over λ ∂u/∂n, by the share of molecules that leave a wall in any direction.

    References
    ----------
    Maxwell, Phil. Trans. R. Soc. 170 (1879) 231: (2 - σ)/σ.
    """
    return (2.0 - momentum) / momentum


def jump_length(energy: float, gamma: float, prandtl: float) -> float:
    """Jump of temperature over λ ∂T/∂n, by the share of energy that is left at a wall.

    References
    ----------
    Smoluchowski, Ann. Phys. 300 (1898) 101; Kennard (1938), eq. (181): (2 - α)/α 2γ/(γ + 1)/Pr.
    """
    return (2.0 - energy) / energy * 2.0 * gamma / ((gamma + 1.0) * prandtl)
