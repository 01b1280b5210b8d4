"""Laws of pairs that are neighbours at the start, and of the deformation F that they sum up to.

    F = Σ V_j (x_j - x_i) ⊗ ∇W B,   B⁻¹ = Σ V_j (X_j - X_i) ⊗ ∇W,   P = J σ F⁻ᵀ

Gradients are those at the places X of the start. Matrices are nine numbers by rows, symmetric ones
xx yy zz xy yz zx.

Paper: Ganzenmüller, Comput. Methods Appl. Mech. Eng. 286 (2015) 87.
"""

import math

from numba import njit

from quintet.components.shared.smoothing.smoothing import kernel
from quintet.components.sph_solid.laws import inverse, times


@njit(inline="always")
def product(a, b):  # type: ignore[no-untyped-def]
    """Product of two matrices."""
    a0, a1, a2, a3, a4, a5, a6, a7, a8 = a
    b0, b1, b2, b3, b4, b5, b6, b7, b8 = b
    return (
        a0 * b0 + a1 * b3 + a2 * b6, a0 * b1 + a1 * b4 + a2 * b7, a0 * b2 + a1 * b5 + a2 * b8,
        a3 * b0 + a4 * b3 + a5 * b6, a3 * b1 + a4 * b4 + a5 * b7, a3 * b2 + a4 * b5 + a5 * b8,
        a6 * b0 + a7 * b3 + a8 * b6, a6 * b1 + a7 * b4 + a8 * b7, a6 * b2 + a7 * b5 + a8 * b8,
    )  # fmt: skip


@njit(inline="always")
def inverse_of(m):  # type: ignore[no-untyped-def]
    """Inverse of a matrix."""
    a, b, c, d, e, f, g, h, k = m
    x, y, z = e * k - f * h, f * g - d * k, d * h - e * g
    per = 1.0 / (a * x + b * y + c * z)
    return (
        x * per, (c * h - b * k) * per, (b * f - c * e) * per,
        y * per, (a * k - c * g) * per, (c * d - a * f) * per,
        z * per, (b * g - a * h) * per, (a * e - b * d) * per,
    )  # fmt: skip


@njit(inline="always")
def transposed(m):  # type: ignore[no-untyped-def]
    """Transpose of a matrix."""
    a, b, c, d, e, f, g, h, k = m
    return a, d, g, b, e, h, c, f, k


@njit(inline="always")
def deformation(sums, matrix, law):  # type: ignore[no-untyped-def]
    """F and B of Σ V_j (x_j - x_i) ⊗ ∇W and B⁻¹; F is exact for linear deformations."""
    f0, f1, f2, f3, f4, f5, f6, f7, f8 = sums
    corrects = inverse(matrix, law)[0]
    return times((f0, f1, f2, f3, f4 + law.plane, f5, f6, f7, f8), corrects), corrects


@njit(inline="always")
def rate_of_deformation(sums, corrects, f):  # type: ignore[no-untyped-def]
    """Gradient of velocity [1/s], dF/dt F⁻¹, of Σ V_j (v_j - v_i) ⊗ ∇W, B and F."""
    return product(times(sums, corrects), inverse_of(f))


@njit(inline="always")
def nominal_stress(tau, eta, f, corrects):  # type: ignore[no-untyped-def]
    """P B [Pa] of τ = σ/η² (six numbers), η, F and B."""
    xx, yy, zz, xy, yz, zx = tau
    kirchhoff = (
        xx * eta, xy * eta, zx * eta, xy * eta, yy * eta, yz * eta, zx * eta, yz * eta, zz * eta,
    )  # fmt: skip
    return times(product(kirchhoff, transposed(inverse_of(f))), corrects)


@njit(inline="always")
def along(m, a):  # type: ignore[no-untyped-def]
    """Product of a matrix and a vector."""
    m0, m1, m2, m3, m4, m5, m6, m7, m8 = m
    ax, ay, az = a
    return m0 * ax + m1 * ay + m2 * az, m3 * ax + m4 * ay + m5 * az, m6 * ax + m7 * ay + m8 * az


@njit(inline="always")
def approach(dot, now, law):  # type: ignore[no-untyped-def]
    """|μ| [m/s] of two that approach, of r·v [m2/s] and r² [m2]; 0 of others."""
    return law.smoothing.length * max(-dot, 0.0) / (now + law.softening)


@njit(inline="always")
def push_less_drag(  # type: ignore[no-untyped-def]
    square, now, pull, weight, volume, stiff, q, penalty, law
):
    """Force of the penalty less that of the viscosity, over r_ij and V_i.

    Parameters
    ----------
    square, now : float, m2
        Of the distances at the start and now.
    pull : float, m2
        ((F_i + F_j) X_ij)·x_ij: the distance that both F would give the two, times that now.
    weight : float
        V_j (dW/dR)/R.
    volume : float, m3
        V_j.
    stiff : float, Pa
        Mean ρ₀ of both times c_i c_j.
    q : float, Pa
        Of the artificial viscosity.
    penalty : float
        α of the force against motion that the deformation of neither particle sees.
    law : PairLaw
    """
    per = 1.0 / math.sqrt(square + law.smoothing.tiny)
    per_now = 1.0 / math.sqrt(now + law.smoothing.tiny)
    drag = weight * per_now / per * q
    excess = pull * per_now - 2.0 * now * per_now
    push = 0.5 * penalty * stiff * volume * kernel(square, law.smoothing)
    return push * (excess * per * per * per_now) - drag
