"""Loops over particles and their neighbours; each row is written by one call alone."""

import math
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from quintet.components.shared.float_bits import bits_of, number_of
from quintet.components.shared.numba_options import EXACT, FAST
from quintet.components.shared.packing import (
    empty_rows,
    longest_list,
    out_of_reach,
    pack_rows,
    pack_values,
)
from quintet.components.shared.search.neighbours import Lists
from quintet.components.shared.smoothing.cubic_spline import ONE
from quintet.components.shared.smoothing.smoothing import gradient, kernel
from quintet.components.sph_fluid.laws import (
    Constants,
    PairLaw,
    add_pair_force,
    contact_factor,
    diffusive_flux,
    inverses,
    pressure_term,
)
from quintet.components.sph_fluid.state import Array

Numbers = NDArray[np.floating]


class Particles(NamedTuple):
    """All rows of a state, with their images, as pairs need them; in double or single precision."""

    position: Numbers  # (n, 4) m, m, m, kg/m3: x, y, z, ρ
    velocity: Numbers  # (n, 4) m/s, m/s, m/s, Pa m6/kg2: u, v, w, p/ρ²


class Rates(NamedTuple):
    """What a pass over pairs writes."""

    rate: Array  # (n, 4) m/s2, m/s2, m/s2, kg/(m3 s): acceleration and dρ/dt
    xsph_velocity: Array  # (fluid, 3) m/s, Σ_j (m_j/ρ̄_ij)(u_j - u_i)W_ij; (0, 3) without XSPH
    minus_rho_div_u: Array  # (n,) kg/(m3 s), dρ/dt without diffusion; (0,) without a damper


class BoundaryRows(NamedTuple):
    """What boundary rows have beside particles; arrays have no rows where a term is off."""

    velocity: Numbers  # (n, 4) m/s, as kinematic viscosity sees it, and a column unused
    volume: Numbers  # (n,) 1, over that of a particle of the fluid
    mask: Numbers  # (n,) 1 where the contact potential acts, 0 elsewhere


@njit(**FAST)
def pair_rates(
    first: int, last: int, split: int, particles: Particles, boundary: BoundaryRows, lists: Lists,
    law: PairLaw, gravity: tuple[float, float, float], rates: Rates,
) -> tuple[float, float]:  # fmt: skip
    """Write accelerations and rates of density, summed over pairs.

    Parameters
    ----------
    first, last : int
        Rows to write: the fluid's, which are the first `split`, and those of a boundary whose
        density obeys the equation of continuity.
    particles, boundary, lists, law
    gravity : three floats, m/s2
    rates : Rates
        Written.

    Returns
    -------
    two floats, m2/s4 and 1/s
        The greatest squared acceleration, and the greatest |u·r|/(r² + 0.01h²) of any pair.
    """
    begin, middle, end, neighbour = lists
    # Arrays are taken out of their tuples once: each time costs a count of references.
    position, velocity = particles
    boundary_velocity, volume, mask = boundary
    rate, xsph_velocity, minus_rho_div_u = rates
    constants = law.constants
    zero = position.dtype.type(0)  # sums are as precise as what they are summed from
    near_position = empty_rows(longest_list(first, last, begin, end), 4, position.dtype)
    near_velocity = np.empty_like(near_position)
    near_apparent = np.empty_like(near_position)
    near_volume = np.ones_like(near_position[:, 0])
    near_mask = np.ones_like(near_position[:, 0])
    greatest, fastest = 0.0, bits_of(zero)
    for i in range(first, last):
        position_i = position[i, 0], position[i, 1], position[i, 2], position[i, 3]
        velocity_i = velocity[i, 0], velocity[i, 1], velocity[i, 2], velocity[i, 3]
        outside = out_of_reach(position_i[0], constants.smoothing.length)
        padding = outside, position_i[1], position_i[2], position_i[3]
        if i < split:
            count = pack_pairs(
                begin[i], middle[i], neighbour, position, velocity, padding, velocity_i,
                near_position, near_velocity,
            )  # fmt: skip
            force, density_rate, compression, xsph, fastest = sum_pairs(
                count, position_i, velocity_i, near_position, near_velocity, near_velocity,
                near_volume, near_mask, law.fluid, constants, fastest,
            )  # fmt: skip
            if law.fluid.xsph is not None:
                for d in range(3):
                    xsph_velocity[i, d] = 2.0 * constants.mass * xsph[d]
            if middle[i] < end[i]:
                push, more, other, fastest = sum_boundary(
                    middle[i], end[i], neighbour, position, velocity, boundary_velocity, volume,
                    mask, position_i, velocity_i, padding, near_position, near_velocity,
                    near_apparent, near_volume, near_mask, law.boundary, constants, fastest,
                )  # fmt: skip
                force = force[0] + push[0], force[1] + push[1], force[2] + push[2]
                density_rate, compression = density_rate + more, compression + other
            square = 0.0
            for d in range(3):
                rate[i, d] = constants.mass * force[d] + gravity[d]
                square += rate[i, d] * rate[i, d]
            greatest = max(greatest, square)
        else:
            count = pack_pairs(
                begin[i], end[i], neighbour, position, velocity, padding, velocity_i,
                near_position, near_velocity,
            )  # fmt: skip
            density_rate = sum_continuity(
                count, position_i, velocity_i, near_position, near_velocity, constants
            )
            compression = density_rate
        rate[i, 3] = constants.mass * density_rate
        if law.damper is not None:
            minus_rho_div_u[i] = constants.mass * compression
    return greatest, number_of(fastest)


