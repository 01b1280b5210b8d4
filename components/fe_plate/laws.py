"""Kinematics and powers at one quadrature point; the materials' laws are in `shared.materials`."""

import math

from numba import njit

from quintet.components.shared.numba_options import FAST_LANEWISE


@njit(**FAST_LANEWISE)
def to_middle(gradient, half):  # type: ignore[no-untyped-def]
    """Velocity gradient at the middle of a step of twice `half` [s], from that at its end.

    Corners are where they are at the end: with x = x_end - ½ dt v the gradient in the middle is
    L (I - ½ dt L)⁻¹, so that a rotation strains nothing.
    """
    l00, l01, l02, l10, l11, l12, l20, l21, l22 = gradient
    m00, m01, m02 = 1.0 - half * l00, -half * l01, -half * l02
    m10, m11, m12 = -half * l10, 1.0 - half * l11, -half * l12
    m20, m21, m22 = -half * l20, -half * l21, 1.0 - half * l22
    c00, c01, c02 = m11 * m22 - m12 * m21, m02 * m21 - m01 * m22, m01 * m12 - m02 * m11
    c10, c11, c12 = m12 * m20 - m10 * m22, m00 * m22 - m02 * m20, m02 * m10 - m00 * m12
    c20, c21, c22 = m10 * m21 - m11 * m20, m01 * m20 - m00 * m21, m00 * m11 - m01 * m10
    per = 1.0 / (m00 * c00 + m01 * c10 + m02 * c20)
    return (
        per * (l00 * c00 + l01 * c10 + l02 * c20),
        per * (l00 * c01 + l01 * c11 + l02 * c21),
        per * (l00 * c02 + l01 * c12 + l02 * c22),
        per * (l10 * c00 + l11 * c10 + l12 * c20),
        per * (l10 * c01 + l11 * c11 + l12 * c21),
        per * (l10 * c02 + l11 * c12 + l12 * c22),
        per * (l20 * c00 + l21 * c10 + l22 * c20),
        per * (l20 * c01 + l21 * c11 + l22 * c21),
        per * (l20 * c02 + l21 * c12 + l22 * c22),
    )


@njit(**FAST_LANEWISE)
def strain_rate(gradient):  # type: ignore[no-untyped-def]
    """Equivalent rate √(2/3 D':D') [1/s] of the deviator of a velocity gradient."""
    l00, l01, l02, l10, l11, l12, l20, l21, l22 = gradient
    trace, xy, yz, zx = l00 + l11 + l22, l01 + l10, l12 + l21, l20 + l02
    squares = l00 * l00 + l11 * l11 + l22 * l22 - trace * trace / 3.0
    return math.sqrt(max(2.0 / 3.0 * squares + (xy * xy + yz * yz + zx * zx) / 3.0, 0.0))


@njit(**FAST_LANEWISE)
def deviatoric_power(before, after, gradient):  # type: ignore[no-untyped-def]
    """(s + s'):D [W/m3], of the deviators at the step's ends."""
    l00, l01, l02, l10, l11, l12, l20, l21, l22 = gradient
    return (
        (before[0] + after[0]) * l00
        + (before[1] + after[1]) * l11
        + (before[2] + after[2]) * l22
        + (before[3] + after[3]) * (l01 + l10)
        + (before[4] + after[4]) * (l12 + l21)
        + (before[5] + after[5]) * (l20 + l02)
    )


@njit(**FAST_LANEWISE)
def damping_power(gradient, law):  # type: ignore[no-untyped-def]
    """2G dev D:D + K (tr D)² [Pa/s2] of a velocity gradient."""
    l00, l01, l02, l10, l11, l12, l20, l21, l22 = gradient
    trace, xy, yz, zx = l00 + l11 + l22, l01 + l10, l12 + l21, l20 + l02
    squares = l00 * l00 + l11 * l11 + l22 * l22 - trace * trace / 3.0
    squares += 0.5 * (xy * xy + yz * yz + zx * zx)
    return 2.0 * law.shear * squares + law.bulk * trace * trace
