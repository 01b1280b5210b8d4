"""Rolling resistance of balls: the elastic-plastic spring and dashpot of Ai et al. (2011).

Their model C. A spring in rolling yields at the moment μ_r R* F_n; a dashpot beside it acts while
it does not yield, so that a ball comes to rest and stays, which a moment of constant size
against the rolling (their model A) cannot do:

    dM = -k_r ω dt, |M| ≤ μ_r R* F_n,  k_r = 2.25 S_n (μ_r R*)²,  C_r = 2 η √(I_r k_r)

with ω the part of the relative angular velocity in the plane of contact (what twists about the
normal is free) and 1/I_r = Σ 1/(I + m R²). Compiled only for scenes with such a material.

Ai, Chen, Rotter & Ooi, Powder Technol. 206 (2011) 269, eqs. 14 to 23; k_r as Iwashita & Oda,
J. Eng. Mech. 124 (1998) 285.
"""

import math

import numpy as np
from numba import njit

from quintet.components.dem_bodies.kernels.geometry import row_vector
from quintet.components.dem_bodies.laws import (
    ROLLING_DAMPING,
    ROLLING_STIFFNESS,
    limit_rolling,
    rotate_tangential_force,
)
from quintet.components.dem_bodies.state import (
    BLOCK,
    ELASTIC_ENERGY,
    END_OMEGA,
    GROUND_LOAD,
    OMEGA,
    BallPairs,
    Model,
    Numbers,
    Short,
    State,
)
from quintet.components.shared.numba_options import EXACT, INNER
from quintet.components.shared.rotations import Vector, axpy, dot, scaled, sub


@njit(**INNER)
def inverse_surface_inertia(inverse_mass: float, inverse_moment: float, radius: float) -> float:
    """Return 1/(I + m R²) [1/(kg m²)] of a ball of a radius [m], about a point of its surface."""
    return 1.0 / (1.0 / inverse_moment + radius**2 / inverse_mass)


@njit(**INNER)
def inverse_rolling_inertia(model: Model, i: int) -> float:
    """Return 1/(I + m R²) [1/(kg m²)] of a ball about a point of its surface; 0 of the ground."""
    if model.inverse_mass[i] == 0.0:
        return 0.0
    inverse_mass, inverse_moment = model.inverse_mass[i], model.inverse_moment[i]
    return inverse_surface_inertia(inverse_mass, inverse_moment, model.bounding_radius[i])


@njit(**INNER)
def contact_normal(model: Model, motion: Numbers, a: int, b: int) -> Vector:
    """Normal of a pair, to row a from row b or from a plane."""
    rows = motion.shape[0]
    if b >= rows:
        return row_vector(model.plane, b - rows)
    d = sub(row_vector(motion, a), row_vector(motion, b))
    return scaled(1.0 / math.sqrt(dot(d, d)), d)


@njit(**INNER)
def in_contact_plane(w: Vector, n: Vector) -> Vector:
    """Part of a vector in the plane of contact."""
    return axpy(-dot(w, n), n, w)


@njit(**INNER)
def resistance(
    spring: Vector, n: Vector, k_n: float, inverse_root: float, arm: float, inverse: float,
    force: Vector, mean: Vector, end: Vector, dt: float,
) -> tuple[Vector, Vector, float]:  # fmt: skip
    """Moment on the first ball of a pair that touches, its elastic part, and its energy.

    Parameters
    ----------
    spring : (3,) N m
        Elastic moment of the last step.
    n : (3,)
        Unit normal, towards the first ball.
    k_n : float, N/m^1.5
        Of the pair, as `pair_constants` gives it.
    inverse_root : float, m^-1/2
        1/√δ.
    arm : float, m
        μ_r R*.
    inverse : float, 1/(kg m²)
        1/I_r.
    force : (3,) N
        On the first ball.
    mean, end : (3,) rad/s
        Relative angular velocity, the mean of the step and at its end.
    dt : float, s

    Returns
    -------
    moment, spring : (3,) N m
    energy : float, J
    """
    stiffness = ROLLING_STIFFNESS * 1.5 * k_n / inverse_root * arm * arm
    damping = 2.0 * ROLLING_DAMPING * math.sqrt(stiffness / inverse)
    limit = arm * max(0.0, dot(force, n))
    spring = rotate_tangential_force(spring, n, 1.0)
    spring = axpy(-stiffness * dt, in_contact_plane(mean, n), spring)
    dashpot = scaled(damping, in_contact_plane(end, n))
    moment, spring = limit_rolling(spring, dashpot, limit)
    return moment, spring, 0.5 * dot(spring, spring) / stiffness


