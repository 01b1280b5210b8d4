"""Physics of one particle and of one pair of them; numba inlines it into the loops.

A term of the pair law is a named tuple of its numbers. Its field `on` is True, or None where a
scene leaves the term out: None is known when a kernel is compiled, which then has nothing of it.
"""

import math
from typing import NamedTuple

from numba import njit

from quintet.components.shared.smoothing.cubic_spline import ONE, ZERO
from quintet.components.shared.smoothing.smoothing import Smoothing, kernel

On = bool | None


class Constants(NamedTuple):
    """The numbers of every fluid."""

    mass: float  # kg, of every particle; kg/m in two dimensions
    smoothing: Smoothing
    softening: float  # m2, 0.01h², added to r² where velocities are divided by it
    density: float  # kg/m3, ρ₀
    stiffness: float  # Pa, B = c₀²ρ₀/γ
    lowest: float  # Pa, pressure is cut below
    base: float  # kg/m3, above which pairs are given densities


class DensityDiffusion(NamedTuple):
    """The numbers of the diffusion of density."""

    on: On
    strength: float  # m2/s, 4 δ h c₀
    x: float  # kg/m4, hydrostatic gradient of density, ρ₀ g/c₀²
    y: float
    z: float


class KinematicViscosity(NamedTuple):
    """The numbers of the viscosity of the fluid itself."""

    on: On
    stress: On  # True, or None if it is a Laplacian
    strength: float  # m2/s, 4 (D + 2) ν in D dimensions, or 4 ν


class WallRepulsion(NamedTuple):
    """The numbers of the repulsion of walls."""

    on: On
    stiffness: float  # 1/(kg s2)
    reach2: float  # m2


class ContactPotential(NamedTuple):
    """The numbers of the contact potential; n - 1 = once + 2 twice + 4 four."""

    on: On
    partial: On  # True if it acts at some of the boundary's rows only
    strength: float  # 1, n / (W(Δp) Δpᵈ)
    inverse: float  # m3, 1 / W(Δp)
    once: float  # 1, or 0
    twice: float
    four: float


class PairTerms(NamedTuple):
    """What acts between two particles besides pressure; its numbers differ at a boundary."""

    artificial: float  # m2/s, 2 α c₀ h
    viscosity: KinematicViscosity
    diffusion: DensityDiffusion
    repulsion: WallRepulsion
    contact: ContactPotential
    volume: On  # whether boundary particles have volumes of their own
    xsph: On


class PairLaw(NamedTuple):
    """The pair law of a fluid: the same terms among its own particles and with its boundary."""

    constants: Constants
    fluid: PairTerms
    boundary: PairTerms
    damper: On


@njit(inline="always")
def tait(density, constants):  # type: ignore[no-untyped-def]
    """Pressure of a weakly compressible fluid.

    Parameters
    ----------
    density : float, kg/m3
    constants : Constants

    Returns
    -------
    float, Pa
        B [(ρ/ρ₀)^γ - 1], cut below `constants.lowest`.

    References
    ----------
    Monaghan, J. Comput. Phys. 110 (1994) 399, eq. (3.1).
    """
    ratio = density / constants.density
    cube = ratio * ratio * ratio
    return max(constants.stiffness * (cube * cube * ratio - 1.0), constants.lowest)


@njit(inline="always")
def pressure_term(density, constants):  # type: ignore[no-untyped-def]
    """p/ρ² [Pa m6/kg2] from a density [kg/m3]: a particle's share of a pair's pressure force."""
    return tait(density, constants) / (density * density)


@njit(inline="always")
def damped_pressure_term(density, minus_rho_div_u, strength, constants):  # type: ignore[no-untyped-def]
    """p/ρ² [Pa m6/kg2], as if a strength [m2/s] times -ρ∇·u [kg/(m3 s)] were pressure too.

    References
    ----------
    Sun et al., J. Comput. Phys. 483 (2023) 112056.
    """
    more = strength * minus_rho_div_u / (density * density)
    return pressure_term(density, constants) + more


@njit(inline="always")
def inverses(r2, density_sum, constants):  # type: ignore[no-untyped-def]
    """1/r, 1/(r² + 0.01h²) and 1/(ρ_i + ρ_j), all by one division, the slowest operation here.

    Parameters
    ----------
    r2 : float, m2
        Distance, squared.
    density_sum : float, kg/m3
        ρ_i + ρ_j.
    constants : Constants

    Returns
    -------
    three floats, 1/m, 1/m2, m3/kg
    """
    r2 = r2 + constants.smoothing.tiny
    soft = r2 + constants.softening
    inverse = ONE / (r2 * soft * density_sum)
    return (
        math.sqrt(r2) * soft * density_sum * inverse,
        r2 * density_sum * inverse,
        r2 * soft * inverse,
    )


