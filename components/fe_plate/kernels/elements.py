"""Elements over a step: stresses from the motion of their corners, and forces on these."""

import math
from typing import NamedTuple

import numpy as np
from numba import njit

from quintet.components.fe_plate.kernels.geometry import (
    INLINED,
    LANES,
    load_corners,
    mean_gradients,
    velocity_gradients,
)
from quintet.components.fe_plate.kernels.hourglass import add_patterns, patterns
from quintet.components.fe_plate.state import Array, Model, Resistance, State
from quintet.components.shared.materials.equation_of_state import (
    pressure_and_energy,
    sound_speed_squared,
    temperature,
)
from quintet.components.shared.materials.fracture import damage_growth, is_torn
from quintet.components.shared.materials.solid import Solid
from quintet.components.shared.materials.strength import returned, turned_and_strained
from quintet.components.shared.numba_options import FAST

CUBE = math.sqrt(3.0)  # edge of a cube over the length of its bound
HUGE = 1e300  # these kernels take every number to be finite


class Points(NamedTuple):
    """What varies from element to element, of the state."""

    deviator: Array
    pressure: Array
    viscous: Array
    energy: Array
    strain: Array
    temperature: Array
    damage: Array
    active: Array


@njit(**FAST)
def step_elements(
    first: int, last: int, model: Model, state: State, law: Solid, resistance: Resistance, dt: float
) -> tuple[float, float, int]:
    """Advance the stresses of elements and write the forces on their corners.

    Parameters
    ----------
    first, last : int
        Elements, all of one material.
    model, state, law, resistance
    dt : float, s
        Step that led to the present positions; 0 to write forces anew.

    Returns
    -------
    float, s : largest step that all of them bear
    float, 1 : least volume over that at the start
    int : element that has it
    """
    # Arrays are taken out of their tuples once: each time costs a count of references.
    position, velocity = state.position, state.mean_velocity
    corner, start, active, out = model.corner, model.volume, state.active, state.corner_force
    held, held_energy = state.hourglass, state.hourglass_energy
    points = Points(
        state.deviator, state.pressure, state.viscous, state.energy, state.strain,
        state.temperature, state.damage, active,
    )  # fmt: skip
    x, v = np.empty((24, LANES)), np.empty((24, LANES))
    gradient, force = np.empty((24, LANES)), np.empty((24, LANES))
    hx, hv = np.empty((12, LANES)), np.empty((12, LANES))
    middle, at_end = np.empty((9, LANES)), np.empty((9, LANES))
    stress, spring = np.empty((9, LANES)), np.empty((12, LANES))
    volume, ratio, length = np.empty(LANES), np.empty(LANES), np.empty(LANES)
    stiff = 0.015625 * resistance.hourglass * (law.bulk + 4.0 / 3.0 * law.shear)
    step, least, worst = HUGE, HUGE, first
    for begin in range(first, last, LANES):
        count = min(LANES, last - begin)
        load_corners(position, corner, begin, last, x)
        load_corners(velocity, corner, begin, last, v)
        mean_gradients(x, gradient, volume)
        velocity_gradients(v, gradient, volume, dt, middle, at_end)
        edge_lengths(gradient, volume, length)
        for k in range(LANES):
            ratio[k] = volume[k] / start[min(begin + k, last - 1)]
        for k in range(count):
            if not ratio[k] >= least:
                least, worst = ratio[k], begin + k
        step = min(
            step, update(begin, count, ratio, length, middle, stress, points, law, resistance, dt)
        )
        patterns(x, hx)
        patterns(v, hv)
        load_springs(begin, count, held, spring)
        resist(stiff * dt, dt, volume, length, middle, at_end, hx, hv, spring, v[0])
        store_springs(begin, count, active, spring, v[0], held, held_energy)
        corner_forces(gradient, stress, hx, spring, volume, force)
        for k in range(count):
            for a in range(8):
                for d in range(3):
                    out[begin + k, a, d] = force[3 * a + d, k]
    return step, least, worst


@njit(**INLINED)
def edge_lengths(gradient, volume, out):  # type: ignore[no-untyped-def]
    """Write l = √½ V/√Σ B² (lanes,) m: l/c is a proven stable step; 0.58 of a cube's edge."""
    for k in range(LANES):
        out[k] = 0.0
    for row in range(24):
        for k in range(LANES):
            out[k] += gradient[row, k] * gradient[row, k]
    for k in range(LANES):
        out[k] = volume[k] * math.sqrt(0.5 / out[k])


