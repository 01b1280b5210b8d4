"""The material of each particle over a step: stress, energy, failure."""

from typing import NamedTuple

from numba import njit

from quintet.components.shared.materials.equation_of_state import temperature
from quintet.components.shared.materials.solid import Solid
from quintet.components.shared.numba_options import EXACT, FAST
from quintet.components.sph_solid.kernels.point import (
    Point,
    advanced,
    artificial_stress,
    corrected_scales,
    corrected_stress,
    divided_stress,
    plain_scales,
    rates,
    sound_speed,
    stretch_of_heat,
    trace_of,
)
from quintet.components.sph_solid.state import Array, Whole


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


@njit(inline="always")
def nine_of(array, i):  # type: ignore[no-untyped-def]
    """Row of nine numbers, as a tuple."""
    a = array[i]
    return a[0], a[1], a[2], a[3], a[4], a[5], a[6], a[7], a[8]


@njit(inline="always")
def six_of(array, i):  # type: ignore[no-untyped-def]
    """Row of six numbers, as a tuple."""
    a = array[i]
    return a[0], a[1], a[2], a[3], a[4], a[5]


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
    for place in range(first, last):
        i = rows[place]
        # In this order the compiler rounds as it always did.
        eta, m = ratios[i], nine_of(gradient, i)
        trace = trace_of(m)
        if correction.shape[0] > 0 and correction[i, 0] != 0.0:
            scales = corrected_scales(eta, trace, dt)
        else:
            scales = plain_scales(eta, trace, dt)
        rate = rates(m, scales, trace, dt)
        s, pressure, failed, warm = six_of(deviator, i), pressures[i], failures[i], warmth[i]
        energy, heat, strain, damage = energies[i], heating[i], strains[i], damages[i]
        before = Point(s, eta, pressure, energy, strain, warm, damage, failed)
        after = advanced(before, rate, heat, dt, law)
        s, ratios[i], pressures[i], energies[i], strains[i], warm, damages[i], failures[i] = after
        if law.shocks:
            warm = temperature(stretch_of_heat(ratios[i], failures[i]), energies[i], law)
        warmth[i] = warm
        sounds[i] = sound_speed(after, law)
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
        eta, start = points.density_ratio[i], density[material[i]]
        tau = divided_stress(six_of(points.deviator, i), points.pressure[i], eta)
        if not nine:
            for d in range(6):
                stress[i, d] = tau[d]
            stress[i, 6], stress[i, 7] = start * eta, start
            continue
        rows = corrected_stress(tau, eta, six_of(correction, i))
        for d in range(9):
            stress[i, d] = rows[d]
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
        repels = artificial_stress(six_of(stress, i), share)
        for d in range(6):
            stress[i, 8 + d] = repels[d]
