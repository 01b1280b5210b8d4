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
def offset(points, i, j):  # type: ignore[no-untyped-def]
    """x_i - x_j, three numbers, of points (any, 3 or more)."""
    return points[i, 0] - points[j, 0], points[i, 1] - points[j, 1], points[i, 2] - points[j, 2]


@njit(inline="always")
def sum_reference(i, values, start, place, lists, law):  # type: ignore[no-untyped-def]
    """Σ V_j (u_j - u_i) ⊗ ∇W of values u (any, 3 or more), and Σ V_j (X_j - X_i) ⊗ ∇W, symmetric.

    The first are nine numbers by rows, the second xx yy zz xy yz zx.
    """
    begin, _, end, neighbour = lists
    kxx, kyy, kzz, kxy, kyz, kzx = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    m0, m1, m2, m3, m4, m5, m6, m7, m8 = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for q in range(begin[i], end[i]):
        j = neighbour[q]
        ax, ay, az = offset(start, i, j)
        square = ax * ax + ay * ay + az * az
        per = 1.0 / math.sqrt(square + law.smoothing.tiny)
        weight = -gradient(square, per, law.smoothing) * place[j, 3]
        gx, gy, gz = weight * ax, weight * ay, weight * az
        du, dv, dw = offset(values, i, j)
        kxx += ax * gx
        kyy += ay * gy
        kzz += az * gz
        kxy += ax * gy
        kyz += ay * gz
        kzx += az * gx
        m0 += du * gx
        m1 += du * gy
        m2 += du * gz
        m3 += dv * gx
        m4 += dv * gy
        m5 += dv * gz
        m6 += dw * gx
        m7 += dw * gy
        m8 += dw * gz
    return (m0, m1, m2, m3, m4, m5, m6, m7, m8), (kxx, kyy, kzz, kxy, kyz, kzx)


@njit(inline="always")
def deformation(i, start, place, lists, law):  # type: ignore[no-untyped-def]
    """F of a particle, and the matrix that corrects its gradients, xx yy zz xy yz zx.

    F = Σ V_j (x_j - x_i) ⊗ ∇W B, exact for linear deformations.
    """
    sums, matrix = sum_reference(i, place, start, place, lists, law)
    f0, f1, f2, f3, f4, f5, f6, f7, f8 = sums
    corrects, _ = inverse(matrix, law)
    return times((f0, f1, f2, f3, f4 + law.plane, f5, f6, f7, f8), corrects), corrects


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
    for i in range(first, last):
        f, corrects = deformation(i, start, place, lists, law)
        sums, _ = sum_reference(i, motion, start, place, lists, law)
        rate = product(times(sums, corrects), inverse_of(f))
        for d in range(9):
            velocity_gradient[i, d] = rate[d]
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
        kirchhoff = (
            xx * eta, xy * eta, zx * eta, xy * eta, yy * eta, yz * eta, zx * eta, yz * eta,
            zz * eta,
        )  # fmt: skip
        corrected = times(product(kirchhoff, transposed(inverse_of(f))), corrects)
        for d in range(9):
            nominal[i, d] = corrected[d]
            deformed[i, d] = f[d]
        nominal[i, 9], nominal[i, 10] = density, rest


@njit(inline="always")
def along(tensor, i, j, ax, ay, az):  # type: ignore[no-untyped-def]
    """(T_i + T_j)·a of tensors (any, 9 or more), nine by rows."""
    t = tensor
    t0, t1, t2 = t[i, 0] + t[j, 0], t[i, 1] + t[j, 1], t[i, 2] + t[j, 2]
    t3, t4, t5 = t[i, 3] + t[j, 3], t[i, 4] + t[j, 4], t[i, 5] + t[j, 5]
    t6, t7, t8 = t[i, 6] + t[j, 6], t[i, 7] + t[j, 7], t[i, 8] + t[j, 8]
    return (
        t0 * ax + t1 * ay + t2 * az,
        t3 * ax + t4 * ay + t5 * az,
        t6 * ax + t7 * ay + t8 * az,
    )


@njit(inline="always")
def sum_reference_forces(  # type: ignore[no-untyped-def]
    i, start, place, motion, nominal, deformed, lists, law, penalty
):
    """Forces of stresses, and of viscosity and penalty, over V_i; the heat of these, and max|μ|."""
    begin, _, end, neighbour = lists
    fx, fy, fz, px, py, pz = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    heat, fastest, length = 0.0, 0.0, law.smoothing.length
    density, rest, sound = nominal[i, 9], nominal[i, 10], motion[i, 3]
    for q in range(begin[i], end[i]):
        j = neighbour[q]
        if j == i:
            continue
        ax, ay, az = offset(start, i, j)
        square = ax * ax + ay * ay + az * az
        per = 1.0 / math.sqrt(square + law.smoothing.tiny)
        weight = gradient(square, per, law.smoothing) * place[j, 3]
        tx, ty, tz = along(nominal, i, j, ax, ay, az)
        fx += weight * tx
        fy += weight * ty
        fz += weight * tz
        dx, dy, dz = offset(place, i, j)
        du, dv, dw = offset(motion, i, j)
        now = dx * dx + dy * dy + dz * dz
        dot = dx * du + dy * dv + dz * dw
        mu = length * max(-dot, 0.0) / (now + law.softening)
        sounds, per_density = sound + motion[j, 3], 1.0 / (density + nominal[j, 9])
        q_ij = viscous_pressure(mu, sounds, per_density, rest * nominal[j, 10], law)
        per_now = 1.0 / math.sqrt(now + law.smoothing.tiny)
        drag = weight * per_now / per * q_ij
        # The distance that F of both would give the two, less the distance that they have.
        ux, uy, uz = along(deformed, i, j, ax, ay, az)
        excess = (ux * dx + uy * dy + uz * dz) * per_now - 2.0 * now * per_now
        stiff = 0.5 * (rest + nominal[j, 10]) * sound * motion[j, 3]
        push = 0.5 * penalty * stiff * place[j, 3] * kernel(square, law.smoothing)
        push *= excess * per * per * per_now
        heat += (drag - push) * dot
        px += (push - drag) * dx
        py += (push - drag) * dy
        pz += (push - drag) * dz
        fastest = max(fastest, mu)
    return (fx, fy, fz), (px, py, pz), heat, fastest


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
    acceleration, heating = forces
    slowest, greatest = math.inf, 0.0
    for i in range(first, last):
        force, push, heat, fastest = sum_reference_forces(
            i, start, place, motion, nominal, deformed, lists, law, penalty
        )
        sound, per = motion[i, 3], 1.0 / nominal[i, 10]
        fx, fy, fz = force[0] * per, force[1] * per, force[2] * per
        acceleration[i, 0], acceleration[i, 1], acceleration[i, 2] = fx, fy, fz
        heats[i, 0], heats[i, 1], heats[i, 2] = per * push[0], per * push[1], per * push[2]
        heating[i] = 0.5 * heat * per
        drag = law.linear * sound + law.quadratic * fastest
        slowest = min(slowest, law.smoothing.length / (sound + 1.2 * drag))
        greatest = max(greatest, fx * fx + fy * fy + fz * fz)
    return slowest, greatest