@njit(**INLINED)
def update(  # type: ignore[no-untyped-def]
    begin, count, ratios, lengths, middle, stress, points, law, resistance, dt
):
    """Advance the material of a block; write stresses (9, lanes) Pa; return the least step [s]."""
    s6, old_pressure, old_viscous, energies, strains, warmth, damages, active = points
    linear, quadratic, damp = resistance.linear, resistance.quadratic, resistance.damping
    least = HUGE
    for k in range(count):
        e, ratio, length = begin + k, ratios[k], lengths[k]
        l00, l01, l02 = middle[0, k], middle[1, k], middle[2, k]
        l10, l11, l12 = middle[3, k], middle[4, k], middle[5, k]
        l20, l21, l22 = middle[6, k], middle[7, k], middle[8, k]
        if active[e] == 0.0:
            for row in range(9):
                stress[row, k] = 0.0
            continue
        gradient = l00, l01, l02, l10, l11, l12, l20, l21, l22
        mu, divergence, per_density = 1.0 / ratio - 1.0, l00 + l11 + l22, ratio / law.density
        pressure, energy, warm = old_pressure[e], energies[e], warmth[e]
        s = s6[0, e], s6[1, e], s6[2, e], s6[3, e], s6[4, e], s6[5, e]
        change = divergence * dt * per_density  # of the specific volume, m3/kg
        if dt > 0.0:
            before = s
            s = turned_and_strained(s, gradient, law.shear, dt)
            s, delta, work = returned(s, strains[e], warm, dt, law)
            energy += 0.5 * dt * per_density * deviatoric_power(before, s, gradient)
            energy -= 0.5 * (pressure + old_viscous[e]) * change
            pressure, energy = pressure_and_energy(mu, energy, change, law)
            if law.shocks:
                warm = temperature(mu, energy, law)
            if delta > 0.0:
                strains[e] += delta
                warm += law.heating * work
                damages[e] += damage_growth(s, pressure, delta, warm, dt, law)
        sound = math.sqrt(sound_speed_squared(mu, energy, pressure, law))
        failed = strains[e] >= law.failure_strain or damages[e] >= 1.0
        if failed or is_torn(s, pressure, law.spall):
            active[e], pressure, s = 0.0, 0.0, (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
        rate, slower, viscous = max(0.0, -divergence), damp * sound * sound / length, 0.0
        if rate > 0.0 and active[e] > 0.0:
            edge = CUBE * length
            drag = linear * sound + quadratic * quadratic * edge * rate  # m/s
            viscous, slower = edge * rate * drag / per_density, slower + drag
        trace, double = -pressure - viscous, 0.0
        if damp > 0.0 and active[e] > 0.0:
            energy += dt * per_density * damp * damping_power(gradient, law)
            double = 2.0 * damp * law.shear
            trace += damp * (law.bulk - 2.0 / 3.0 * law.shear) * divergence
        if dt > 0.0:
            s6[0, e], s6[1, e], s6[2, e], s6[3, e], s6[4, e], s6[5, e] = s
            old_pressure[e], energies[e] = pressure, energy - 0.5 * viscous * change
            warmth[e] = warm
        old_viscous[e] = viscous
        xx, yy, zz, xy, yz, zx = s
        stress[0, k], stress[4, k] = xx + trace + double * l00, yy + trace + double * l11
        stress[8, k] = zz + trace + double * l22
        stress[1, k] = stress[3, k] = xy + 0.5 * double * (l01 + l10)
        stress[5, k] = stress[7, k] = yz + 0.5 * double * (l12 + l21)
        stress[2, k] = stress[6, k] = zx + 0.5 * double * (l20 + l02)
        least = min(least, length / (slower + math.sqrt(slower * slower + sound * sound)))
    for row in range(9):
        for k in range(count, LANES):
            stress[row, k] = 0.0
    return least


@njit(**INLINED)
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


@njit(**INLINED)
def damping_power(gradient, law):  # type: ignore[no-untyped-def]
    """2G dev D:D + K (tr D)² [Pa/s2] of a velocity gradient."""
    l00, l01, l02, l10, l11, l12, l20, l21, l22 = gradient
    trace, xy, yz, zx = l00 + l11 + l22, l01 + l10, l12 + l21, l20 + l02
    squares = l00 * l00 + l11 * l11 + l22 * l22 - trace * trace / 3.0
    squares += 0.5 * (xy * xy + yz * yz + zx * zx)
    return 2.0 * law.shear * squares + law.bulk * trace * trace


@njit(**INLINED)
def load_springs(begin, count, held, spring):  # type: ignore[no-untyped-def]
    """Take the hourglass forces (12, lanes) N of a block."""
    for row in range(12):
        for k in range(LANES):
            spring[row, k] = held[row, min(begin + k, begin + count - 1)]


@njit(**INLINED)
def store_springs(begin, count, active, spring, work, held, energy):  # type: ignore[no-untyped-def]
    """Put them back, with the work (lanes,) J that was done on them; eroded elements have none."""
    for k in range(count):
        live = active[begin + k]
        energy[begin + k] += live * work[k]
        for row in range(12):
            spring[row, k] *= live
            held[row, begin + k] = spring[row, k]


@njit(**INLINED)
def resist(stiff, dt, volume, length, middle, at_end, hx, hv, spring, work):  # type: ignore[no-untyped-def]
    """Load and turn the springs of the hourglass patterns; write the work (lanes,) J on them.

    `stiff` times V Σ B² /V² is the stiffness [N/m] of each, times the step; Σ B²/V² = 1/(2 l²).
    """
    for k in range(LANES):
        work[k] = 0.0
    for i in range(4):
        row = 3 * i
        for k in range(LANES):
            half_xy = 0.5 * dt * (middle[1, k] - middle[3, k])
            half_yz = 0.5 * dt * (middle[5, k] - middle[7, k])
            half_zx = 0.5 * dt * (middle[6, k] - middle[2, k])
            loads = 0.5 * stiff * volume[k] / (length[k] * length[k])
            ax, ay, az = hx[row, k], hx[row + 1, k], hx[row + 2, k]
            q0 = hv[row, k] - (at_end[0, k] * ax + at_end[1, k] * ay + at_end[2, k] * az)
            q1 = hv[row + 1, k] - (at_end[3, k] * ax + at_end[4, k] * ay + at_end[5, k] * az)
            q2 = hv[row + 2, k] - (at_end[6, k] * ax + at_end[7, k] * ay + at_end[8, k] * az)
            o0, o1, o2 = spring[row, k], spring[row + 1, k], spring[row + 2, k]
            n0 = o0 + loads * q0 + half_xy * o1 - half_zx * o2
            n1 = o1 + loads * q1 + half_yz * o2 - half_xy * o0
            n2 = o2 + loads * q2 + half_zx * o0 - half_yz * o1
            work[k] += 0.5 * dt * ((o0 + n0) * q0 + (o1 + n1) * q1 + (o2 + n2) * q2)
            spring[row, k], spring[row + 1, k], spring[row + 2, k] = n0, n1, n2


@njit(**INLINED)
def corner_forces(gradient, stress, hx, spring, volume, out):  # type: ignore[no-untyped-def]
    """Write the forces (24, lanes) N that hold elements against their stresses and springs."""
    for a in range(3):
        for b in range(3):
            row = 3 * a + b
            for k in range(LANES):
                rest = (
                    spring[a, k] * hx[b, k]
                    + spring[3 + a, k] * hx[3 + b, k]
                    + spring[6 + a, k] * hx[6 + b, k]
                    + spring[9 + a, k] * hx[9 + b, k]
                )
                stress[row, k] -= rest / volume[k]
    for corner in range(8):
        row = 3 * corner
        for k in range(LANES):
            x, y, z = gradient[row, k], gradient[row + 1, k], gradient[row + 2, k]
            out[row, k] = stress[0, k] * x + stress[1, k] * y + stress[2, k] * z
            out[row + 1, k] = stress[3, k] * x + stress[4, k] * y + stress[5, k] * z
            out[row + 2, k] = stress[6, k] * x + stress[7, k] * y + stress[8, k] * z
    add_patterns(spring, out)
