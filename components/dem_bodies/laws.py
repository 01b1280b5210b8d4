"""Contact of one pair: Hertz's normal force with damping, Mindlin's tangential force with friction.

F_n = 4/3 E* √R* δ^{3/2} + 2√(5/6) ζ √(S_n m*) dδ/dt ≥ 0,     S_n = 2 E* √(R* δ)
dF_t = -S_t v_t dt, with 2√(5/6) ζ √(S_t m*) v_t, |F_t| ≤ μ F_n,  S_t = 8 G* √(R* δ)

What does not change while two bodies touch is gathered in one row, so that a step of a contact
needs few roots: F_n = k_n δ^{3/2} + c_n δ^{1/4} dδ/dt, S_t = k_t √δ, damped by c_t δ^{1/4}.
"""

import math

from numba import njit

from quintet.components.shared.numba_options import INNER
from quintet.components.shared.rotations import Vector, axpy, dot, scaled

DAMPING = 2.0 * math.sqrt(5.0 / 6.0)
LEAST = 1e-200  # smaller numbers count as zero
ROLLING_STIFFNESS = 2.25
ROLLING_DAMPING = 0.3  # η, share of critical damping; Ai et al. use the same

# k_n, k_t, c_n, c_t, μ, S_n/(m* √δ) and 1/k_t of a pair.
Constants = tuple[float, float, float, float, float, float, float]


@njit(**INNER)
def pair_constants(
    modulus: float, shear: float, ζ: float, μ: float, radius: float, mass: float
) -> Constants:
    """Constants of a pair, from which its forces follow by few roots.

    Parameters
    ----------
    modulus, shear : float, Pa
        E* and G*.
    ζ, μ : float
        Damping ratio and coefficient of friction.
    radius : float, m
        R*, 1/R* = Σ 1/R.
    mass : float, kg
        m*, the mass that resists at the point of contact.

    Returns
    -------
    k_n, k_t, c_n, c_t, μ, S_n/(m* √δ), 1/k_t

    References
    ----------
    Hertz (1882), J. reine angew. Math. 92, 156; Mindlin & Deresiewicz (1953), J. Appl. Mech. 20,
    327; Tsuji, Tanaka & Ishida (1992), Powder Technol. 71, 239 (the damping).
    """
    root = math.sqrt(radius)
    normal, tangential = 2.0 * modulus * root, 8.0 * shear * root
    damping = DAMPING * ζ * math.sqrt(mass)
    return (
        2.0 / 3.0 * normal,
        tangential,
        damping * math.sqrt(normal),
        damping * math.sqrt(tangential),
        μ,
        normal / mass,
        1.0 / tangential,
    )


@njit(**INNER)
def first_step_weight(share: float) -> float:
    """Weight of the damping force at the end of the step in which a contact begins.

    That force grows as t^{1/4} from the moment of touching, a `share` of the step ago. Two
    trapezia would miss its impulse over this step and the next, 4/5 (1 + share)^{5/4}, by more
    than all other errors of an impact, and differently with every share.

    Parameters
    ----------
    share : float, 0 to 1
        Part of the step since the bodies touched.

    Returns
    -------
    float
    """
    return ((1.0 + share) / share) ** 0.25 * (0.8 * share + 0.3)


@njit(**INNER)
def rotate_tangential_force(force: Vector, normal: Vector, scale: float) -> Vector:
    """Elastic tangential force in the plane of contact that has rotated.

    Parameters
    ----------
    force : (3,) N
        Of the last step.
    normal : (3,)
        Present unit normal.
    scale : float
        By which the force changes as the contact does.

    Returns
    -------
    (3,) N
        In the plane of contact, `scale` times as large as before.
    """
    x, y, z = axpy(-dot(force, normal), normal, force)
    scale *= math.sqrt(dot(force, force) / max(x * x + y * y + z * z, LEAST))
    return scale * x, scale * y, scale * z