@njit(inline="always")
def pair_pressure(pressures, approach, per_density, terms):  # type: ignore[no-untyped-def]
    """p_i/ρ_i² + p_j/ρ_j² + Π_ij, with artificial viscosity between what comes nearer.

    Parameters
    ----------
    pressures : float, Pa m6/kg2
        p_i/ρ_i² + p_j/ρ_j².
    approach : float, 1/s
        μ_ij/h = u_ij·r_ij/(r² + 0.01h²), negative as particles near each other.
    per_density : float, m3/kg
        1/(ρ_i + ρ_j).
    terms : PairTerms

    Returns
    -------
    float, Pa m6/kg2

    References
    ----------
    Monaghan, Annu. Rev. Astron. Astrophys. 30 (1992) 543, eq. (3.3) and (4.2) with β = 0.
    """
    return pressures - terms.artificial * min(approach, ZERO) * per_density


@njit(inline="always")
def diffusive_flux(difference, dx, dy, dz, diffusion):  # type: ignore[no-untyped-def]
    """4δhc₀ [(ρ_j - ρ_i) - ρᴴ_ij], ρᴴ_ij from the weight of the fluid between the two.

    Parameters
    ----------
    difference : float, kg/m3
        ρ_j - ρ_i.
    dx, dy, dz : float, m
        r_i - r_j.
    diffusion : DensityDiffusion

    Returns
    -------
    float, kg/(m s)

    References
    ----------
    Fourtakas et al., Comput. Fluids 190 (2019) 346, eq. (12), linear in p/B, with m_j/ρ̄_ij for
    the volume, so that no mass is made.
    """
    hydrostatic = diffusion.x * dx + diffusion.y * dy + diffusion.z * dz
    return diffusion.strength * (difference + hydrostatic)


@njit(inline="always")
def repulsion_force(r2, repulsion):  # type: ignore[no-untyped-def]
    """Force of a wall particle on one of fluid over m² r [1/(kg s2)], of finite reach; r² in m2."""
    return repulsion.stiffness * max(ONE - r2 / repulsion.reach2, ZERO)


@njit(inline="always")
def contact_factor(r2, mask, contact, smoothing):  # type: ignore[no-untyped-def]
    """What K Δpᵈ/ρ₀² of a boundary row is multiplied by to stand for its p_j/ρ_j².

    Parameters
    ----------
    r2 : float, m2
    mask : float, 1
        1 where the potential acts, 0 where p_j/ρ_j² stays as it is; of no account if it acts at
        the whole boundary.
    contact : ContactPotential
    smoothing : Smoothing

    Returns
    -------
    float, 1
        n W^(n-1) / (W(Δp)^n Δpᵈ).

    References
    ----------
    Vignjevic, De Vuyst & Campbell, CMES 13 (2006) 35; see `boundary/contact_potential.py`.
    """
    first = kernel(r2, smoothing) * contact.inverse
    second = first * first
    power = (ONE + contact.once * (first - ONE)) * (ONE + contact.twice * (second - ONE))
    factor = contact.strength * power * (ONE + contact.four * (second * second - ONE))
    if contact.partial is not None:
        return ONE + mask * (factor - ONE)
    return factor


@njit(inline="always")
def add_pair_force(  # type: ignore[no-untyped-def]
    force, r, velocity, other, r2, pressures, approach, slope, per_r2, per_density, terms
):
    """Add the force of particle j on particle i over m²: all terms of the pair law that push.

    Parameters
    ----------
    force : three floats, m/(kg s2)
        Sum so far, over m².
    r : three floats, m
        r_i - r_j.
    velocity, other : three floats, m/s
        u_i and u_j, as kinematic viscosity sees them.
    r2 : float, m2
    pressures, approach, per_density : float
        As of `pair_pressure`.
    slope : float, 1/m5
        (dW/dr)/r.
    per_r2 : float, 1/m2
        1/(r² + 0.01h²).
    terms : PairTerms

    Returns
    -------
    three floats, m/(kg s2)

    References
    ----------
    Pressure: Monaghan 1992, eq. (3.3); viscosity: Lo & Shao, Appl. Ocean Res. 24 (2002) 275, or
    Monaghan & Gingold, J. Comput. Phys. 52 (1983) 374.
    """
    fx, fy, fz = force
    dx, dy, dz = r
    size = slope * pair_pressure(pressures, approach, per_density, terms)
    if terms.repulsion.on is not None:
        size -= repulsion_force(r2, terms.repulsion)
    fx -= size * dx
    fy -= size * dy
    fz -= size * dz
    if terms.viscosity.on is not None:
        du, dv, dw = velocity[0] - other[0], velocity[1] - other[1], velocity[2] - other[2]
        if terms.viscosity.stress is not None:
            rub = dx * du + dy * dv + dz * dw
            rub *= terms.viscosity.strength * slope * per_r2 * per_density
            fx += rub * dx
            fy += rub * dy
            fz += rub * dz
        else:
            shear = terms.viscosity.strength * slope * (r2 * per_r2 * per_density)
            fx += shear * du
            fy += shear * dv
            fz += shear * dw
    return fx, fy, fz
