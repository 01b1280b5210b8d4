"""Material of a block of quadrature points over a step: from velocity gradients to stresses.

Each stage is a loop over lanes without branches, of which the compiler makes vectors; what few
points need, as the growth of damage, is done one by one.
"""

import math

from numba import njit

from quintet.components.fe_plate.kernels.blocks import (
    CHANGE,
    DELTA,
    EDGE,
    ENDS,
    GRADIENT,
    LENGTH,
    OLD,
    PLACE,
    RATIO,
    SCRATCH,
    SPECIFIC,
    SPEED,
    STRESS,
    TRIAL,
    WORK,
    greatest,
    least,
    nine,
    put_six,
    six,
)
from quintet.components.fe_plate.kernels.flow import HUGE, return_to_flow_stress
from quintet.components.fe_plate.laws import damping_power, deviatoric_power
from quintet.components.fe_plate.state import (
    ACTIVE,
    DAMAGE,
    DEVIATOR,
    ENERGY,
    LANES,
    PRESSURE,
    STRAIN,
    TEMPERATURE,
    VISCOUS,
)
from quintet.components.shared.materials.equation_of_state import (
    place_on_isentrope,
    pressure_and_energy,
    sound_speed_squared,
    temperature_between,
)
from quintet.components.shared.materials.fracture import damage_growth, is_torn
from quintet.components.shared.materials.strength import (
    equivalent,
    turned_and_strained,
)
from quintet.components.shared.numba_options import FAST_LANEWISE


@njit(**FAST_LANEWISE)
def advance_material(points, work, law, resistance, dt):  # type: ignore[no-untyped-def]
    """Advance a block of points; return the least stable step [s].

    From gradients, volume ratios and lengths; writes stresses, and the speed of sound.
    """
    if dt > 0.0:
        strain_elastically(points, work, law, dt)
        if return_to_flow_stress(points, work, law, dt):
            yield_plastically(points, work, law, dt)
        update_pressure(points, work, law, dt)
    else:
        take_stresses(points, work)
    fracture(points, work, law)
    return resist(points, work, law, resistance, dt)


@njit(**FAST_LANEWISE)
def strain_elastically(points, work, law, dt):  # type: ignore[no-untyped-def]
    """Write trial deviators and their equivalent stresses; advance the temperature's softening."""
    for k in range(LANES):
        gradient = nine(work, GRADIENT, k)
        at = DEVIATOR * LANES + k
        before = six(points, at)
        put_six(work, OLD * LANES + k, before)
        s = turned_and_strained(before, gradient, law.shear, dt)
        put_six(work, STRESS * LANES + k, s)
        work[TRIAL * LANES + k] = equivalent(s)
        work[DELTA * LANES + k] = 0.0
        work[WORK * LANES + k] = 0.0


@njit(**FAST_LANEWISE)
def yield_plastically(points, work, law, dt):  # type: ignore[no-untyped-def]
    """Scale the deviators back, advance plastic strains, and write the plastic work [J/m3]."""
    for k in range(LANES):
        trial, delta = work[TRIAL * LANES + k], work[DELTA * LANES + k]
        scale = 1.0 - 3.0 * law.shear * delta / max(trial, 1.0)
        xx, yy, zz, xy, yz, zx = six(work, STRESS * LANES + k)
        s = scale * xx, scale * yy, scale * zz, scale * xy, scale * yz, scale * zx
        put_six(work, STRESS * LANES + k, s)
        more = delta if points[ACTIVE * LANES + k] > 0.0 else 0.0
        points[STRAIN * LANES + k] += more
        work[WORK * LANES + k] = scale * trial * delta


