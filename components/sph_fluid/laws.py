"""Physics of one particle and of one pair of them; numba inlines it into the loops."""

import math
from typing import NamedTuple

from numba import njit

from quintet.components.shared.cubic_spline import normalisation, shape, slope
from quintet.components.sph_fluid.build import TAIT
from quintet.components.sph_fluid.params import SphFluidParams

# How many steps ahead of its last value the rate of density is taken, by extrapolation. One makes
# sound waves neutral to second order in ω dt; a little more damps them, up to ω dt = 0.5.
AHEAD = 1.25

TINY = 1e-12  # h², added to r² so that a particle does not divide by its distance from itself


class Fluid(NamedTuple):
    """The numbers that the laws need."""

    mass: float  # kg, of every particle
    smoothing: float  # m, h
    height: float  # 1/m3, α/4: scale of W
    slope: float  # 1/m4, -3α/(4h): scale of dW/dr
    density: float  # kg/m3, ρ₀
    stiffness: float  # Pa, B
    lowest: float  # Pa, pressure is cut below
    drag: float  # m2/s, 2 α c₀ h
    grip: float  # 1, share of it between fluid and boundary


def constants(params: SphFluidParams, dimensions: int = 3) -> Fluid:
    """Numbers of the laws from the parameters."""
    h = params.length
    alpha = normalisation(dimensions, h)
    return Fluid(
        mass=params.density * params.spacing**dimensions,
        smoothing=h,
        height=0.25 * alpha,
        slope=-0.75 * alpha / h,
        density=params.density,
        stiffness=params.sound_speed**2 * params.density / TAIT,
        lowest=-math.inf if params.tension else 0.0,
        drag=2.0 * params.viscosity * params.sound_speed * h,
        grip=params.grip,
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
def gradient(r2, fluid):  # type: ignore[no-untyped-def]
    """(dW/dr)/r, so that ∇_iW_ij = gradient · r_ij; finite where particles coincide."""
    r2 = r2 + TINY * fluid.smoothing * fluid.smoothing
    inverse = 1.0 / math.sqrt(r2)
    return fluid.slope * slope(r2 * inverse / fluid.smoothing) * inverse


@njit(inline="always")
def kernel(r2, fluid):  # type: ignore[no-untyped-def]
    """W; from the same root as the gradient, so that one serves both."""
    r2 = r2 + TINY * fluid.smoothing * fluid.smoothing
    inverse = 1.0 / math.sqrt(r2)
    return fluid.height * shape(r2 * inverse / fluid.smoothing)


@njit(inline="always")
def approach(dot, r2, fluid):  # type: ignore[no-untyped-def]
    """μ_ij/h = u_ij·r_ij/(r² + 0.01h²), negative as particles near each other."""
    return dot / (r2 + 0.01 * fluid.smoothing * fluid.smoothing)


@njit(inline="always")
def push(term_i, term_j, closing, density_sum, fluid):  # type: ignore[no-untyped-def]
    """p_i/ρ_i² + p_j/ρ_j² + Π_ij; Monaghan 1992, eq. (3.3) and (4.2) with β = 0."""
    return term_i + term_j - fluid.drag * min(closing, 0.0) / density_sum
