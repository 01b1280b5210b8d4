"""Physics of one pair of particles; numba inlines it into the loops.

A particle has the volume V at the start, η = ρ/ρ₀ and τ = σ/η². Of velocity's gradient L

    η L_i = Σ_j V_j (v_j - v_i) ⊗ ∇_iW_ij,   dη_i/dt = -tr η L_i
    m_i a_i = V_i Σ_j V_j (τ_i + τ_j - q_ij) ∇_iW_ij,   m_i de_i/dt = V_i τ_i : η L_i + ½ …

so that what strains take from motion is what they add to energies, whatever the densities of two
materials that meet: of one material it is Monaghan's form σ_i/ρ_i² + σ_j/ρ_j².

Papers: Monaghan, Rep. Prog. Phys. 68 (2005) 1703; Libersky, Petschek, Carney, Hipp & Allahdadi,
J. Comput. Phys. 109 (1993) 67; Bonet & Lok, Comput. Methods Appl. Mech. Eng. 180 (1999) 97.
"""

import math
from typing import NamedTuple

from numba import njit

from quintet.components.shared.smoothing.cubic_spline import ONE
from quintet.components.shared.smoothing.smoothing import Smoothing, kernel

SINGULAR = 0.15  # determinant of Σ V_j (x_j - x_i) ⊗ ∇W_ij, below which none is corrected
On = bool | None


class PairLaw(NamedTuple):
    """The numbers of pairs."""

    smoothing: Smoothing
    softening: float  # m2, 0.01h², added to r² where velocities are divided by it
    linear: float  # α
    quadratic: float  # β
    plane: float  # 1 in two dimensions, 0 in three
    corrected: On  # None if gradients are not corrected
    artificial: float | None  # ε of the artificial stress; None without
    per_spacing: float  # m3, one over W at the spacing of the start; m2 in two dimensions


@njit(inline="always")
def inverses(r2, density_sum, law):  # type: ignore[no-untyped-def]
    """1/r [1/m], 1/(r² + 0.01h²) [1/m2] and one over the sum of two densities, of one division."""
    r, softened = math.sqrt(r2 + law.smoothing.tiny), r2 + law.softening
    each = ONE / (r * softened * density_sum)
    return each * softened * density_sum, each * r * density_sum, each * r * softened


@njit(inline="always")
def viscous_pressure(mu, sound_sum, per_density, densities, law):  # type: ignore[no-untyped-def]
    """Monaghan's artificial viscosity, as a pressure over η².

    Parameters
    ----------
    mu : float, m/s
        |μ| = -h v·r/(r² + 0.01h²) of two that come nearer, 0 of others.
    sound_sum : float, m/s
    per_density : float, m3/kg
        One over the sum of their densities.
    densities : float, kg2/m6
        Product of their densities at the start.

    Returns
    -------
    float, Pa
        q = ρ₀_i ρ₀_j (α c̄ |μ| + β μ²)/ρ̄.

    References
    ----------
    Monaghan, Annu. Rev. Astron. Astrophys. 30 (1992) 543, eq. (4.2).
    """
    drag = law.linear * sound_sum + 2.0 * law.quadratic * mu
    return mu * drag * densities * per_density


@njit(inline="always")
def add_outer(sums, change, slope):  # type: ignore[no-untyped-def]
    """Add the outer product of two vectors to nine sums, by rows."""
    m00, m01, m02, m10, m11, m12, m20, m21, m22 = sums
    u, v, w = change
    x, y, z = slope
    return (
        m00 + u * x, m01 + u * y, m02 + u * z, m10 + v * x, m11 + v * y, m12 + v * z, m20 + w * x,
        m21 + w * y, m22 + w * z,
    )  # fmt: skip


@njit(inline="always")
def add_moments(sums, offset, slope):  # type: ignore[no-untyped-def]
    """Add (x_j - x_i) ⊗ V_j ∇W_ij, of offsets x_i - x_j, to six sums xx yy zz xy yz zx."""
    xx, yy, zz, xy, yz, zx = sums
    dx, dy, dz = offset
    x, y, z = slope
    return xx - dx * x, yy - dy * y, zz - dz * z, xy - dx * y, yz - dy * z, zx - dz * x


