"""Sums over the neighbours of the start: gradients with respect to where particles were then."""

import math

from numba import njit

from quintet.components.shared.numba_options import FAST
from quintet.components.shared.search.neighbours import Lists
from quintet.components.shared.smoothing.smoothing import gradient, kernel
from quintet.components.sph_solid.kernels.pairs import Forces
from quintet.components.sph_solid.laws import PairLaw, inverse, times, viscous_pressure
from quintet.components.sph_solid.state import Array


@njit(inline="always")
def product(a, b):  # type: ignore[no-untyped-def]
    """Product of two matrices, nine by rows."""
    a0, a1, a2, a3, a4, a5, a6, a7, a8 = a
    b0, b1, b2, b3, b4, b5, b6, b7, b8 = b
    return (
        a0 * b0 + a1 * b3 + a2 * b6, a0 * b1 + a1 * b4 + a2 * b7, a0 * b2 + a1 * b5 + a2 * b8,
        a3 * b0 + a4 * b3 + a5 * b6, a3 * b1 + a4 * b4 + a5 * b7, a3 * b2 + a4 * b5 + a5 * b8,
        a6 * b0 + a7 * b3 + a8 * b6, a6 * b1 + a7 * b4 + a8 * b7, a6 * b2 + a7 * b5 + a8 * b8,
    )  # fmt: skip


@njit(inline="always")
def inverse_of(m):  # type: ignore[no-untyped-def]
    """Inverse of a matrix, nine by rows."""
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
    """Transpose of a matrix, nine by rows."""
    a, b, c, d, e, f, g, h, k = m
    return a, d, g, b, e, h, c, f, k


@njit(inline="always")
def deformation(i, start, place, lists, law):  # type: ignore[no-untyped-def]
    """F of a particle, and the matrix that corrects its gradients, xx yy zz xy yz zx.

    F = Σ V_j (x_j - x_i) ⊗ ∇W B, exact for linear deformations.
    """
    begin, _, end, neighbour = lists
    kxx, kyy, kzz, kxy, kyz, kzx = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    f0, f1, f2, f3, f4, f5, f6, f7, f8 = 0.0, 0.0, 0.0, 0.0, law.plane, 0.0, 0.0, 0.0, 0.0
    for q in range(begin[i], end[i]):
        j = neighbour[q]
        ax, ay, az = start[i, 0] - start[j, 0], start[i, 1] - start[j, 1], start[i, 2] - start[j, 2]
        square = ax * ax + ay * ay + az * az
        per = 1.0 / math.sqrt(square + law.smoothing.tiny)
        weight = -gradient(square, per, law.smoothing) * place[j, 3]
        gx, gy, gz = weight * ax, weight * ay, weight * az
        dx, dy, dz = place[i, 0] - place[j, 0], place[i, 1] - place[j, 1], place[i, 2] - place[j, 2]
        kxx += ax * gx
        kyy += ay * gy
        kzz += az * gz
        kxy += ax * gy
        kyz += ay * gz
        kzx += az * gx
        f0 += dx * gx
        f1 += dx * gy
        f2 += dx * gz
        f3 += dy * gx
        f4 += dy * gy
        f5 += dy * gz
        f6 += dz * gx
        f7 += dz * gy
        f8 += dz * gz
    corrects, _ = inverse((kxx, kyy, kzz, kxy, kyz, kzx), law)
    return times((f0, f1, f2, f3, f4, f5, f6, f7, f8), corrects), corrects


