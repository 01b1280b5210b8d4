"""The numbers of one material, as kernels take them."""

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from quintet.components.shared.materials.equation_of_state import isentrope
from quintet.components.shared.materials.params import Material

ROWS = 513  # of the table of the isentrope's energy
LEAST = -1.0  # η at which the table begins: half the density
NEVER = 1e300  # kernels take every number to be finite


class Solid(NamedTuple):
    """One material; what it does not do has numbers without effect."""

    density: float  # kg/m3, ρ₀
    shear: float  # Pa, G
    bulk: float  # Pa, K at rest
    # Equation of state; c is √(K/ρ₀), and `shocks` whether the rest holds: p = K μ if not.
    shocks: bool
    c2: float  # m2/s2
    s1: float
    s2: float
    s3: float
    gamma: float
    a: float
    # Flow stress of Johnson and Cook; `hard` Pa, huge of an elastic material.
    hard: float
    b: float  # Pa
    n: float
    c: float
    m: float
    reference_rate: float  # 1/s
    reference_temperature: float  # K
    melting: float  # K, above the reference
    heating: float  # K m3/J, of plastic work, without equation of state
    # Fracture.
    spall: float  # Pa
    failure_strain: float
    d1: float  # 0 if there is no damage
    d2: float
    d3: float
    d4: float
    d5: float
    # Temperature.
    temperature: float  # K, at the start
    specific_heat: float  # J/(kg K)
    first: float  # η of the table's first row
    step: float  # η between its rows
    isentrope: NDArray[np.float64]  # (rows, 2) J/kg, energy on the isentrope, and its slope in η


def solid(material: Material) -> Solid:
    """Numbers of a material."""
    jc, eos, damage = material.johnson_cook, material.mie_gruneisen, material.damage
    heat = material.specific_heat or NEVER
    numbers: dict[str, Any] = {
        "density": material.density,
        "shear": material.shear,
        "bulk": material.bulk,
        "shocks": eos is not None,
        "c2": material.bulk / material.density,
        "s1": eos.s1 if eos else 0.0,
        "s2": eos.s2 if eos else 0.0,
        "s3": eos.s3 if eos else 0.0,
        "gamma": eos.gamma if eos else 0.0,
        "a": eos.a if eos else 0.0,
        "hard": jc.a if jc else NEVER,
        "b": jc.b if jc else 0.0,
        "n": jc.n if jc else 1.0,
        "c": jc.c if jc else 0.0,
        "m": jc.m if jc else 1.0,
        "reference_rate": jc.reference_rate if jc else 1.0,
        "reference_temperature": jc.reference_temperature if jc else 0.0,
        "melting": jc.melting_temperature - jc.reference_temperature if jc else NEVER,
        "heating": material.taylor_quinney / (material.density * heat),
        "spall": material.spall_stress or NEVER,
        "failure_strain": material.failure_strain or NEVER,
        "d1": damage.d1 if damage else 0.0,
        "d2": damage.d2 if damage else 0.0,
        "d3": damage.d3 if damage else 0.0,
        "d4": damage.d4 if damage else 0.0,
        "d5": damage.d5 if damage else 0.0,
        "temperature": material.temperature,
        "specific_heat": heat,
        "first": LEAST,
        "step": 1.0,
    }
    plain = Solid(**numbers, isentrope=np.zeros((2, 2)))
    if eos is None or heat == NEVER:
        return plain
    step = (0.95 * densest(plain) - LEAST) / (ROWS - 1)
    first = -step * math.ceil(-LEAST / step)  # so that a row is at rest
    rows = plain._replace(first=first, step=step, isentrope=np.zeros((ROWS, 2)))
    isentrope(rows, rows.isentrope)
    return rows


def densest(law: Solid) -> float:
    """η = 1 - ρ₀/ρ at which the Hugoniot's pressure has its pole; 0.9 if it has none."""
    eta = np.linspace(0.0, 0.9, 9001)
    mu = eta / (1.0 - eta)
    denominator = 1.0 - (law.s1 - 1.0) * mu - law.s2 * mu**2 / (mu + 1.0)
    denominator -= law.s3 * mu**3 / (mu + 1.0) ** 2
    beyond = np.flatnonzero(denominator <= 0.0)
    return float(eta[beyond[0]]) if len(beyond) else 0.9
