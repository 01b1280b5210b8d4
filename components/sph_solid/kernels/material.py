"""The material of each particle over a step: stress, energy, failure."""

import math
from typing import NamedTuple

from numba import njit

from quintet.components.shared.materials.equation_of_state import (
    pressure_and_energy,
    sound_speed_squared,
    temperature,
)
from quintet.components.shared.materials.fracture import damage_growth, is_torn
from quintet.components.shared.materials.solid import Solid
from quintet.components.shared.materials.strength import returned, turned_and_strained
from quintet.components.shared.materials.tension import positive_part
from quintet.components.shared.numba_options import EXACT, FAST, INNER
from quintet.components.sph_solid.laws import times
from quintet.components.sph_solid.state import Array, Whole

LEAST = 0.02  # η that is kept: of debris that has nothing left to tear


class Points(NamedTuple):
    """What varies from particle to particle, of the state."""

    deviator: Array
    density_ratio: Array
    pressure: Array
    energy: Array
    strain: Array
    temperature: Array
    damage: Array
    failed: Array
    sound: Array
    heating: Array


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
def nine_of(array, i):  # type: ignore[no-untyped-def]
    """Row of nine numbers, as a tuple."""
    a = array[i]
    return a[0], a[1], a[2], a[3], a[4], a[5], a[6], a[7], a[8]


@njit(inline="always")
def rates(i, eta, gradient, correction, dt):  # type: ignore[no-untyped-def]
    """η L and L [1/s] of a particle in the middle of the step, and the growth of η in it.

    Gradients are L where they are corrected, and η L elsewhere.
    """
    m = nine_of(gradient, i)
    trace = m[0] + m[4] + m[8]
    if correction.shape[0] > 0 and correction[i, 0] != 0.0:
        middle = eta / (1.0 + 0.5 * dt * trace)
        scale, per = middle, 1.0
    else:
        middle = eta - 0.5 * dt * trace
        scale, per = 1.0, 1.0 / middle
    return times_number(scale, m), times_number(per, m), -dt * scale * trace


@njit(inline="always")
def fails(i, s, pressure, delta, warm, points, law, dt):  # type: ignore[no-untyped-def]
    """Whether a particle fails now, of a plastic strain delta in the step; damage grows by it."""
    if delta > 0.0:
        points.damage[i] += damage_growth(s, pressure, delta, warm, dt, law)
    tears = points.strain[i] >= law.failure_strain or points.damage[i] >= 1.0
    return tears or is_torn(s, pressure, law.spall)


@njit(**FAST)
def advance(
    first: int, last: int, rows: Whole, points: Points, gradient: Array, correction: Array,
    law: Solid, dt: float,
) -> None:  # fmt: skip
    """Advance stress and energy of particles of one material by a step.

    Parameters
    ----------
    first, last : int
        Range of `rows`.
    rows : (any,) int array
        Particles.
    points : Points
        Changed.
    gradient : (n, 9) float array, 1/s
        η L in the middle of the step; L where gradients are corrected.
    correction : (n, 6) float array
        Zeros where they are not; (0, 6) if none is.
    law : Solid
    dt : float, s
    """
    deviator, ratios, pressures, energies, strains, warmth, damages, failures, sounds, heating = (
        points
    )
    per_start = 1.0 / law.density
    for place in range(first, last):
        i = rows[place]
        eta = ratios[i]
        rate, strain_rate, grows = rates(i, eta, gradient, correction, dt)
        after = max(eta + grows, LEAST)
        before2, after2 = 1.0 / (eta * eta), 1.0 / (after * after)
        s = (deviator[i, 0], deviator[i, 1], deviator[i, 2], deviator[i, 3], deviator[i, 4],
             deviator[i, 5])  # fmt: skip
        pressure, failed, warm = pressures[i], failures[i] != 0.0, warmth[i]
        # Works of the step's two halves are those of the two ends' forces.
        half = 0.5 * dt * per_start
        energy = energies[i] + 0.5 * dt * heating[i]
        energy += half * before2 * power(s, rate) + 0.5 * pressure * before2 * per_start * grows
        delta = 0.0
        if not failed:
            s = turned_and_strained(s, strain_rate, law.shear, dt)
            s, delta, work = returned(s, strains[i], warm, dt, law)
            strains[i] += delta
            if not law.shocks:
                warm += law.heating * work
        mu, change = after - 1.0, -grows * after2 * per_start
        deviatoric = half * after2 * power(s, rate)
        pressure, whole = pressure_and_energy(mu, energy + deviatoric, change, law)
        if not failed and fails(i, s, pressure, delta, warm, points, law, dt):
            failed, failures[i], damages[i] = True, 1.0, 1.0
            s = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
            pressure, whole = pressure_and_energy(mu, energy, change, law)
        if failed and pressure < 0.0:
            pressure, whole = 0.0, energy
        energies[i], ratios[i], pressures[i] = whole, after, pressure
        if law.shocks:
            # What has failed opens, and is not stretched.
            warm = temperature(max(mu, 0.0) if failed else mu, whole, law)
        warmth[i] = warm
        squared = sound_speed_squared(mu, whole, pressure, law)
        if failed:
            squared -= 4.0 / 3.0 * law.shear * per_start / after
        sounds[i] = math.sqrt(squared)
        for d in range(6):
            deviator[i, d] = s[d]


