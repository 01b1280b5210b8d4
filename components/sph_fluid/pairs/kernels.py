"""Loops over pairs beside that of the fluid: forces on samples, XSPH, damper and filter."""

import numpy as np
from numba import njit

from quintet.components.shared.numba_options import EXACT, FAST
from quintet.components.shared.search.neighbours import Lists
from quintet.components.shared.smoothing.smoothing import gradient, kernel
from quintet.components.sph_fluid.kernels import BoundaryRows, Particles
from quintet.components.sph_fluid.laws import (
    Constants,
    PairLaw,
    add_pair_force,
    contact_factor,
    damped_pressure_term,
    inverses,
    pressure_term,
)
from quintet.components.sph_fluid.state import Array, Whole

NO_FLUID = 1e-2  # Σ V W below which there is no fluid around a mirror point


@njit(**EXACT)
def write_damped_pressure(
    first: int, last: int, strength: float, minus_rho_div_u: Array, position: Array,
    velocity: Array, constants: Constants,
) -> None:  # fmt: skip
    """Write p/ρ² of rows [first, last) as if strength [m2/s] · -ρ∇·u [kg/(m3 s)] were pressure."""
    for i in range(first, last):
        velocity[i, 3] = damped_pressure_term(
            position[i, 3], minus_rho_div_u[i], strength, constants
        )


@njit(**FAST)
def add_mirrored_damping(
    first: int, last: int, split: int, mirror_point: Array, position: Array, velocity: Array,
    lists: Lists, mask: Array, constants: Constants,
) -> None:  # fmt: skip
    """Add the damper's mean part around their mirror points to p/ρ² of boundary rows.

    Not where a contact potential acts, by the mask (n,), or (0,) if it does nowhere: stiffness
    stands there in place of p/ρ².
    """
    begin, _, end, neighbour = lists
    for b in range(first, last):
        i = split + b
        if mask.shape[0] > 0 and mask[i] != 0.0:
            continue
        x, y, z = mirror_point[b, 0], mirror_point[b, 1], mirror_point[b, 2]
        weights, sums = 0.0, 0.0
        for k in range(np.uint64(begin[i]), np.uint64(end[i])):
            j = np.uint64(neighbour[k])
            dx, dy, dz = position[j, 0] - x, position[j, 1] - y, position[j, 2] - z
            r2 = dx * dx + dy * dy + dz * dz
            weight = kernel(r2, constants.smoothing) * constants.mass / position[j, 3]
            weights += weight
            sums += weight * (velocity[j, 3] - pressure_term(position[j, 3], constants))
        if weights >= NO_FLUID:
            velocity[i, 3] = max(velocity[i, 3] + sums / weights, 0.0)


@njit(**FAST)
def filter_density(
    first: int, last: int, position: Array, lists: Lists, constants: Constants, density: Array
) -> None:
    """Write Σ_j m_j W_ij / Σ_j (m_j/ρ_j) W_ij [kg/m3] over the fluid, j = i included.

    References
    ----------
    Panizzo, PhD thesis, L'Aquila (2004).
    """
    begin, middle, _, neighbour = lists
    for i in range(first, last):
        x, y, z = position[i, 0], position[i, 1], position[i, 2]
        weights, volumes = 0.0, 0.0
        for k in range(np.uint64(begin[i]), np.uint64(middle[i])):
            j = np.uint64(neighbour[k])
            dx, dy, dz = x - position[j, 0], y - position[j, 1], z - position[j, 2]
            weight = kernel(dx * dx + dy * dy + dz * dz, constants.smoothing)
            weights += weight
            volumes += weight / position[j, 3]
        density[i] = weights / volumes


@njit(**FAST)
def sample_forces(
    first: int, last: int, number: Whole, row: Whole, listed: Whole, particles: Particles,
    boundary: BoundaryRows, lists: Lists, law: PairLaw, force: Array,
) -> None:  # fmt: skip
    """Write the force on surface samples: pair by pair, minus that on the fluid.

    Parameters
    ----------
    first, last : int
        Which of the samples of this rank to write.
    number, row, listed : (k,) int array
        Of these: which of all they are, where they stand among the particles, and where the lists
        have what is around them.
    particles, boundary, lists, law
    force : (samples, 3) float array, N
        Written.
    """
    begin, _, end, neighbour = lists
    position, velocity = particles
    apparent, volume, mask = boundary
    constants, terms = law.constants, law.boundary
    zero = position.dtype.type(0)
    for s in range(first, last):
        i = row[s]
        x, y, z, density = position[i, 0], position[i, 1], position[i, 2], position[i, 3]
        u, v, w, pressure = velocity[i, 0], velocity[i, 1], velocity[i, 2], velocity[i, 3]
        on_sample = zero, zero, zero
        for k in range(np.uint64(begin[listed[s]]), np.uint64(end[listed[s]])):
            j = np.uint64(neighbour[k])
            dx, dy, dz = x - position[j, 0], y - position[j, 1], z - position[j, 2]
            r2 = dx * dx + dy * dy + dz * dz
            du, dv, dw = u - velocity[j, 0], v - velocity[j, 1], w - velocity[j, 2]
            dot = dx * du + dy * dv + dz * dw
            density_sum = density + position[j, 3] + constants.base + constants.base
            per_r, per_r2, per_density = inverses(r2, density_sum, constants)
            slope = gradient(r2, per_r, constants.smoothing)
            if terms.volume is not None:
                slope *= volume[i]
            pressure_i = pressure
            if terms.contact.on is not None:
                acts = zero
                if terms.contact.partial is not None:
                    acts = mask[i]
                pressure_i = pressure * contact_factor(r2, acts, terms.contact, constants.smoothing)
            apparent_i = u, v, w
            if terms.viscosity.on is not None:
                apparent_i = apparent[i, 0], apparent[i, 1], apparent[i, 2]
            velocity_j = velocity[j, 0], velocity[j, 1], velocity[j, 2]
            on_sample = add_pair_force(
                on_sample, (dx, dy, dz), apparent_i, velocity_j, r2, pressure_i + velocity[j, 3],
                dot * per_r2, slope, per_r2, per_density, terms,
            )  # fmt: skip
        for d in range(3):
            force[number[s], d] = constants.mass * constants.mass * on_sample[d]


@njit(**EXACT)
def move_by(first: int, last: int, time: float, velocity: Array, position: Array) -> None:
    """Move rows [first, last) with velocities (fluid, 3) m/s for a time [s]."""
    for i in range(first, last):
        for d in range(3):
            position[i, d] += time * velocity[i, d]
