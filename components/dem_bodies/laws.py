"""Contact of one pair: Hertz's normal force with damping, Mindlin's tangential force with friction.

F_n = 4/3 E* √R* δ^{3/2} + 2√(5/6) ζ √(S_n m*) dδ/dt ≥ 0,     S_n = 2 E* √(R* δ)
dF_t = -S_t v_t dt, with 2√(5/6) ζ √(S_t m*) v_t, |F_t| ≤ μ F_n,  S_t = 8 G* √(R* δ)

What does not change while two bodies touch is gathered in one row, so that a step of a contact
needs few roots: F_n = k_n δ^{3/2} + c_n δ^{1/4} dδ/dt, S_t = k_t √δ, damped by c_t δ^{1/4}.
"""

import math

from numba import njit

from quintet.components.shared.rotations import INNER, Vector, beside, dot

DAMPING = 2.0 * math.sqrt(5.0 / 6.0)
LEAST = 1e-200  # what is smaller counts as nothing

# k_n, k_t, c_n, c_t, μ, S_n/(m* √δ) and 1/k_t of a pair.
Constants = tuple[float, float, float, float, float, float, float]


@njit(**INNER)
def constants(
    modulus: float, shear: float, ζ: float, μ: float, radius: float, mass: float
) -> Constants:
    """Row of a pair with E*, G* [Pa], R* [m] and m* [kg]."""
    root = math.sqrt(radius)
    normal, side = 2.0 * modulus * root, 8.0 * shear * root
    damping = DAMPING * ζ * math.sqrt(mass)
    return (
        2.0 / 3.0 * normal,
        side,
        damping * math.sqrt(normal),
        damping * math.sqrt(side),
        μ,
        normal / mass,
        1.0 / side,
    )


@njit(**INNER)
def first_weight(share: float) -> float:
    """Weight of the damping force at the end of the step in which a contact begins.

    That force grows as t^{1/4} from the moment of touching, a `share` of the step ago. Two
    trapezia would miss its impulse over this step and the next, 4/5 (1 + share)^{5/4}, by more
    than all other errors of an impact, and differently with every share.
    """
    return ((1.0 + share) / share) ** 0.25 * (0.8 * share + 0.3)


@njit(**INNER)
def carried(force: Vector, normal: Vector, scale: float) -> Vector:
    """Elastic tangential force after the contact plane has turned, times a scale."""
    x, y, z = beside(force, -dot(force, normal), normal)
    scale *= math.sqrt(dot(force, force) / max(x * x + y * y + z * z, LEAST))
    return scale * x, scale * y, scale * z


@njit(**INNER)
def friction(elastic: Vector, slip: Vector, damping: float, limit: float) -> tuple[Vector, Vector]:
    """Tangential force [N] and its elastic part, within Coulomb's limit; slip velocity in m/s.

    Spring and damper slip by the same share. To give the spring the whole force would store
    energy that only the damper has taken.
    """
    x, y, z = beside(elastic, -damping, slip)
    share = limit / max(max(math.sqrt(x * x + y * y + z * z), limit), LEAST)
    held = share * elastic[0], share * elastic[1], share * elastic[2]
    return (share * x, share * y, share * z), held


@njit(**INNER)
def beginning(before: float, depth: float, closing: float, dt: float) -> float:
    """Weight of the damping force: 1, but in the step in which a contact begins."""
    if before == 0.0 and depth > 0.0 and closing * dt > 0.0:
        return first_weight(min(1.0, depth / (closing * dt)))
    return 1.0


@njit(inline="always", **INNER)
def contact(
    c: Constants, held: Vector, before: float, n: Vector, depth: float, roots: Vector,
    first: float, mean: Vector, end: Vector, dt: float,
) -> tuple[Vector, Vector, float]:  # fmt: skip
    """Force [N] on the first of two bodies, its elastic tangential part, and energy [J].

    There are no branches, so that several contacts can be computed at once: without depth all is
    zero. `held` is the elastic tangential part of the last step and `before` its 1/√δ, both 0
    in a contact that begins; `roots` are √δ, its root, and 1/√δ; `first` weighs the damping;
    `mean` and `end` are relative velocities [m/s] of the point of contact, the mean of the step
    and at its end; the normal n points to the first body.
    """
    root, quarter, inverse = roots
    opening = dot(end, n)
    elastic = c[0] * root * depth
    normal = max(0.0, elastic - first * c[2] * quarter * opening)
    # Tangential: the elastic part turns with the contact, shrinks with its area on unloading
    # (Walton & Braun 1986) and grows with the mean slip of the step.
    spring = carried(held, n, min(1.0, root * before))
    spring = beside(spring, -c[1] * root * dt, beside(mean, -dot(mean, n), n))
    side, spring = friction(spring, beside(end, -opening, n), c[3] * quarter, c[4] * normal)
    energy = 0.4 * elastic * depth + 0.5 * dot(spring, spring) * inverse * c[6]
    return beside(side, normal, n), spring, energy