@njit(**FAST_LANEWISE)
def update_pressure(points, work, law, dt):  # type: ignore[no-untyped-def]
    """Advance pressures, energies and temperatures, and the deviators of points that bear any."""
    for k in range(LANES):
        gradient = nine(work, GRADIENT, k)
        divergence = gradient[0] + gradient[4] + gradient[8]
        ratio = work[RATIO * LANES + k]
        per_density = work[SPECIFIC * LANES + k]
        change = divergence * dt * per_density
        live = points[ACTIVE * LANES + k] > 0.0
        s = six(work, STRESS * LANES + k)
        power = deviatoric_power(six(work, OLD * LANES + k), s, gradient)
        old = points[ENERGY * LANES + k]
        energy = old + 0.5 * dt * per_density * power
        viscous = points[VISCOUS * LANES + k]
        energy -= 0.5 * (points[PRESSURE * LANES + k] + viscous) * change
        pressure, energy = pressure_and_energy(1.0 / ratio - 1.0, energy, change, law)
        points[PRESSURE * LANES + k] = pressure if live else 0.0
        points[ENERGY * LANES + k] = energy if live else old
        at = DEVIATOR * LANES + k
        points[at] = s[0] if live else 0.0
        points[at + LANES] = s[1] if live else 0.0
        points[at + 2 * LANES] = s[2] if live else 0.0
        points[at + 3 * LANES] = s[3] if live else 0.0
        points[at + 4 * LANES] = s[4] if live else 0.0
        points[at + 5 * LANES] = s[5] if live else 0.0
        work[CHANGE * LANES + k] = change
    heat(points, work, law)
    if law.d1 == 0.0 and law.d2 == 0.0:
        return
    for k in range(LANES):
        delta = work[DELTA * LANES + k]
        if delta > 0.0 and points[ACTIVE * LANES + k] > 0.0:
            points[DAMAGE * LANES + k] += damage_growth(
                six(points, DEVIATOR * LANES + k),
                points[PRESSURE * LANES + k],
                delta,
                points[TEMPERATURE * LANES + k],
                dt,
                law,
            )


@njit(**FAST_LANEWISE)
def heat(points, work, law):  # type: ignore[no-untyped-def]
    """Advance temperatures: by the energy of shocked materials, by the plastic work of others.

    Rows of the isentrope's table are taken in a loop of their own, which makes no vectors.
    """
    if not law.shocks:
        for k in range(LANES):
            live = points[ACTIVE * LANES + k] > 0.0
            points[TEMPERATURE * LANES + k] += law.heating * work[WORK * LANES + k] if live else 0.0
        return
    for k in range(LANES):
        place, row = place_on_isentrope(1.0 / work[RATIO * LANES + k] - 1.0, law)
        work[PLACE * LANES + k], work[SCRATCH * LANES + k] = place, row
    table = law.isentrope
    for k in range(LANES):
        row = int(work[SCRATCH * LANES + k])
        work[ENDS * LANES + k], work[(ENDS + 1) * LANES + k] = table[row, 0], table[row, 1]
        work[(ENDS + 2) * LANES + k] = table[row + 1, 0]
        work[(ENDS + 3) * LANES + k] = table[row + 1, 1]
    for k in range(LANES):
        at = TEMPERATURE * LANES + k
        live = points[ACTIVE * LANES + k] > 0.0
        mu, energy = 1.0 / work[RATIO * LANES + k] - 1.0, points[ENERGY * LANES + k]
        low = work[ENDS * LANES + k], work[(ENDS + 1) * LANES + k]
        high = work[(ENDS + 2) * LANES + k], work[(ENDS + 3) * LANES + k]
        u = work[PLACE * LANES + k] - work[SCRATCH * LANES + k]
        warm = temperature_between(mu, energy, u, low, high, law)
        points[at] = warm if live else points[at]


@njit(**FAST_LANEWISE)
def take_stresses(points, work):  # type: ignore[no-untyped-def]
    """Take the stresses as they are, for a step of none."""
    for k in range(LANES):
        work[CHANGE * LANES + k] = 0.0


