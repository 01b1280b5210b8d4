"""Laws of one particle's material over a step: stress, energy, failure; numba inlines them."""

import math
from typing import NamedTuple

from numba import njit

from quintet.components.shared.materials.equation_of_state import (
    pressure_and_energy,
    sound_speed_squared,
)
from quintet.components.shared.materials.fracture import damage_growth, is_torn
from quintet.components.shared.materials.strength import returned, turned_and_strained
from quintet.components.shared.materials.tension import positive_part
from quintet.components.shared.numba_options import INNER
from quintet.components.sph_solid.laws import times

LEAST = 0.02  # smallest η: failed material may expand without limit


class Point(NamedTuple):
    """What a step changes of one particle's state."""

    deviator: tuple[float, float, float, float, float, float]  # Pa
    density_ratio: float
    pressure: float  # Pa
    energy: float  # J/kg
    strain: float
    temperature: float  # K
    damage: float
    failed: float  # 1 or 0


@njit(**INNER)
def power(s, m):  # type: ignore[no-untyped-def]
    """s:M of a deviator and a matrix (nine, by rows)."""
    m00, m01, m02, m10, m11, m12, m20, m21, m22 = m
    return (
        s[0] * m00
        + s[1] * m11
        + s[2] * m22
        + s[3] * (m01 + m10)
        + s[4] * (m12 + m21)
        + s[5] * (m20 + m02)
    )


@njit(inline="always")
def times_number(number, m):  # type: ignore[no-untyped-def]
    """Product of a number and a matrix, nine by rows."""
    return (
        number * m[0], number * m[1], number * m[2], number * m[3], number * m[4], number * m[5],
        number * m[6], number * m[7], number * m[8],
    )  # fmt: skip


@njit(inline="always")
def trace_of(m):  # type: ignore[no-untyped-def]
    """Trace of a matrix, nine by rows."""
    return m[0] + m[4] + m[8]


@njit(inline="always")
def corrected_scales(eta, trace, dt):  # type: ignore[no-untyped-def]
    """Factors by which a corrected gradient L of this trace [1/s] gives η L and L."""
    return eta / (1.0 + 0.5 * dt * trace), 1.0


@njit(inline="always")
def plain_scales(eta, trace, dt):  # type: ignore[no-untyped-def]
    """Factors by which a gradient η L of this trace [1/s] gives η L and L."""
    return 1.0, 1.0 / (eta - 0.5 * dt * trace)


@njit(inline="always")
def rates(m, scales, trace, dt):  # type: ignore[no-untyped-def]
    """η L and L [1/s] in the middle of the step, and the change of η in it."""
    scale, per = scales
    return times_number(scale, m), times_number(per, m), -dt * scale * trace


@njit(inline="always")
def fails(s, pressure, strain, damage, law):  # type: ignore[no-untyped-def]
    """Whether a particle fails now, of its plastic strain, damage and stress."""
    tears = strain >= law.failure_strain or damage >= 1.0
    return tears or is_torn(s, pressure, law.spall)


@njit(inline="always")
def advanced(point, rate_of_point, heating, dt, law):  # type: ignore[no-untyped-def]
    """Stress, energy and failure of a particle after a step.

    Parameters
    ----------
    point : Point
    rate_of_point
        As `rates` returns them.
    heating : float, W/kg
        Of the artificial viscosity.
    dt : float, s
    law : Solid

    Returns
    -------
    Point
        With the temperature of the plastic work; see `shocked_temperature` where the material has
        an equation of state.
    """
    s, eta, pressure, energy, strain, warm, damage, is_broken = point
    per_start = 1.0 / law.density
    rate, strain_rate, grows = rate_of_point
    after = max(eta + grows, LEAST)
    before2, after2 = 1.0 / (eta * eta), 1.0 / (after * after)
    failed = is_broken != 0.0
    # Works of the step's two halves are those of the two ends' forces.
    half = 0.5 * dt * per_start
    energy += 0.5 * dt * heating
    energy += half * before2 * power(s, rate) + 0.5 * pressure * before2 * per_start * grows
    delta = 0.0
    if not failed:
        s = turned_and_strained(s, strain_rate, law.shear, dt)
        s, delta, work = returned(s, strain, warm, dt, law)
        strain += delta
        if not law.shocks:
            warm += law.heating * work
    mu, change = after - 1.0, -grows * after2 * per_start
    deviatoric = half * after2 * power(s, rate)
    pressure, whole = pressure_and_energy(mu, energy + deviatoric, change, law)
    if not failed:
        if delta > 0.0:
            damage += damage_growth(s, pressure, delta, warm, dt, law)
        if fails(s, pressure, strain, damage, law):
            failed, damage = True, 1.0
            s = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
            pressure, whole = pressure_and_energy(mu, energy, change, law)
    if failed and pressure < 0.0:
        pressure, whole = 0.0, energy
    return Point(s, after, pressure, whole, strain, warm, damage, 1.0 if failed else 0.0)


@njit(inline="always")
def stretch_of_heat(density_ratio, failed):  # type: ignore[no-untyped-def]
    """μ = η - 1 for the temperature: at least 0 of failed material, which does not stretch."""
    mu = density_ratio - 1.0
    return max(mu, 0.0) if failed != 0.0 else mu


@njit(inline="always")
def sound_speed(point, law):  # type: ignore[no-untyped-def]
    """Speed [m/s] of longitudinal waves; of sound where a particle has failed."""
    mu = point.density_ratio - 1.0
    squared = sound_speed_squared(mu, point.energy, point.pressure, law)
    if point.failed != 0.0:
        squared -= 4.0 / 3.0 * law.shear * (1.0 / law.density) / point.density_ratio
    return math.sqrt(squared)


@njit(inline="always")
def divided_stress(s, pressure, eta):  # type: ignore[no-untyped-def]
    """τ = σ/η² [Pa], six numbers."""
    per = 1.0 / (eta * eta)
    xx, yy, zz, xy, yz, zx = s
    xx, yy, zz = xx - pressure, yy - pressure, zz - pressure
    return per * xx, per * yy, per * zz, per * xy, per * yz, per * zx


@njit(inline="always")
def artificial_stress(tau, share):  # type: ignore[no-untyped-def]
    """R = -ε σ⁺/η² [Pa] of τ, six numbers, and ε; see `write_artificial`."""
    xx, yy, zz, xy, yz, zx = positive_part(tau)
    return -share * xx, -share * yy, -share * zz, -share * xy, -share * yz, -share * zx


@njit(inline="always")
def corrected_stress(tau, eta, b):  # type: ignore[no-untyped-def]
    """σ K⁻¹/η [Pa], nine by rows, of τ and the inverse of K; τ itself where the inverse is 0."""
    xx, yy, zz, xy, yz, zx = tau
    nine = xx, xy, zx, xy, yy, yz, zx, yz, zz
    if b[0] == 0.0:
        return nine
    return times(nine, (eta * b[0], eta * b[1], eta * b[2], eta * b[3], eta * b[4], eta * b[5]))