@njit(inline="always")
def add_force(sums, offset, change, dot, weight, stress, q, push, law):  # type: ignore[no-untyped-def]
    """Add V_j (τ_i + τ_j - q_ij) ∇W_ij and its heat to four sums.

    Parameters
    ----------
    sums : four floats
    offset, change : three floats each, m and m/s
        x_i - x_j and v_i - v_j.
    dot : float, m2/s
        Their product.
    weight : float
        V_j (dW/dr)/r.
    stress : nine floats, Pa
        τ_i + τ_j, by rows.
    q : float, Pa
        Of the artificial viscosity.
    push : three floats, Pa m
        Artificial stress times the offset, of a law that has it.
    law : PairLaw
    """
    fx, fy, fz, heat = sums
    dx, dy, dz = offset
    t00, t01, t02, t10, t11, t12, t20, t21, t22 = stress
    t00, t11, t22 = t00 - q, t11 - q, t22 - q
    x, y, z = (
        t00 * dx + t01 * dy + t02 * dz,
        t10 * dx + t11 * dy + t12 * dz,
        t20 * dx + t21 * dy + t22 * dz,
    )
    work = q * dot
    if law.artificial is not None:
        x, y, z = x + push[0], y + push[1], z + push[2]
        work -= push[0] * change[0] + push[1] * change[1] + push[2] * change[2]
    return fx + weight * x, fy + weight * y, fz + weight * z, heat + weight * work


@njit(inline="always")
def stable_step(sound, mu, law):  # type: ignore[no-untyped-def]
    """Step [s] of a particle of a speed of sound [m/s] and the greatest |μ| [m/s] of its pairs.

    References
    ----------
    Monaghan, Annu. Rev. Astron. Astrophys. 30 (1992) 543, section 10.3.
    """
    drag = law.linear * sound + law.quadratic * mu
    return law.smoothing.length / (sound + 1.2 * drag)


@njit(inline="always")
def nearness(r2, law):  # type: ignore[no-untyped-def]
    """Share f⁴, f = W(r)/W(Δ), of the artificial stress that two particles feel at a distance r.

    References
    ----------
    Monaghan, J. Comput. Phys. 159 (2000) 290; Gray, Monaghan & Swift, Comput. Methods Appl. Mech.
    Eng. 190 (2001) 6641.
    """
    f = kernel(r2, law.smoothing) * law.per_spacing
    return f * f * f * f


@njit(inline="always")
def repelled(stress, offset, r2, law):  # type: ignore[no-untyped-def]
    """f⁴ (R_i + R_j)·r_ij [Pa m] of the sum of two artificial stresses, six numbers."""
    xx, yy, zz, xy, yz, zx = stress
    dx, dy, dz = offset
    f = nearness(r2, law)
    xx, yy, zz, xy, yz, zx = f * xx, f * yy, f * zz, f * xy, f * yz, f * zx
    return (
        xx * dx + xy * dy + zx * dz,
        xy * dx + yy * dy + yz * dz,
        zx * dx + yz * dy + zz * dz,
    )


@njit(inline="always")
def inverse(k, law):  # type: ignore[no-untyped-def]
    """Inverse of a symmetric matrix xx yy zz xy yz zx, and its determinant.

    In two dimensions it has nothing along y, where the inverse is 1.
    """
    xx, yy, zz, xy, yz, zx = k
    yy += law.plane
    a, b, c = yy * zz - yz * yz, zx * yz - xy * zz, xy * yz - zx * yy
    determinant = xx * a + xy * b + zx * c
    per = 1.0 / determinant if determinant != 0.0 else 0.0
    inverted = (
        a * per,
        (xx * zz - zx * zx) * per,
        (xx * yy - xy * xy) * per,
        b * per,
        (xy * zx - xx * yz) * per,
        c * per,
    )
    return inverted, determinant


@njit(inline="always")
def times(m, b):  # type: ignore[no-untyped-def]
    """Product of a matrix (nine, by rows) and a symmetric one xx yy zz xy yz zx."""
    m00, m01, m02, m10, m11, m12, m20, m21, m22 = m
    xx, yy, zz, xy, yz, zx = b
    return (
        m00 * xx + m01 * xy + m02 * zx,
        m00 * xy + m01 * yy + m02 * yz,
        m00 * zx + m01 * yz + m02 * zz,
        m10 * xx + m11 * xy + m12 * zx,
        m10 * xy + m11 * yy + m12 * yz,
        m10 * zx + m11 * yz + m12 * zz,
        m20 * xx + m21 * xy + m22 * zx,
        m20 * xy + m21 * yy + m22 * yz,
        m20 * zx + m21 * yz + m22 * zz,
    )