@njit(**INNER)
def limit_friction(
    elastic: Vector, slip: Vector, damping: float, limit: float
) -> tuple[Vector, Vector]:
    """Tangential force and its elastic part, within Coulomb's limit.

    Spring and damper slip by the same share. To give the spring the whole force would store
    energy that only the damper has taken.

    Parameters
    ----------
    elastic : (3,) N
        Of the spring, were there no limit.
    slip : (3,) m/s
        Tangential velocity of the first body over the other.
    damping : float, N s/m
    limit : float, N
        μ F_n.

    Returns
    -------
    force, elastic : (3,) N

    References
    ----------
    Mindlin & Deresiewicz (1953), J. Appl. Mech. 20, 327 (the spring); Tsuji, Tanaka & Ishida
    (1992), Powder Technol. 71, 239 (the damper).
    """
    x, y, z = axpy(-damping, slip, elastic)
    share = limit / max(max(math.sqrt(x * x + y * y + z * z), limit), LEAST)
    spring = share * elastic[0], share * elastic[1], share * elastic[2]
    return (share * x, share * y, share * z), spring


@njit(**INNER)
def damping_weight(before: float, depth: float, closing: float, dt: float) -> float:
    """Weight of the damping force: 1, but in the step in which a contact begins.

    Parameters
    ----------
    before : float, m^-1/2
        1/√δ of the last step; 0 in a contact that begins.
    depth : float, m
        Present overlap.
    closing : float, m/s
        Velocity at which the bodies approach each other.
    dt : float, s

    Returns
    -------
    float
    """
    if before == 0.0 and depth > 0.0 and closing * dt > 0.0:
        return first_step_weight(min(1.0, depth / (closing * dt)))
    return 1.0


@njit(inline="always", **INNER)
def contact_force(
    c: Constants, tangential: Vector, before: float, n: Vector, depth: float, roots: Vector,
    weight: float, mean: Vector, end: Vector, dt: float,
) -> tuple[Vector, Vector, float]:  # fmt: skip
    """Force on the first of two bodies in contact, its elastic tangential part, and energy.

    There are no branches, so that several contacts can be computed at once: without depth all is
    zero.

    Parameters
    ----------
    c : Constants
        Of the pair, as `pair_constants` gives them.
    tangential : (3,) N
        Elastic tangential force of the last step; 0 in a contact that begins.
    before : float, m^-1/2
        1/√δ of the last step; 0 in a contact that begins.
    n : (3,)
        Unit normal, towards the first body.
    depth : float, m
        Overlap δ ≥ 0.
    roots : √δ, δ^{1/4} and 1/√δ
    weight : float
        Of the damping, as `damping_weight` gives it.
    mean, end : (3,) m/s
        Velocity of the point of contact over the other body's, the mean of the step and at its end.
    dt : float, s

    Returns
    -------
    force : (3,) N
    tangential : (3,) N
        Its elastic tangential part.
    energy : float, J
        Held by both springs.

    References
    ----------
    Hertz (1882); Tsuji, Tanaka & Ishida (1992); Antypov & Elliott (2011), EPL 94, 50004 (the
    damping as a share of the critical one); Walton & Braun (1986), J. Rheol. 30, 949 (the spring
    shrinks with the area on unloading); Schwager & Pöschel (2007), Granular Matter 9, 465 (the
    force is never a pull).
    """
    root, quarter, inverse = roots
    opening = dot(end, n)
    elastic = c[0] * root * depth
    normal = max(0.0, elastic - weight * c[2] * quarter * opening)
    # Tangential: the elastic part turns with the contact, shrinks with its area on unloading
    # and grows with the mean slip of the step.
    spring = rotate_tangential_force(tangential, n, min(1.0, root * before))
    spring = axpy(-c[1] * root * dt, axpy(-dot(mean, n), n, mean), spring)
    slip = axpy(-opening, n, end)
    side, spring = limit_friction(spring, slip, c[3] * quarter, c[4] * normal)
    energy = 0.4 * elastic * depth + 0.5 * dot(spring, spring) * inverse * c[6]
    return axpy(normal, n, side), spring, energy


@njit(**INNER)
def limit_rolling(spring: Vector, dashpot: Vector, limit: float) -> tuple[Vector, Vector]:
    """Rolling moment and its elastic part: a spring that yields, then without dashpot.

    Parameters
    ----------
    spring, dashpot : (3,) N m
    limit : float, N m
        μ_r R* F_n.

    Returns
    -------
    moment, spring : (3,) N m

    References
    ----------
    Ai, Chen, Rotter & Ooi (2011), Powder Technol. 206, 269, eqs. 14 to 23.
    """
    square = dot(spring, spring)
    if square <= limit * limit:
        return axpy(-1.0, dashpot, spring), spring
    spring = scaled(limit / math.sqrt(square), spring)
    return spring, spring
