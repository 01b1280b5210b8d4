"""Pressure, speed of sound and temperature after Mie and Grüneisen, or of a linear solid.

Papers: Steinberg, Equation of State and Strength Properties of Selected Materials, UCRL-MA-106439
(1996); LS-DYNA Theory Manual, equation of state 4.
"""

from numba import njit

from quintet.components.shared.elementary import exponential
from quintet.components.shared.numba_options import EXACT, FAST_LANEWISE, INNER

POLE = 1e300  # Pa; kernels take every number to be finite


@njit(**FAST_LANEWISE)
def reference_pressure(mu, law):  # type: ignore[no-untyped-def]
    """P [Pa] at μ = ρ/ρ₀ - 1 without thermal energy; huge beyond the Hugoniot's pole."""
    if mu <= 0.0 or not law.shocks:
        return law.density * law.c2 * mu
    numerator, _, denominator, _ = fractions(mu, law)
    if denominator <= 0.0:
        return POLE
    return law.density * law.c2 * numerator / (denominator * denominator)


@njit(**FAST_LANEWISE)
def fractions(mu, law):  # type: ignore[no-untyped-def]
    """Numerator of p/(ρ₀c²) in compression, square root of its denominator, and their slopes."""
    over = 1.0 / (mu + 1.0)
    half = 1.0 - 0.5 * law.gamma
    numerator = mu * (1.0 + mu * (half - 0.5 * law.a * mu))
    rise = 1.0 + mu * (2.0 * half - 1.5 * law.a * mu)
    m2 = mu * mu
    denominator = 1.0 - (law.s1 - 1.0) * mu - law.s2 * m2 * over - law.s3 * m2 * mu * over * over
    fall = 1.0 - law.s1 - law.s2 * (m2 + 2.0 * mu) * over * over
    fall -= law.s3 * m2 * (mu + 3.0) * over * over * over
    return numerator, rise, denominator, fall


@njit(**FAST_LANEWISE)
def pressure_and_energy(mu, energy, change, law):  # type: ignore[no-untyped-def]
    """Pressure [Pa] and energy [J/kg] at a step's end, both implicit in each other.

    Parameters
    ----------
    mu : float
        ρ/ρ₀ - 1 at the end.
    energy : float, J/kg
        All but half the pressure's work at the end: e + work of stresses - ½ p dV of the start.
    change : float, m3/kg
        Of the specific volume.
    law : Solid
    """
    grows = (law.gamma + law.a * mu) * law.density
    pressure = reference_pressure(mu, law) + grows * energy
    pressure /= 1.0 + 0.5 * grows * change
    return pressure, energy - 0.5 * pressure * change


@njit(**FAST_LANEWISE)
def sound_speed_squared(mu, energy, pressure, law):  # type: ignore[no-untyped-def]
    """c² [m2/s2] of longitudinal waves: (∂p/∂ρ)_s + 4G/(3ρ), at least a tenth of that at rest."""
    stiffness = 1.0
    if mu > 0.0 and law.shocks:
        numerator, rise, denominator, fall = fractions(mu, law)
        per = 1.0 / denominator
        stiffness = (rise - 2.0 * numerator * fall * per) * per * per
    thermal = law.a * energy + (law.gamma + law.a * mu) * pressure / (
        law.density * (1.0 + mu) * (1.0 + mu)
    )
    bulk = law.c2 * stiffness + thermal
    return max(bulk, 0.1 * law.c2) + 4.0 / 3.0 * law.shear / (law.density * (1.0 + mu))


@njit(**FAST_LANEWISE)
def temperature(mu, energy, law):  # type: ignore[no-untyped-def]
    """T [K] from the energy: T₀ exp(γ₀η) on the isentrope, and (e - e_s(η))/c_v beyond it.

    With γρ and c_v constant, η = 1 - ρ₀/ρ; the isentrope's energy by cubic Hermite polynomials.
    """
    table = law.isentrope
    place, row = place_on_isentrope(mu, law)
    low, high = (table[row, 0], table[row, 1]), (table[row + 1, 0], table[row + 1, 1])
    return temperature_between(mu, energy, place - row, low, high, law)


@njit(**FAST_LANEWISE)
def place_on_isentrope(mu, law):  # type: ignore[no-untyped-def]
    """Where in the isentrope's table a density stands, in rows, and the row before it."""
    return place_in_table(mu, law.isentrope.shape[0], law)


@njit(**FAST_LANEWISE)
def place_in_table(mu, rows, law):  # type: ignore[no-untyped-def]
    """Where in a table of so many rows a density stands, in rows, and the row before it."""
    place = (mu / (1.0 + mu) - law.first) / law.step
    return place, min(max(int(place), 0), rows - 2)


@njit(**FAST_LANEWISE)
def temperature_between(mu, energy, beyond, low, high, law):  # type: ignore[no-untyped-def]
    """Temperature [K] so far beyond a row of the isentrope's table, of its numbers and the next's.

    Numbers are an energy [J/kg] and its slope in η.
    """
    eta = mu / (1.0 + mu)
    u = min(max(beyond, 0.0), 1.0)
    e0, d0 = low[0], law.step * low[1]
    e1, d1 = high[0], law.step * high[1]
    jump = e1 - e0
    cold = e0 + u * (d0 + u * (3.0 * jump - 2.0 * d0 - d1 + u * (d0 + d1 - 2.0 * jump)))
    return law.temperature * exponential(law.gamma * eta) + (energy - cold) / law.specific_heat


@njit(**INNER)
def _isentropic_slope(eta, energy, law):  # type: ignore[no-untyped-def]
    mu = eta / (1.0 - eta)
    thermal = (law.gamma + law.a * mu) * law.density * energy
    return (reference_pressure(mu, law) + thermal) / law.density


@njit(**EXACT)
def isentrope(law, table) -> None:  # type: ignore[no-untyped-def]
    """Write the energy on the isentrope through rest, and its slope in η = 1 - ρ₀/ρ.

    de/dη = p(η, e)/ρ₀ from e = 0 at η = 0, by the Runge-Kutta method of fourth order from row to
    row. `table` is (rows, 2), J/kg; one of its rows is at rest.
    """
    rest = round(-law.first / law.step)
    for way in (1, -1):
        h, row, energy = way * law.step, rest, 0.0
        while 0 <= row < table.shape[0]:
            eta = (row - rest) * law.step
            k1 = _isentropic_slope(eta, energy, law)
            table[row, 0], table[row, 1] = energy, k1
            k2 = _isentropic_slope(eta + 0.5 * h, energy + 0.5 * h * k1, law)
            k3 = _isentropic_slope(eta + 0.5 * h, energy + 0.5 * h * k2, law)
            k4 = _isentropic_slope(eta + h, energy + h * k3, law)
            energy += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
            row += way