@njit(inline="always")
def pack_pairs(  # type: ignore[no-untyped-def]
    begin, end, neighbour, position, velocity, padding, velocity_i, near_position, near_velocity
):
    """Copy neighbours [begin, end) side by side; return how many they are, filled up."""
    pack_rows(begin, end, neighbour, velocity, velocity_i, near_velocity)
    return pack_rows(begin, end, neighbour, position, padding, near_position)


@njit(inline="always")
def sum_boundary(  # type: ignore[no-untyped-def]
    begin, end, neighbour, position, velocity, apparent, volume, mask, position_i, velocity_i,
    padding, near_position, near_velocity, near_apparent, near_volume, near_mask, terms, constants,
    fastest,
):  # fmt: skip
    """Sums over boundary rows around a particle of the fluid, and what these have beside others."""
    count = pack_pairs(
        begin, end, neighbour, position, velocity, padding, velocity_i, near_position, near_velocity
    )
    if terms.viscosity.on is not None:
        pack_rows(begin, end, neighbour, apparent, velocity_i, near_apparent)
    if terms.volume is not None:
        pack_values(begin, end, neighbour, volume, near_volume)
    if terms.contact.partial is not None:
        pack_values(begin, end, neighbour, mask, near_mask)
    force, density_rate, compression, _, fastest = sum_pairs(
        count, position_i, velocity_i, near_position, near_velocity, near_apparent,
        near_volume, near_mask, terms, constants, fastest,
    )  # fmt: skip
    return force, density_rate, compression, fastest


@njit(inline="always")
def sum_continuity(count, position_i, velocity_i, position, velocity, constants):  # type: ignore[no-untyped-def]
    """Σ u_ij·∇_iW_ij of a boundary particle over so many of the fluid around it."""
    x, y, z, _ = position_i
    u, v, w, _ = velocity_i
    density_rate = position.dtype.type(0)
    for k in range(count):
        dx, dy, dz = x - position[k, 0], y - position[k, 1], z - position[k, 2]
        dot = dx * (u - velocity[k, 0]) + dy * (v - velocity[k, 1]) + dz * (w - velocity[k, 2])
        r2 = dx * dx + dy * dy + dz * dz
        per_r = ONE / math.sqrt(r2 + constants.smoothing.tiny)
        density_rate += dot * gradient(r2, per_r, constants.smoothing)
    return density_rate


@njit(inline="always")
def sum_pairs(  # type: ignore[no-untyped-def]
    count, position_i, velocity_i, position, velocity, apparent, volume, mask, terms, constants,
    fastest,
):  # fmt: skip
    """Sums over so many neighbours of a fluid particle, all alike.

    Parameters
    ----------
    count : int
    position_i, velocity_i : four floats
        The particle's rows of `Particles`.
    position, velocity, apparent : (any, 4) float arrays
        Of its neighbours, side by side; `apparent` velocities are those that viscosity sees.
    volume, mask : (any,) float arrays
        Of its neighbours, as of `BoundaryRows`.
    terms : PairTerms
    constants : Constants
    fastest : int
        Bits of the greatest |u·r|/(r² + 0.01h²) so far.

    Returns
    -------
    force over m² (3), dρ/dt over m, the same without diffusion, XSPH's sum (3), `fastest`
    """
    zero = position.dtype.type(0)
    x, y, z, density = position_i
    u, v, w, pressure = velocity_i
    more = density + constants.base + constants.base
    force = zero, zero, zero
    density_rate, compression = zero, zero
    mx, my, mz = zero, zero, zero
    for k in range(count):
        dx, dy, dz = x - position[k, 0], y - position[k, 1], z - position[k, 2]
        du, dv, dw = u - velocity[k, 0], v - velocity[k, 1], w - velocity[k, 2]
        r2 = dx * dx + dy * dy + dz * dz
        dot = dx * du + dy * dv + dz * dw
        density_sum = more + position[k, 3]
        per_r, per_r2, per_density = inverses(r2, density_sum, constants)
        approach = dot * per_r2
        slope = gradient(r2, per_r, constants.smoothing)
        if terms.volume is not None:
            slope *= volume[k]
        fastest = max(fastest, bits_of(abs(approach)))
        density_rate += dot * slope
        compression += dot * slope
        other = velocity[k, 3]
        if terms.contact.on is not None:
            other *= contact_factor(r2, mask[k], terms.contact, constants.smoothing)
        apparent_j = apparent[k, 0], apparent[k, 1], apparent[k, 2]
        force = add_pair_force(
            force, (dx, dy, dz), (u, v, w), apparent_j, r2, pressure + other, approach, slope,
            per_r2, per_density, terms,
        )  # fmt: skip
        if terms.diffusion.on is not None:
            difference = position[k, 3] - density
            flux = diffusive_flux(difference, dx, dy, dz, terms.diffusion)
            density_rate -= flux * slope * (r2 * per_r2 * per_density)
        if terms.xsph is not None:
            weight = kernel(r2, constants.smoothing) * per_density
            mx -= weight * du
            my -= weight * dv
            mz -= weight * dw
    return force, density_rate, compression, (mx, my, mz), fastest


# Not `FAST`: that would take every number for finite, and densities may not be.
@njit(**EXACT)
def write_pressure(constants: Constants, position: Array, velocity: Array) -> None:
    """Write p/ρ² of all rows from their densities."""
    for i in range(position.shape[0]):
        velocity[i, 3] = pressure_term(position[i, 3], constants)
