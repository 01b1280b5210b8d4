"""Fracture: spall by the greatest principal stress, and damage of Johnson and Cook.

Papers: Johnson & Cook, Eng. Fract. Mech. 21 (1985) 31.
"""

import math

from numba import njit

from quintet.components.shared.materials.strength import equivalent
from quintet.components.shared.numba_options import INNER


@njit(**INNER)
def greatest_principal(s, pressure):  # type: ignore[no-untyped-def]
    """Greatest principal stress [Pa] of -p I + s, by the trigonometric solution."""
    xx, yy, zz, xy, yz, zx = s
    j2 = 0.5 * (xx * xx + yy * yy + zz * zz) + xy * xy + yz * yz + zx * zx
    if j2 <= 0.0:
        return -pressure
    j3 = xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * zx) + zx * (xy * yz - yy * zx)
    root = math.sqrt(j2 / 3.0)
    cosine = min(1.0, max(-1.0, 0.5 * j3 / (root * root * root)))
    return 2.0 * root * math.cos(math.acos(cosine) / 3.0) - pressure


@njit(**INNER)
def is_torn(s, pressure, limit):  # type: ignore[no-untyped-def]
    """Whether the greatest principal stress is above a limit [Pa]."""
    # It is at most 2/3 of the equivalent stress above the mean: most points need no more.
    if 2.0 / 3.0 * equivalent(s) - pressure <= limit:
        return False
    return greatest_principal(s, pressure) > limit


@njit(**INNER)
def damage_growth(s, pressure, delta, temperature, dt, law):  # type: ignore[no-untyped-def]
    """Damage that a plastic strain of a step does, Δ/ε_f; 0 of a material that takes none."""
    if law.d1 == 0.0 and law.d2 == 0.0:
        return 0.0
    stress = equivalent(s)
    triaxiality = -pressure / stress if stress > 0.0 else 0.0
    # Below 0 no strain is borne; of two factors below 0 the product would be above.
    strain = max(law.d1 + law.d2 * math.exp(law.d3 * triaxiality), 0.0)
    rate = delta / (dt * law.reference_rate)
    if rate > 1.0:
        strain *= max(1.0 + law.d4 * math.log(rate), 0.0)
    above = (temperature - law.reference_temperature) / law.melting
    strain *= max(1.0 + law.d5 * max(0.0, above), 0.0)
    return delta / max(strain, 1e-6)
