"""Strains that are assumed in elements with eight points, and the transpose, for stresses.

All means over points are weighted with their volumes: then an operator and its transpose do the
same work, and what has no mean over the element leaves a linear field as it is.
"""

from numba import njit

from quintet.components.fe_plate.kernels.blocks import (
    FRAME,
    GRADIENT,
    LOCAL,
    STRESS,
    VOLUME,
    nine,
    put_nine,
    put_six,
    six,
)
from quintet.components.fe_plate.state import LANES, STRAIN
from quintet.components.shared.numba_options import FAST_LANEWISE

POINTS = 8  # of an element; bits 0 to 2 of a point's number are its signs of ξ, η and ζ


@njit(**FAST_LANEWISE)
def applied(s, x, y, z):  # type: ignore[no-untyped-def]
    """Symmetric tensor xx yy zz xy yz zx on a vector."""
    xx, yy, zz, xy, yz, zx = s
    return xx * x + xy * y + zx * z, xy * x + yy * y + yz * z, zx * x + yz * y + zz * z


@njit(**FAST_LANEWISE)
def turned(s, r):  # type: ignore[no-untyped-def]
    """R s Rᵀ of a symmetric tensor xx yy zz xy yz zx; R by rows."""
    a0, a1, a2, b0, b1, b2, c0, c1, c2 = r
    p0, p1, p2 = applied(s, a0, a1, a2)
    q0, q1, q2 = applied(s, b0, b1, b2)
    t0, t1, t2 = applied(s, c0, c1, c2)
    return (
        a0 * p0 + a1 * p1 + a2 * p2,
        b0 * q0 + b1 * q1 + b2 * q2,
        c0 * t0 + c1 * t1 + c2 * t2,
        a0 * q0 + a1 * q1 + a2 * q2,
        b0 * t0 + b1 * t1 + b2 * t2,
        c0 * p0 + c1 * p1 + c2 * p2,
    )


@njit(**FAST_LANEWISE)
def transposed(r):  # type: ignore[no-untyped-def]
    """Transpose of a matrix by rows."""
    return r[0], r[3], r[6], r[1], r[4], r[7], r[2], r[5], r[8]


@njit(**FAST_LANEWISE)
def assume_strains(points, work, law):  # type: ignore[no-untyped-def]
    """Replace the rates of strain within the velocity gradients by the assumed ones."""
    for k in range(LANES):
        l00, l01, l02, l10, l11, l12, l20, l21, l22 = nine(work, GRADIENT, k)
        strain = l00, l11, l22, 0.5 * (l01 + l10), 0.5 * (l12 + l21), 0.5 * (l20 + l02)
        put_six(work, LOCAL * LANES + k, turned(strain, nine(work, FRAME, k)))
    for first in range(0, LANES, POINTS):
        mix(work, first, lateral(points, first, law), True)
    for k in range(LANES):
        l00, l01, l02, l10, l11, l12, l20, l21, l22 = nine(work, GRADIENT, k)
        wxy, wyz, wzx = 0.5 * (l01 - l10), 0.5 * (l12 - l21), 0.5 * (l20 - l02)
        back = turned(six(work, LOCAL * LANES + k), transposed(nine(work, FRAME, k)))
        xx, yy, zz, xy, yz, zx = back
        assumed = xx, xy + wxy, zx - wzx, xy - wxy, yy, yz + wyz, zx + wzx, yz - wyz, zz
        put_nine(work, GRADIENT, k, assumed)


@njit(**FAST_LANEWISE)
def spread_stresses(points, work, law):  # type: ignore[no-untyped-def]
    """Replace stresses by those that do the same work on the gradients of the displacements."""
    for k in range(LANES):
        stress = six(work, STRESS * LANES + k)
        put_six(work, LOCAL * LANES + k, turned(stress, nine(work, FRAME, k)))
    for first in range(0, LANES, POINTS):
        mix(work, first, lateral(points, first, law), False)
    for k in range(LANES):
        back = turned(six(work, LOCAL * LANES + k), transposed(nine(work, FRAME, k)))
        put_six(work, STRESS * LANES + k, back)


@njit(**FAST_LANEWISE)
def lateral(points, first, law):  # type: ignore[no-untyped-def]
    """Lateral strain over that of bending: ν/(1 - ν) = (3K - 2G)/(3K + 4G); 1 after yielding."""
    most = 0.0
    for k in range(first, first + POINTS):
        most = max(most, points[STRAIN * LANES + k])
    if most > 0.0:
        return 1.0
    return (3.0 * law.bulk - 2.0 * law.shear) / (3.0 * law.bulk + 4.0 * law.shear)


@njit(**FAST_LANEWISE)
def mix(work, first, share, forward):  # type: ignore[no-untyped-def]
    """Assume strains of an element's points, from lane `first` on; or do the transpose."""
    whole = 0.0
    for k in range(POINTS):
        whole += work[VOLUME * LANES + first + k]
    for step in range(3):
        axis = step if forward else 2 - step  # a transpose takes the factors from the last on
        mean = 0.0
        for k in range(POINTS):
            mean += work[VOLUME * LANES + first + k] * sign(k, axis)
        mean /= whole
        other, third = (axis + 1) % 3, (axis + 2) % 3
        along, others = LOCAL + axis, (LOCAL + other, LOCAL + third)
        slope = 0.0
        for k in range(POINTS):
            weight = work[VOLUME * LANES + first + k] * (sign(k, axis) - mean)
            if forward:
                value = work[others[0] * LANES + first + k] + work[others[1] * LANES + first + k]
            else:
                value = work[along * LANES + first + k]
            slope += weight * value
        slope *= -share / whole
        for k in range(POINTS):
            more = (sign(k, axis) - mean) * slope
            if forward:
                work[along * LANES + first + k] += more
            else:
                work[others[0] * LANES + first + k] += more
                work[others[1] * LANES + first + k] += more
        average_shear(work, LOCAL + 3 + other, first, axis)


@njit(**FAST_LANEWISE)
def sign(k, axis):  # type: ignore[no-untyped-def]
    """Sign of a point's ξ, η or ζ."""
    return 1.0 if (k >> axis) & 1 else -1.0


@njit(**FAST_LANEWISE)
def average_shear(work, row, first, axis):  # type: ignore[no-untyped-def]
    """Average a shear over the points that differ along its own two axes."""
    for side in range(2):
        total, weights = 0.0, 0.0
        for k in range(POINTS):
            if (k >> axis) & 1 == side:
                weight = work[VOLUME * LANES + first + k]
                weights += weight
                total += weight * work[row * LANES + first + k]
        total /= weights
        for k in range(POINTS):
            if (k >> axis) & 1 == side:
                work[row * LANES + first + k] = total
