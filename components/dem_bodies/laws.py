"""Contact of one pair: Hertz's normal force with damping, Mindlin's tangential force with friction.

F_n = 4/3 E* √R* δ^{3/2} + 2√(5/6) ζ √(S_n m*) dδ/dt ≥ 0,     S_n = 2 E* √(R* δ)
dF_t = -S_t v_t dt, with 2√(5/6) ζ √(S_t m*) v_t, |F_t| ≤ μ F_n,  S_t = 8 G* √(R* δ)
"""

import math

from numba import njit

from quintet.components.shared.rotations import INNER, Vector, beside, dot

DAMPING = 2.0 * math.sqrt(5.0 / 6.0)


@njit(**INNER)
def normal_force(
    modulus: float, root: float, depth: float, damping: float, mass: float, closing: float
) -> tuple[float, float]:
    """Force [N], never a pull, and its elastic part; root = √(R* δ), damping = ζ."""
    elastic = 4.0 / 3.0 * modulus * root * depth
    damped = DAMPING * damping * math.sqrt(2.0 * modulus * root * mass) * closing
    return max(0.0, elastic + damped), elastic


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
    before, after = dot(force, force), x * x + y * y + z * z
    if after > 0.0:
        scale *= math.sqrt(before / after)
    return scale * x, scale * y, scale * z


@njit(**INNER)
def friction(elastic: Vector, slip: Vector, damping: float, limit: float) -> tuple[Vector, Vector]:
    """Tangential force [N] and its elastic part, within Coulomb's limit; slip velocity in m/s."""
    x, y, z = beside(elastic, -damping, slip)
    size = math.sqrt(x * x + y * y + z * z)
    if size <= limit:
        return (x, y, z), elastic
    # Spring and damper slip by the same share. To give the spring the whole force would store
    # energy that only the damper has taken.
    scale = limit / size
    held = scale * elastic[0], scale * elastic[1], scale * elastic[2]
    return (scale * x, scale * y, scale * z), held