@njit(**FAST)
def reference_gradients(
    first: int, last: int, start: Array, place: Array, motion: Array, lists: Lists, law: PairLaw,
    velocity_gradient: Array, correction: Array,
) -> None:  # fmt: skip
    """Write the gradient of velocity, dF/dt F⁻¹.

    Parameters
    ----------
    first, last : int
    start : (n + images, 3) float array, m
        Places at the start.
    place, motion : (n + images, 4) float arrays
        As in `Rows`.
    lists : Lists
        Neighbours at the start.
    law : PairLaw
    velocity_gradient : (n, 9) float array, 1/s
        Written.
    correction : (n, 6) float array
        Ones: gradients are corrected.
    """
    begin, _, end, neighbour = lists
    for i in range(first, last):
        f, corrects = deformation(i, start, place, lists, law)
        m0, m1, m2, m3, m4, m5, m6, m7, m8 = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
        for q in range(begin[i], end[i]):
            j = neighbour[q]
            ax = start[i, 0] - start[j, 0]
            ay, az = start[i, 1] - start[j, 1], start[i, 2] - start[j, 2]
            square = ax * ax + ay * ay + az * az
            per = 1.0 / math.sqrt(square + law.smoothing.tiny)
            weight = -gradient(square, per, law.smoothing) * place[j, 3]
            gx, gy, gz = weight * ax, weight * ay, weight * az
            du = motion[i, 0] - motion[j, 0]
            dv, dw = motion[i, 1] - motion[j, 1], motion[i, 2] - motion[j, 2]
            m0 += du * gx
            m1 += du * gy
            m2 += du * gz
            m3 += dv * gx
            m4 += dv * gy
            m5 += dv * gz
            m6 += dw * gx
            m7 += dw * gy
            m8 += dw * gz
        rate = times((m0, m1, m2, m3, m4, m5, m6, m7, m8), corrects)
        found = product(rate, inverse_of(f))
        for d in range(9):
            velocity_gradient[i, d] = found[d]
        for d in range(6):
            correction[i, d] = 1.0


@njit(**FAST)
def write_nominal_stresses(
    first: int, last: int, start: Array, place: Array, stress: Array, lists: Lists, law: PairLaw,
    nominal: Array, deformed: Array,
) -> None:  # fmt: skip
    """Write P B with P = J σ F⁻ᵀ, of σ/η² in `stress`; and F.

    Parameters
    ----------
    first, last : int
    start, place, lists, law
    stress : (n + images, 8) float array
        σ/η², ρ, ρ₀.
    nominal, deformed : (n + images, 12) float arrays
        Written: P B, ρ and ρ₀; F.
    """
    for i in range(first, last):
        f, corrects = deformation(i, start, place, lists, law)
        xx, yy, zz = stress[i, 0], stress[i, 1], stress[i, 2]
        xy, yz, zx, density, rest = (
            stress[i, 3],
            stress[i, 4],
            stress[i, 5],
            stress[i, 6],
            stress[i, 7],
        )
        eta = density / rest
        tau = (
            xx * eta,
            xy * eta,
            zx * eta,
            xy * eta,
            yy * eta,
            yz * eta,
            zx * eta,
            yz * eta,
            zz * eta,
        )
        found = times(product(tau, transposed(inverse_of(f))), corrects)
        for d in range(9):
            nominal[i, d] = found[d]
            deformed[i, d] = f[d]
        nominal[i, 9], nominal[i, 10] = density, rest