@njit(**FAST_LANEWISE)
def fracture(points, work, law):  # type: ignore[no-untyped-def]
    """Let points fail by strain, damage or the greatest principal stress: they bear no more."""
    for k in range(LANES):
        at = k
        mises = equivalent(six(points, at + DEVIATOR * LANES))
        # The greatest principal stress is at most 2/3 of the equivalent one above the mean.
        torn = 2.0 / 3.0 * mises - points[at + PRESSURE * LANES] - law.spall
        strained = points[at + STRAIN * LANES] - law.failure_strain
        damaged = points[at + DAMAGE * LANES] - 1.0
        work[SCRATCH * LANES + k] = max(torn, max(strained, damaged))
    if greatest(work, SCRATCH) < 0.0:
        return
    for k in range(LANES):
        at = k
        s, pressure = six(points, at + DEVIATOR * LANES), points[at + PRESSURE * LANES]
        failed = points[at + STRAIN * LANES] >= law.failure_strain
        failed = failed or points[at + DAMAGE * LANES] >= 1.0
        if failed or is_torn(s, pressure, law.spall):
            points[at + ACTIVE * LANES] = 0.0
            points[at + PRESSURE * LANES] = 0.0
            put_six(points, at + DEVIATOR * LANES, (0.0, 0.0, 0.0, 0.0, 0.0, 0.0))


@njit(**FAST_LANEWISE)
def resist(points, work, law, resistance, dt):  # type: ignore[no-untyped-def]
    """Write stresses with those of bulk viscosity and damping; return the least stable step [s]."""
    linear, quadratic, damp = resistance.linear, resistance.quadratic, resistance.damping
    for k in range(LANES):
        at = k
        l00, l01, l02, l10, l11, l12, l20, l21, l22 = nine(work, GRADIENT, k)
        divergence = l00 + l11 + l22
        ratio, length = work[RATIO * LANES + k], work[LENGTH * LANES + k]
        pressure, old = points[at + PRESSURE * LANES], points[at + ENERGY * LANES]
        live = points[at + ACTIVE * LANES] > 0.0
        sound = math.sqrt(sound_speed_squared(1.0 / ratio - 1.0, old, pressure, law))
        edge, rate = work[EDGE * LANES + k], max(0.0, -divergence)
        drag = (linear * sound + quadratic * quadratic * edge * rate) if rate > 0.0 else 0.0  # m/s
        per_density = work[SPECIFIC * LANES + k]
        viscous = edge * rate * drag / per_density if live else 0.0
        energy = old - 0.5 * viscous * work[CHANGE * LANES + k]
        slower = drag + damp * sound * sound / length
        trace, double = -pressure - viscous, 0.0
        if damp > 0.0:
            gradient = l00, l01, l02, l10, l11, l12, l20, l21, l22
            energy += dt * per_density * damp * damping_power(gradient, law)
            double = 2.0 * damp * law.shear
            trace += damp * (law.bulk - 2.0 / 3.0 * law.shear) * divergence
        points[at + VISCOUS * LANES] = viscous
        points[at + ENERGY * LANES] = energy if live else old
        xx, yy, zz, xy, yz, zx = six(points, at + DEVIATOR * LANES)
        row = STRESS * LANES + k
        work[row] = xx + trace + double * l00 if live else 0.0
        work[row + LANES] = yy + trace + double * l11 if live else 0.0
        work[row + 2 * LANES] = zz + trace + double * l22 if live else 0.0
        work[row + 3 * LANES] = xy + 0.5 * double * (l01 + l10) if live else 0.0
        work[row + 4 * LANES] = yz + 0.5 * double * (l12 + l21) if live else 0.0
        work[row + 5 * LANES] = zx + 0.5 * double * (l20 + l02) if live else 0.0
        work[SPEED * LANES + k] = sound
        step = length / (slower + math.sqrt(slower * slower + sound * sound))
        work[SCRATCH * LANES + k] = step if live else HUGE
    return least(work, SCRATCH)
