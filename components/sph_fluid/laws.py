"""Physics of one particle and of one pair of them; numba inlines it into the loops."""

import math
from typing import NamedTuple

import numpy as np
from numba import njit, types
from numba.extending import overload
from numpy.typing import NDArray

from quintet.components.shared.smoothing.cubic_spline import ONE, ZERO
from quintet.components.shared.smoothing.smoothing import Smoothing, kernel, smoothing
from quintet.components.sph_fluid.params import SphFluidParams

TAIT = 7  # γ, exponent of the equation of state

# How many steps ahead of its last value the rate of density is taken, by extrapolation. One makes
# sound waves neutral to second order in ω dt; a little more damps them, up to ω dt = 0.5.
AHEAD = 1.25

# All walls but dynamic ones press as still water does, and would let fast particles by. Within
# NEAREST spacings, which a particle half a spacing off the face does not reach, their particles
# repel: softly beside the fluid's own stiffness, but enough to turn a tenth of the speed of sound.
GUARD = 0.2
NEAREST = 0.9


class Fluid(NamedTuple):
    """The numbers that the laws need."""

    mass: float  # kg, of every particle; kg/m in two dimensions
    smoothing: Smoothing
    soft: float  # m2, 0.01h², added to r² where velocities are divided by it
    density: float  # kg/m3, ρ₀
    stiffness: float  # Pa, B
    lowest: float  # Pa, pressure is cut below
    drag: float  # m2/s, 2 α c₀ h
    grip: float  # 1, share of it between fluid and boundary
    base: float  # kg/m3, above which pairs are given densities


class Diffusion(NamedTuple):
    """The numbers that the diffusion of density needs."""

    strength: float  # m2/s, 4 δ h c₀
    x: float  # kg/m4, hydrostatic gradient of density, ρ₀ g/c₀²
    y: float
    z: float


def diffusion(params: SphFluidParams) -> Diffusion | None:
    """Numbers of the diffusion of density; None where it is off."""
    if params.density_diffusion == 0.0:
        return None
    sound = params.sound_speed
    x, y, z = (params.density * pull / sound**2 for pull in params.hydrostatic_gravity)
    return Diffusion(4.0 * params.density_diffusion * params.smoothing_length * sound, x, y, z)


class Friction(NamedTuple):
    """The numbers that viscosity of the fluid itself needs."""

    stress: bool | None  # True, or None if it is a Laplacian
    strength: float  # m2/s, 4 (D + 2) ν in D dimensions, or 4 ν
    seen: NDArray[np.float64]  # (n, 4) m/s, velocities as friction sees them, and a column unused


class Guard(NamedTuple):
    """The numbers that the repulsion of walls needs."""

    stiffness: float  # 1/(kg s2)
    reach2: float  # m2


def guard(params: SphFluidParams) -> Guard | None:
    """Numbers of the repulsion of walls; None for dynamic ones, which repel by themselves."""
    if params.boundary.method == "dbc":
        return None
    mass = params.density * params.spacing**params.dimensions
    stiffness = GUARD * (params.sound_speed / params.spacing) ** 2 / mass
    return Guard(stiffness, (NEAREST * params.spacing) ** 2)


class Contact(NamedTuple):
    """The numbers that the contact potential needs; n - 1 = once + 2 twice + 4 four."""

    strength: float  # 1, n / (W(Δp) Δpᵈ)
    inverse: float  # m3, 1 / W(Δp)
    once: float  # 1, or 0
    twice: float
    four: float
    some: NDArray[np.floating] | None = None  # (n,) 1 for boundary rows that it holds, 0 for
    # others; None: it holds all


def constants(params: SphFluidParams) -> Fluid:
    """Numbers of the laws from the parameters."""
    h, dimensions = params.smoothing_length, params.dimensions
    return Fluid(
        mass=params.density * params.spacing**dimensions,
        smoothing=smoothing(params.kernel, dimensions, h),
        soft=0.01 * h * h,
        density=params.density,
        stiffness=params.sound_speed**2 * params.density / TAIT,
        lowest=-math.inf if params.negative_pressure else 0.0,
        drag=2.0 * params.viscosity.artificial * params.sound_speed * h,
        grip=params.boundary.wall_viscosity_factor,
        base=0.0,
    )


@njit(inline="always")
def tait(density, fluid):  # type: ignore[no-untyped-def]
    """Pressure; Monaghan 1994, eq. (3.1)."""
    ratio = density / fluid.density
    cube = ratio * ratio * ratio
    return max(fluid.stiffness * (cube * cube * ratio - 1.0), fluid.lowest)


@njit(inline="always")
def pressure_term(density, fluid):  # type: ignore[no-untyped-def]
    """p/ρ², each particle's share of the pair's pressure force."""
    return tait(density, fluid) / (density * density)


@njit(inline="always")
def inverses(r2, both, fluid):  # type: ignore[no-untyped-def]
    """1/r, 1/(r² + 0.01h²) and 1/(ρ_i + ρ_j), all by one division, the slowest operation here."""
    r2 = r2 + fluid.smoothing.tiny
    soft = r2 + fluid.soft
    inverse = ONE / (r2 * soft * both)
    return math.sqrt(r2) * soft * both * inverse, r2 * both * inverse, r2 * soft * inverse


@njit(inline="always")
def push(terms, closing, per_both, fluid):  # type: ignore[no-untyped-def]
    """p_i/ρ_i² + p_j/ρ_j² + Π_ij; Monaghan 1992, eq. (3.3) and (4.2) with β = 0.

    `closing` is μ_ij/h = u_ij·r_ij/(r² + 0.01h²), negative as particles near each other.
    """
    return terms - fluid.drag * min(closing, ZERO) * per_both


@njit(inline="always")
def spread(difference, dx, dy, dz, diffusion):  # type: ignore[no-untyped-def]
    """4δhc₀ [(ρ_j - ρ_i) - ρᴴ_ij], ρᴴ_ij from the weight of the fluid between the two.

    Fourtakas et al., Comput. Fluids 190 (2019) 346, eq. (12), linear in p/B, with m_j/ρ̄_ij for
    the volume, so that no mass is made.
    """
    hydrostatic = diffusion.x * dx + diffusion.y * dy + diffusion.z * dz
    return diffusion.strength * (difference + hydrostatic)


@njit(inline="always")
def repel(r2, guard):  # type: ignore[no-untyped-def]
    """Force of a wall particle on one of fluid over m² r, of finite reach."""
    return guard.stiffness * max(ONE - r2 / guard.reach2, ZERO)


def among(factor, some, j):  # type: ignore[no-untyped-def]
    """Factor of row j if the potential holds it, or else 1."""


@overload(among, inline="always")
def _among(factor, some, j):  # type: ignore[no-untyped-def]
    if isinstance(some, types.NoneType):
        return lambda factor, some, j: factor
    return lambda factor, some, j: ONE + some[j] * (factor - ONE)


@njit(inline="always")
def bear(r2, j, some, contact, fluid):  # type: ignore[no-untyped-def]
    """What K Δpᵈ/ρ₀² of row j is multiplied by to stand for p_j/ρ_j²: n W^(n-1)/(W(Δp)^n Δpᵈ).

    Of a row that is not among `some` (None: all), which it holds, p_j/ρ_j² stays as it is.
    """
    one = kernel(r2, fluid.smoothing) * contact.inverse
    two = one * one
    power = (ONE + contact.once * (one - ONE)) * (ONE + contact.twice * (two - ONE))
    factor = contact.strength * power * (ONE + contact.four * (two * two - ONE))
    return among(factor, some, j)