@njit(**EXACT)
def write_stresses(
    first: int, last: int, density: Array, material: Whole, points: Points, correction: Array,
    stress: Array,
) -> None:  # fmt: skip
    """Write the rows of stress that pairs take: τ = σ/η², or σ K⁻¹/η where gradients are corrected.

    Parameters
    ----------
    first, last : int
    density : (materials,) float array, kg/m3
        At the start.
    material : (n,) int array
    points, correction
    stress : (n + images, 8, 12 or 16) float array
        Written: six of τ, or nine, then ρ and ρ₀.
    """
    nine = stress.shape[1] == 12
    for i in range(first, last):
        eta, p = points.density_ratio[i], points.pressure[i]
        start = density[material[i]]
        per = 1.0 / (eta * eta)
        xx, yy, zz = points.deviator[i, 0] - p, points.deviator[i, 1] - p, points.deviator[i, 2] - p
        xy, yz, zx = points.deviator[i, 3], points.deviator[i, 4], points.deviator[i, 5]
        if not nine:
            stress[i, 0], stress[i, 1], stress[i, 2] = per * xx, per * yy, per * zz
            stress[i, 3], stress[i, 4], stress[i, 5] = per * xy, per * yz, per * zx
            stress[i, 6], stress[i, 7] = start * eta, start
            continue
        xx, yy, zz, xy, yz, zx = per * xx, per * yy, per * zz, per * xy, per * yz, per * zx
        tau = xx, xy, zx, xy, yy, yz, zx, yz, zz
        if correction[i, 0] != 0.0:
            bxx, byy, bzz = correction[i, 0], correction[i, 1], correction[i, 2]
            bxy, byz, bzx = correction[i, 3], correction[i, 4], correction[i, 5]
            tau = times(tau, (eta * bxx, eta * byy, eta * bzz, eta * bxy, eta * byz, eta * bzx))
        for d in range(9):
            stress[i, d] = tau[d]
        stress[i, 9], stress[i, 10], stress[i, 11] = start * eta, start, 0.0


@njit(**EXACT)
def write_artificial(first: int, last: int, share: float, stress: Array) -> None:
    """Write the artificial stresses R = -ε σ⁺/η², of the tensions in principal axes.

    Parameters
    ----------
    first, last : int
    share : float
        ε.
    stress : (n + images, 16) float array
        With τ = σ/η²; columns 8 to 13 are written.

    References
    ----------
    Gray, Monaghan & Swift, Comput. Methods Appl. Mech. Eng. 190 (2001) 6641.
    """
    for i in range(first, last):
        positive_part(stress[i, :6], stress[i, 8:14])
        for d in range(8, 14):
            stress[i, d] *= -share
