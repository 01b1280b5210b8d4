"""Sums over the neighbours of the start: gradients with respect to where particles were then."""

import math

from numba import njit

from quintet.components.shared.numba_options import FAST
from quintet.components.shared.search.neighbours import Lists
from quintet.components.shared.smoothing.smoothing import gradient
from quintet.components.sph_solid.kernels.material import six_of
from quintet.components.sph_solid.kernels.pairs import Forces
from quintet.components.sph_solid.kernels.reference_laws import (
    along,
    approach,
    deformation,
    nominal_stress,
    push_less_drag,
    rate_of_deformation,
)
from quintet.components.sph_solid.laws import PairLaw, stable_step, viscous_pressure
from quintet.components.sph_solid.state import Array


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
def both(tensor, i, j):  # type: ignore[no-untyped-def]
    """T_i + T_j of tensors (any, 9 or more), nine by rows."""
    t = tensor
    return (
        t[i, 0] + t[j, 0], t[i, 1] + t[j, 1], t[i, 2] + t[j, 2],
        t[i, 3] + t[j, 3], t[i, 4] + t[j, 4], t[i, 5] + t[j, 5],
        t[i, 6] + t[j, 6], t[i, 7] + t[j, 7], t[i, 8] + t[j, 8],
    )  # fmt: skip


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
        of_places, matrix = sum_reference(i, place, start, place, lists, law)
        f, corrects = deformation(of_places, matrix, law)
        of_velocities, _ = sum_reference(i, motion, start, place, lists, law)
        rate = rate_of_deformation(of_velocities, corrects, f)
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
        sums, matrix = sum_reference(i, place, start, place, lists, law)
        f, corrects = deformation(sums, matrix, law)
        density, rest = stress[i, 6], stress[i, 7]
        corrected = nominal_stress(six_of(stress, i), density / rest, f, corrects)
        for d in range(9):
            nominal[i, d] = corrected[d]
            deformed[i, d] = f[d]
        nominal[i, 9], nominal[i, 10] = density, rest


@njit(inline="always")
def sum_reference_forces(  # type: ignore[no-untyped-def]
    i, start, place, motion, nominal, deformed, lists, law, penalty
):
    """Forces of stresses, and of viscosity and penalty, over V_i; the heat of these, and max|μ|."""
    begin, _, end, neighbour = lists
    fx, fy, fz, px, py, pz = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    heat, fastest = 0.0, 0.0
    density, rest, sound = nominal[i, 9], nominal[i, 10], motion[i, 3]
    for q in range(begin[i], end[i]):
        j = neighbour[q]
        if j == i:
            continue
        a, d, change = offset(start, i, j), offset(place, i, j), offset(motion, i, j)
        square = a[0] * a[0] + a[1] * a[1] + a[2] * a[2]
        per = 1.0 / math.sqrt(square + law.smoothing.tiny)
        weight = gradient(square, per, law.smoothing) * place[j, 3]
        tx, ty, tz = along(both(nominal, i, j), a)
        fx += weight * tx
        fy += weight * ty
        fz += weight * tz
        now = d[0] * d[0] + d[1] * d[1] + d[2] * d[2]
        dot = d[0] * change[0] + d[1] * change[1] + d[2] * change[2]
        mu = approach(dot, now, law)
        sounds, per_density = sound + motion[j, 3], 1.0 / (density + nominal[j, 9])
        q_ij = viscous_pressure(mu, sounds, per_density, rest * nominal[j, 10], law)
        ux, uy, uz = along(both(deformed, i, j), a)
        pull = ux * d[0] + uy * d[1] + uz * d[2]
        stiff = 0.5 * (rest + nominal[j, 10]) * sound * motion[j, 3]
        push = push_less_drag(square, now, pull, weight, place[j, 3], stiff, q_ij, penalty, law)
        heat -= push * dot
        px += push * d[0]
        py += push * d[1]
        pz += push * d[2]
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
        slowest = min(slowest, stable_step(sound, fastest, law))
        greatest = max(greatest, fx * fx + fy * fy + fz * fz)
    return slowest, greatest