@njit(**INNER)
def rolling_arm(model: Model, i: int, b: int, rows: int) -> float:
    """Return μ_r R* [m] of a ball and its partner: another ball, or beyond all rows a plane."""
    if b >= rows:
        other, radius = model.plane_material[b - rows], model.bounding_radius[i]
    else:
        other = model.material[b]
        radius = 1.0 / (1.0 / model.bounding_radius[i] + 1.0 / model.bounding_radius[b])
    return float(model.material_pairs[model.material[i], other, 4] * radius)


@njit(**EXACT)
def rolling_constants(model: Model, row: Short, partner: Short) -> Numbers:
    """μ_r R* [m] and 1/I_r [1/(kg m²)] of pairs: (pairs, 2)."""
    rows, ground = model.kind.shape[0], model.kind.shape[0] - 1
    constants = np.empty((partner.shape[0], 2))
    for k in range(partner.shape[0]):
        i, b = row[k], partner[k]
        inverse = inverse_rolling_inertia(model, i)
        constants[k, 0] = rolling_arm(model, i, b, rows)
        constants[k, 1] = inverse + inverse_rolling_inertia(model, min(b, ground))
    return constants


@njit(**INNER)
def rolling_moments(
    block: int, model: Model, state: State, pairs: BallPairs, rolling_moment: Numbers,
    sums: Numbers, dt: float,
) -> None:  # fmt: skip
    """Add moments against rolling [N m] to the contact loads of a block's pairs and partners."""
    motion, load, count = state.motion, state.contact_load, pairs.begin.shape[0] - 1
    rows, ground = motion.shape[0], motion.shape[0] - 1
    energy, slot = 0.0, pairs.outgoing_begin[block]
    first, last = min(block * BLOCK, count), min((block + 1) * BLOCK, count)
    for k in range(pairs.begin[first], pairs.begin[last]):
        b = pairs.partner[k]
        leaves = (block + 1) * BLOCK <= b < rows
        slot += leaves
        if pairs.history[3, k] == 0.0:
            rolling_moment[k] = 0.0
            continue
        i, j = pairs.row[k], min(b, ground)
        arm = rolling_arm(model, i, b, rows)
        if arm == 0.0:
            continue
        n, c = contact_normal(model, motion, i, b), pairs.constants[pairs.constants_row[k]]
        inverse = inverse_rolling_inertia(model, i) + inverse_rolling_inertia(model, j)
        mean = sub(row_vector(motion, i, OMEGA), row_vector(motion, j, OMEGA))
        end = sub(row_vector(motion, i, END_OMEGA), row_vector(motion, j, END_OMEGA))
        moment, spring, stored = resistance(
            row_vector(rolling_moment, k), n, c[0], pairs.history[3, k], arm, inverse,
            row_vector(pairs.force, k), mean, end, dt,
        )  # fmt: skip
        for d in range(3):
            rolling_moment[k, d] = spring[d]
            load[i, 3 + d] += moment[d]
            if leaves:
                pairs.outgoing[slot - 1, 3 + d] -= moment[d]
            elif j < ground:
                load[j, 3 + d] -= moment[d]
            else:
                sums[block, GROUND_LOAD + 3 + d] -= moment[d]
        energy += stored
    sums[block, ELASTIC_ENERGY] += energy
