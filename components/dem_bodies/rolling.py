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

from numba import njit

from quintet.components.dem_bodies.geometry import scaled, three, vector
from quintet.components.dem_bodies.laws import carried
from quintet.components.dem_bodies.state import (
    BLOCK,
    BORNE,
    ELASTIC,
    END_W,
    Balls,
    Model,
    Numbers,
    State,
    W,
)
from quintet.components.shared.rotations import INNER, PURE, Vector, beside, dot, less

DASHPOT = 0.3  # η, share of critical damping; Ai et al. use the same


@njit(**INNER)
def inertia(model: Model, i: int) -> float:
    """Return 1/(I + m R²) [1/(kg m²)] of a ball about a point of its surface; 0 of the ground."""
    if model.inverse_mass[i] == 0.0:
        return 0.0
    return 1.0 / (1.0 / model.inverse_turn[i] + model.reach[i] ** 2 / model.inverse_mass[i])


@njit(**INNER)
def direction(model: Model, motion: Numbers, a: int, b: int) -> Vector:
    """Normal of a pair, to row a from row b or from a plane."""
    rows = motion.shape[0]
    if b >= rows:
        return vector(model.plane, b - rows)
    d = less(vector(motion, a), vector(motion, b))
    return scaled(1.0 / math.sqrt(dot(d, d)), d)


@njit(**INNER)
def across(w: Vector, n: Vector) -> Vector:
    """Part of a vector in the plane of contact."""
    return beside(w, -dot(w, n), n)


@njit(**INNER)
def yielded(spring: Vector, dashpot: Vector, limit: float) -> tuple[Vector, Vector]:
    """Moment [N m] and its elastic part: beyond the limit the spring yields, without dashpot."""
    square = dot(spring, spring)
    if square <= limit * limit:
        return beside(spring, -1.0, dashpot), spring
    spring = scaled(limit / math.sqrt(square), spring)
    return spring, spring


@njit(**PURE)
def resist(
    first: int, last: int, model: Model, state: State, balls: Balls, tally: Numbers, dt: float
) -> None:
    """Add moments against rolling to the pairs of the rows of blocks [first, last)."""
    motion, contact, count = state.motion, state.contact, balls.begin.shape[0] - 1
    rows, ground = motion.shape[0], motion.shape[0] - 1
    for block in range(first, last):
        energy, end, slot = 0.0, min((block + 1) * BLOCK, count), balls.leave[block]
        for k in range(balls.begin[min(block * BLOCK, count)], balls.begin[end]):
            leaves = (block + 1) * BLOCK <= balls.partner[k] < rows
            slot += leaves
            if balls.held[k, 3] == 0.0:
                balls.roll[k] = 0.0
                continue
            i, j = balls.row[k], min(balls.partner[k], ground)
            n = direction(model, motion, i, balls.partner[k])
            other, radius = model.material[j], model.reach[i]
            if balls.partner[k] >= rows:
                other = model.plane_material[balls.partner[k] - rows]
            else:
                radius = 1.0 / (1.0 / radius + 1.0 / model.reach[j])
            reach = model.law[model.material[i], other, 4] * radius
            if reach == 0.0:
                continue
            c = balls.constants[balls.law[k]]
            stiffness = 2.25 * 1.5 * c[0] / balls.held[k, 3] * reach * reach
            damping = 2.0 * DASHPOT * math.sqrt(stiffness / (inertia(model, i) + inertia(model, j)))
            limit = reach * max(0.0, dot(vector(balls.force, k), n))
            mean = across(less(three(motion, i, W), three(motion, j, W)), n)
            after = across(less(three(motion, i, END_W), three(motion, j, END_W)), n)
            spring = carried(vector(balls.roll, k), n, 1.0)
            spring = beside(spring, -stiffness * dt, mean)
            moment, spring = yielded(spring, scaled(damping, after), limit)
            for d in range(3):
                balls.roll[k, d] = spring[d]
                contact[i, 3 + d] += moment[d]
                if leaves:
                    balls.push[slot - 1, 3 + d] -= moment[d]
                elif j < ground:
                    contact[j, 3 + d] -= moment[d]
                else:
                    tally[block, BORNE + 3 + d] -= moment[d]
            energy += 0.5 * dot(spring, spring) / stiffness
        tally[block, ELASTIC] += energy
