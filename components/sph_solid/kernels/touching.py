"""Bodies whose pairs are those of the start touch: what comes nearer than a spacing is pushed off.

    f_ij = k (Δ - r) r̂,   k = ½ (ρ₀_i c_i² + ρ₀_j c_j²) √(V_i V_j)/Δ²,   r < Δ

The stiffness is that of the material between two particles of the lattice. The force has a
potential, which counts as internal energy of both.
"""

import math

from numba import njit

from quintet.components.shared.numba_options import EXACT
from quintet.components.sph_solid.kernels.pairs import Forces
from quintet.components.sph_solid.state import Array, Whole

TINY = 1e-12  # of the spacing: two in one place are pushed nowhere


@njit(inline="always")
def is_touching(square, spacing):  # type: ignore[no-untyped-def]
    """Whether two at a distance, of which this is the square [m2], push each other off."""
    return TINY * spacing * spacing <= square < spacing * spacing


@njit(inline="always")
def stiffness(density, sound):  # type: ignore[no-untyped-def]
    """ρ₀ c² [Pa]."""
    return density * sound**2


@njit(inline="always")
def contact_force(offset, square, stiff, volumes, spacing):  # type: ignore[no-untyped-def]
    """Force [N] on i, of x_i - x_j [m], its square, ½ (ρ₀_i c_i² + ρ₀_j c_j²) [Pa] and V_i V_j."""
    dx, dy, dz = offset
    r = math.sqrt(square)
    push = stiff * math.sqrt(volumes) * (spacing - r) / (spacing * spacing)
    return push * dx / r, push * dy / r, push * dz / r


@njit(inline="always")
def plane_force(apart, stiff, spacing):  # type: ignore[no-untyped-def]
    """Force [N] off a plane, of the distance [m] to the own image and ρ₀ c² V [J].

    Half the energy of the pair is the particle's own, and half its image's.
    """
    return stiff * (spacing - apart) / (spacing * spacing)


@njit(**EXACT)
def push_apart(
    pairs: Whole, place: Array, motion: Array, density: Array, spacing: float, forces: Forces
) -> None:
    """Add what pairs that touch push each other by, to the particles that have forces.

    Parameters
    ----------
    pairs : (p, 2) int array
        In ascending order, so that sums do not depend on which of them touch.
    place, motion : (any, 4) float arrays
        As in `Rows`, with speeds of sound.
    density : (any,) float array, kg/m3
        At the start.
    spacing : float, m
        Δ.
    forces : Forces
        Of the first rows; changed.
    """
    acceleration, heating = forces
    count = heating.shape[0]
    for q in range(pairs.shape[0]):
        i, j = pairs[q, 0], pairs[q, 1]
        dx, dy, dz = place[i, 0] - place[j, 0], place[i, 1] - place[j, 1], place[i, 2] - place[j, 2]
        square = dx * dx + dy * dy + dz * dz
        if not is_touching(square, spacing):
            continue
        stiff_i, stiff_j = stiffness(density[i], motion[i, 3]), stiffness(density[j], motion[j, 3])
        stiff, volumes = 0.5 * (stiff_i + stiff_j), place[i, 3] * place[j, 3]
        fx, fy, fz = contact_force((dx, dy, dz), square, stiff, volumes, spacing)
        power = fx * (motion[i, 0] - motion[j, 0]) + fy * (motion[i, 1] - motion[j, 1])
        power += fz * (motion[i, 2] - motion[j, 2])
        per_i, per_j = 1.0 / (density[i] * place[i, 3]), 1.0 / (density[j] * place[j, 3])
        if i < count:
            acceleration[i, 0] += fx * per_i
            acceleration[i, 1] += fy * per_i
            acceleration[i, 2] += fz * per_i
            heating[i] -= 0.5 * power * per_i
        if j < count:
            acceleration[j, 0] -= fx * per_j
            acceleration[j, 1] -= fy * per_j
            acceleration[j, 2] -= fz * per_j
            heating[j] -= 0.5 * power * per_j


@njit(**EXACT)
def push_off_plane(
    rows: Whole, axis: int, position: float, inward: float, place: Array, motion: Array,
    density: Array, spacing: float, forces: Forces,
) -> None:  # fmt: skip
    """Add what a plane of symmetry pushes particles by: each meets its own image.

    Parameters
    ----------
    rows : (k,) int array
        Particles that were not neighbours of their images at the start.
    axis : int
    position, inward : float
        Of the plane, m, and the side that is computed.
    place, motion, density, spacing, forces
        As above.
    """
    acceleration, heating = forces
    for q in range(rows.shape[0]):
        i = rows[q]
        apart = 2.0 * inward * (place[i, axis] - position)
        if apart >= spacing:
            continue
        stiff = stiffness(density[i], motion[i, 3]) * place[i, 3]
        push = inward * plane_force(apart, stiff, spacing)
        per = 1.0 / (density[i] * place[i, 3])
        acceleration[i, axis] += push * per
        heating[i] -= push * motion[i, axis] * per