@njit(**FAST)
def reference_accelerations(
    first: int, last: int, start: Array, place: Array, motion: Array, nominal: Array,
    deformed: Array, lists: Lists, law: PairLaw, penalty: float, forces: Forces, heats: Array,
) -> tuple[float, float]:  # fmt: skip
    """Write accelerations and heating from neighbours of the start.

    Parameters
    ----------
    first, last : int
    start, place, motion, nominal, deformed, lists, law
        As above.
    penalty : float
        α of the force against what F does not see.
    forces : Forces
        Written; accelerations by stresses alone.
    heats : (n, 3) float array, m/s2
        Written: accelerations by the viscosity and the penalty, which heat.

    Returns
    -------
    float, s : least h/(c + 1.2 (α c + β max|μ|)) of all
    float, m2/s4 : greatest square of an acceleration by stresses

    References
    ----------
    Ganzenmüller, Comput. Methods Appl. Mech. Eng. 286 (2015) 87 (penalty).
    """
    begin, _, end, neighbour = lists
    acceleration, heating = forces
    slowest, greatest = math.inf, 0.0
    length = law.smoothing.length
    for i in range(first, last):
        fx, fy, fz, heat, fastest = 0.0, 0.0, 0.0, 0.0, 0.0
        px, py, pz = 0.0, 0.0, 0.0
        density, rest, sound = nominal[i, 9], nominal[i, 10], motion[i, 3]
        for q in range(begin[i], end[i]):
            j = neighbour[q]
            if j == i:
                continue
            ax = start[i, 0] - start[j, 0]
            ay, az = start[i, 1] - start[j, 1], start[i, 2] - start[j, 2]
            square = ax * ax + ay * ay + az * az
            per = 1.0 / math.sqrt(square + law.smoothing.tiny)
            weight = gradient(square, per, law.smoothing) * place[j, 3]
            t0, t1, t2 = (
                nominal[i, 0] + nominal[j, 0],
                nominal[i, 1] + nominal[j, 1],
                nominal[i, 2] + nominal[j, 2],
            )
            t3, t4, t5 = (
                nominal[i, 3] + nominal[j, 3],
                nominal[i, 4] + nominal[j, 4],
                nominal[i, 5] + nominal[j, 5],
            )
            t6, t7, t8 = (
                nominal[i, 6] + nominal[j, 6],
                nominal[i, 7] + nominal[j, 7],
                nominal[i, 8] + nominal[j, 8],
            )
            fx += weight * (t0 * ax + t1 * ay + t2 * az)
            fy += weight * (t3 * ax + t4 * ay + t5 * az)
            fz += weight * (t6 * ax + t7 * ay + t8 * az)
            dx = place[i, 0] - place[j, 0]
            dy, dz = place[i, 1] - place[j, 1], place[i, 2] - place[j, 2]
            du = motion[i, 0] - motion[j, 0]
            dv, dw = motion[i, 1] - motion[j, 1], motion[i, 2] - motion[j, 2]
            now = dx * dx + dy * dy + dz * dz
            dot = dx * du + dy * dv + dz * dw
            mu = length * max(-dot, 0.0) / (now + law.softening)
            drag = viscous_pressure(
                mu,
                sound + motion[j, 3],
                1.0 / (density + nominal[j, 9]),
                rest * nominal[j, 10],
                law,
            )
            per_now = 1.0 / math.sqrt(now + law.smoothing.tiny)
            along = weight * per_now / per * drag
            # What F of both would have between the two, over what there is.
            ux = (
                (deformed[i, 0] + deformed[j, 0]) * ax
                + (deformed[i, 1] + deformed[j, 1]) * ay
                + (deformed[i, 2] + deformed[j, 2]) * az
            )
            uy = (
                (deformed[i, 3] + deformed[j, 3]) * ax
                + (deformed[i, 4] + deformed[j, 4]) * ay
                + (deformed[i, 5] + deformed[j, 5]) * az
            )
            uz = (
                (deformed[i, 6] + deformed[j, 6]) * ax
                + (deformed[i, 7] + deformed[j, 7]) * ay
                + (deformed[i, 8] + deformed[j, 8]) * az
            )
            excess = (ux * dx + uy * dy + uz * dz) * per_now - 2.0 * now * per_now
            stiff = 0.5 * (rest + nominal[j, 10]) * sound * motion[j, 3]
            push = 0.5 * penalty * stiff * place[j, 3] * kernel(square, law.smoothing)
            push *= excess * per * per * per_now
            heat += (along - push) * dot
            px += (push - along) * dx
            py += (push - along) * dy
            pz += (push - along) * dz
            fastest = max(fastest, mu)
        each = 1.0 / rest
        fx, fy, fz = fx * each, fy * each, fz * each
        acceleration[i, 0], acceleration[i, 1], acceleration[i, 2] = fx, fy, fz
        heats[i, 0], heats[i, 1], heats[i, 2] = each * px, each * py, each * pz
        heating[i] = 0.5 * heat * each
        drag = law.linear * sound + law.quadratic * fastest
        slowest = min(slowest, length / (sound + 1.2 * drag))
        greatest = max(greatest, fx * fx + fy * fy + fz * fz)
    return slowest, greatest
